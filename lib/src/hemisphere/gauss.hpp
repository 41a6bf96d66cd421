#pragma once

#include <vector>

namespace lobe {

/// Gauss-Legendre rule on [0, 1]: exact for polynomials up to degree 2n - 1.
struct GaussRule {
  std::vector<double> nodes;    ///< rising, in (0, 1)
  std::vector<double> weights;  ///< positive, sum 1
};

/// \param count number of nodes, >= 1
[[nodiscard]] GaussRule gauss_rule(int count);

/// A limit of a panel of a composite rule. Where the integrand begins like a root or a fractional power at the limit,
/// `root` makes the panels on both sides place their nodes quadratically towards it, which restores fast convergence.
struct PanelEdge {
  double at = 0;
  bool root = false;
};

/// Sorts limits and merges those that coincide up to rounding.
void tidy_edges(std::vector<PanelEdge>& edges);

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
