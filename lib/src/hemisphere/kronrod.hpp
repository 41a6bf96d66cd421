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
  /// Of the larger rule, of its difference from the Gauss rule, of the null rule, and of four null rules of lower
  /// degrees, all as large as that difference and orthogonal, relative to the weights of the larger rule: nodes x 7.
  Eigen::Matrix<double, Eigen::Dynamic, 7> relative_sums;
  std::vector<double> end_weights;  ///< of the polynomial through all nodes at 0; at 1 in the opposite order
};

/// The root of the sum of the squares of an embedded pair's difference and its null sum, by channel; right for
/// magnitudes whose squares are no normal numbers.
[[nodiscard]] Eigen::ArrayXd joint_difference(const Eigen::ArrayXd& difference, const Eigen::ArrayXd& null_sum);

/// Integrals over panels by the larger rule of an embedded pair and estimates of their errors, channels x panels.
struct PanelIntegrals {
  Eigen::ArrayXXd value;
  Eigen::ArrayXXd error;
};

/// How far null rules fall off from degree to degree tells how fast the rules converge (Berntsen and Espelid 1991):
/// where they do, the error of the larger rule is what the highest of them give times a power of that ratio.
/// \param terms values times weights of the larger rule at the nodes of panels one after another, channels x nodes
/// \param stride columns per panel, of which the first are those of the rule
[[nodiscard]] PanelIntegrals integrate_panels(const EmbeddedPair& pair, const Eigen::ArrayXXd& terms,
                                              Eigen::Index stride);

/// The pair with 3 Gauss nodes among 7.
[[nodiscard]] const EmbeddedPair& short_pair();
/// The pair with 5 Gauss nodes among 11.
[[nodiscard]] const EmbeddedPair& middle_pair();
/// The pair with 7 Gauss nodes among 15.
[[nodiscard]] const EmbeddedPair& long_pair();
/// The embedded pair that reaches a tolerance with the fewest nodes, as measured for compositions and albedos of the
/// catalogue's models.
[[nodiscard]] const EmbeddedPair& pair_for(double tolerance);

}  // namespace lobe
