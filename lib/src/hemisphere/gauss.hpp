#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lobe {

/// Gauss-Legendre rule on [0, 1]: exact for polynomials up to degree 2n - 1.
struct GaussRule {
  std::vector<double> nodes;    ///< rising, in (0, 1)
  std::vector<double> weights;  ///< positive, sum 1
};

/// \param count number of nodes, >= 1
[[nodiscard]] GaussRule gauss_rule(int count);

/// Gauss-Kronrod rule on [0, 1]: 15 nodes, of which every second one is a node of the Gauss rule of 7. The difference
/// of the two bounds the error of the larger one where the integrand is smooth.
struct KronrodRule {
  static constexpr std::size_t kNodes = 15;
  std::array<double, kNodes> nodes;           ///< rising, in (0, 1)
  std::array<double, kNodes> weights;         ///< exact for polynomials up to degree 22
  std::array<double, kNodes> coarse_weights;  ///< of the Gauss rule, 0 at the nodes it lacks; up to degree 13
};

[[nodiscard]] const KronrodRule& kronrod_rule();

/// A limit of a panel of a composite rule. Where the integrand begins like a root or a fractional power at the limit,
/// `root` makes the panels on both sides place their nodes quadratically towards it, which restores fast convergence.
struct PanelEdge {
  double at = 0;
  bool root = false;
};

/// Sorts limits and merges those that coincide up to rounding.
void tidy_edges(std::vector<PanelEdge>& edges);

/// Panels on [lowest, ...] of a coordinate that begins at 0: what lies below is cut off.
[[nodiscard]] std::vector<PanelEdge> cut_below(double lowest, std::vector<PanelEdge> edges);

/// Adds limits until no panel is more than `growth` times as long as the one beside it (or as a shortest length that
/// counts, 1e-7): a singularity at one of two close limits slows the rule on both sides of them.
void grade_edges(std::vector<PanelEdge>& edges, double growth);

/// A point of a panel and the factor of the measure there.
struct PanelPoint {
  double at = 0;
  double stretch = 1;  ///< d at / d x
};

/// Maps x in [0, 1] to the panel between two limits.
[[nodiscard]] inline PanelPoint panel_point(const PanelEdge& low, const PanelEdge& high, double x) {
  const double span = high.at - low.at;
  if (low.root && high.root) return {low.at + span * x * x * (3 - 2 * x), span * 6 * x * (1 - x)};
  if (low.root) return {low.at + span * x * x, span * 2 * x};
  if (high.root) return {low.at + span * x * (2 - x), span * 2 * (1 - x)};
  return {low.at + span * x, span};
}

}  // namespace lobe
