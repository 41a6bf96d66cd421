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
    : extent_(std::move(extent)), outer_(extent_.width, joined(extent_.patch_radii, light_radii)) {
  for (const double radius : light_radii) light_edges_.push_back({std::acos(std::abs(1 - radius)), true});
}

std::vector<PatchNode> PatchRule::place(double elevation, int count) const {
  const GaussRule gauss = gauss_rule(count);
  auto elevations = elevation_panels(elevation, extent_);
  elevations.insert(elevations.end(), light_edges_.begin(), light_edges_.end());
  tidy_edges(elevations);
  std::vector<PatchNode> nodes;
  for (std::size_t panel = 0; panel + 1 < elevations.size(); ++panel) {
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const PanelPoint out = panel_point(elevations[panel], elevations[panel + 1], gauss.nodes[k]);
      // Both halves of the azimuth; N.X sin(theta_X).
      const double weight = 2 * out.stretch * gauss.weights[k] * std::sin(out.at) * std::cos(out.at);
      const auto azimuths = azimuth_panels(elevation, out.at, extent_);
      for (std::size_t side = 0; side + 1 < azimuths.size(); ++side) {
        for (std::size_t j = 0; j < gauss.nodes.size(); ++j) {
          const PanelPoint psi = panel_point(azimuths[side], azimuths[side + 1], gauss.nodes[j]);
          nodes.push_back(
              {node_of_elevations(elevation, out.at, psi.at, weight * psi.stretch * gauss.weights[j]), out.at, psi.at});
        }
      }
    }
  }
  return nodes;
}

}  // namespace lobe
