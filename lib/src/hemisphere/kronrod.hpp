#pragma once

#include <Eigen/Core>
#include <vector>

namespace lobe {

/// Kronrod's extension of a Gauss rule, on [0, 1], and the Gauss rule on every second of its nodes: their difference
/// tells of the error of both.
struct EmbeddedPair {
  std::vector<double> nodes;           ///< rising, in (0, 1)
  std::vector<double> weights;         ///< of Kronrod's rule, exact up to degree 3 n + 1 for n Gauss nodes
  std::vector<double> coarse_weights;  ///< of the Gauss rule, 0 at the nodes it lacks; up to degree 2 n - 1
  /// Odd about the middle, 0 for polynomials up to degree 2 n - 2, as large as the difference of both rules: where a
  /// kink makes that difference vanish by chance, this sum does not.
  std::vector<double> null_weights;
  std::vector<double> end_weights;  ///< of the polynomial through all nodes at 0; at 1 in the opposite order
};

/// The root of the sum of the squares of an embedded pair's difference and its null sum, by channel; right for
/// magnitudes whose squares are no normal numbers.
[[nodiscard]] Eigen::ArrayXd joint_difference(const Eigen::ArrayXd& difference, const Eigen::ArrayXd& null_sum);

/// The pair with 3 Gauss nodes among 7.
[[nodiscard]] const EmbeddedPair& short_pair();
/// The pair with 5 Gauss nodes among 11.
[[nodiscard]] const EmbeddedPair& middle_pair();
/// The pair with 7 Gauss nodes among 15.
[[nodiscard]] const EmbeddedPair& long_pair();

}  // namespace lobe
