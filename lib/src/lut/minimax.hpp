#pragma once

#include <Eigen/Core>

namespace lobe {

/// The function p / q whose largest difference from values at points is the smallest.
struct Minimax {
  Eigen::VectorXd numerator;    ///< coefficients of p
  Eigen::VectorXd denominator;  ///< coefficients of q, the largest of which is 1 or -1
  double largest = 0;           ///< its largest difference
  double bound = 0;             ///< no other such function has a smaller one
};

/// Fits by linear programming: polynomials as such, quotients by the differential correction of Cheney and Loeb
/// (Barrodale, Powell and Roberts 1972), which finds the best quotient that is positive at the points wherever it
/// starts.
/// \param numerator the functions that p is made of, one per column, at the points
/// \param denominator those of q, the first of which is 1; with no other q is 1
/// \param errors of the values: the bound holds for all that they permit
/// \throws NumericError where a linear program is not solved
[[nodiscard]] Minimax minimax(const Eigen::MatrixXd& numerator, const Eigen::MatrixXd& denominator,
                              const Eigen::VectorXd& values, const Eigen::VectorXd& errors);

}  // namespace lobe
