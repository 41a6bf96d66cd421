#include "hemisphere/patch_rule.hpp"

#include <cmath>
#include <utility>

#include "hemisphere/gauss.hpp"
#include "hemisphere/geometry.hpp"

namespace lobe {
namespace {

std::vector<double> joined(std::vector<double> radii, const std::vector<double>& others) {
  radii.insert(radii.end(), others.begin(), others.end());
  return radii;
}

}  // namespace

PatchRule::PatchRule(LobeExtent extent, const std::vector<double>& light_radii)
    : extent_(std::move(extent)), outer_(extent_.width, joined(extent_.patch_radii, light_radii), extent_.retro_width) {
  for (const double radius : light_radii) light_edges_.push_back({std::acos(std::abs(1 - radius)), true});
}

std::vector<PatchNode> PatchRule::place(double elevation, int count, int degree) const {
  // Polynomials oscillate evenly in the elevation and in psi; a node stands for four radians of that.
  std::vector<GaussRule> rules;
  const auto rule_of = [&](const PanelEdge& low, const PanelEdge& high) -> const GaussRule& {
    const auto more = static_cast<std::size_t>(std::ceil(degree * (high.at - low.at) / 4));
    while (rules.size() <= more) rules.push_back(gauss_rule(count + static_cast<int>(rules.size())));
    return rules[more];
  };
  auto elevations = elevation_panels(elevation, extent_);
  elevations.insert(elevations.end(), light_edges_.begin(), light_edges_.end());
  tidy_edges(elevations);
  std::vector<PatchNode> nodes;
  for (std::size_t panel = 0; panel + 1 < elevations.size(); ++panel) {
    const GaussRule gauss = rule_of(elevations[panel], elevations[panel + 1]);
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const PanelPoint out = panel_point(elevations[panel], elevations[panel + 1], gauss.nodes[k]);
      // Both halves of the azimuth; N.X sin(theta_X).
      const double weight = 2 * out.stretch * gauss.weights[k] * std::sin(out.at) * std::cos(out.at);
      const auto azimuths = azimuth_panels(elevation, out.at, extent_);
      for (std::size_t side = 0; side + 1 < azimuths.size(); ++side) {
        const GaussRule& around = rule_of(azimuths[side], azimuths[side + 1]);
        for (std::size_t j = 0; j < around.nodes.size(); ++j) {
          const PanelPoint psi = panel_point(azimuths[side], azimuths[side + 1], around.nodes[j]);
          nodes.push_back({node_of_elevations(elevation, out.at, psi.at, weight * psi.stretch * around.weights[j]),
                           out.at, psi.at});
        }
      }
    }
  }
  return nodes;
}

}  // namespace lobe
