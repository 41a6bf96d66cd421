#pragma once

#include <Eigen/Core>
#include <vector>

#include "lobe/fit/approximation.hpp"

namespace lobe {

/// The Gram matrix of basis materials scaled to norm 1, and what its errors let be known of its rank. Made once, it
/// serves many targets.
class ScaledBasis {
 public:
  /// \param gram_error empty: exact.
  /// \throws ArgumentError for sizes that do not fit and entries that are not finite
  ScaledBasis(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& gram_error);

  [[nodiscard]] Eigen::Index size() const { return gram.rows(); }
  [[nodiscard]] std::vector<std::size_t> dependent() const;

  Eigen::MatrixXd gram;            ///< unit diagonal; zero rows for materials that are zero
  Eigen::MatrixXd gram_error;      ///< with rounding
  Eigen::VectorXd norms;           ///< |a_i|
  Eigen::MatrixXd pseudo_inverse;  ///< of the eigenvalues that count
  Eigen::Index rank = 0;
  double condition = 0;
};

/// How much smaller a residual may be whose square may be smaller by a slack.
[[nodiscard]] double fall_of(const Estimate& residual, double slack);

/// As best_combination(), without judging the basis.
/// \param basis that of problem.gram
[[nodiscard]] LinearFit fit(const ScaledBasis& basis, const ApproximationProblem& problem,
                            const ApproximationForm& form);

/// As best_combination(); but of a target that is zero, as a channel of a material may be, zero is the best
/// combination, without residual.
[[nodiscard]] LinearFit best_of_channel(const ApproximationProblem& problem, const ApproximationForm& form);

}  // namespace lobe
