#include "hemisphere/patch_rule.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/geometry.hpp"

namespace lobe {
namespace {

LobeExtent with_lights(LobeExtent extent, const std::vector<double>& radii, bool has_mirror_and_retro) {
  extent.patch_radii.insert(extent.patch_radii.end(), radii.begin(), radii.end());
  for (const double radius : radii) {
    if (!has_mirror_and_retro || radius >= 1) continue;
    // Common areas of discs begin with the power 3/2. The centres are as far from the origin as L.
    extent.kinks.push_back(cosine_kinks(std::sqrt((1 - radius) * (1 + radius)), 1.5).front());
  }
  return extent;
}

}  // namespace

PatchRule::PatchRule(LobeExtent extent, const std::vector<double>& light_radii, bool has_mirror_and_retro)
    : extent_(std::move(extent)), outer_(with_lights(extent_, light_radii, has_mirror_and_retro)) {
  for (const double radius : light_radii) light_edges_.push_back({std::acos(std::abs(1 - radius)), true});
}

const GaussRule& PatchRule::rule_of(const PanelEdge& low, const PanelEdge& high, int count, int degree) const {
  // Polynomials oscillate evenly in the elevation and in psi; a node stands for four radians of that.
  const int more = static_cast<int>(std::ceil(degree * (high.at - low.at) / 4));
  return rules_[static_cast<std::size_t>(count + more - 1)];
}

std::vector<PatchRing> PatchRule::place(double elevation, int count, int degree) {
  // No panel is longer than a right angle.
  const int most = count + static_cast<int>(std::ceil(degree * std::numbers::pi / 8)) + 1;
  while (rules_.size() < static_cast<std::size_t>(most)) {
    rules_.push_back(gauss_rule(static_cast<int>(rules_.size()) + 1));
  }
  auto elevations = elevation_panels(elevation, extent_);
  elevations.insert(elevations.end(), light_edges_.begin(), light_edges_.end());
  tidy_edges(elevations);
  std::vector<PatchRing> rings;
  std::vector<double> weights;
  for (std::size_t panel = 0; panel + 1 < elevations.size(); ++panel) {
    const GaussRule& gauss = rule_of(elevations[panel], elevations[panel + 1], count, degree);
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const PanelPoint out = panel_point(elevations[panel], elevations[panel + 1], gauss.nodes[k]);
      rings.push_back({out.at, {}});
      // Both halves of the azimuth; N.X sin(theta_X).
      weights.push_back(2 * out.stretch * gauss.weights[k] * std::sin(out.at) * std::cos(out.at));
    }
  }
  parallel_for(rings.size(), [&](std::size_t ring) {
    auto& [at, nodes] = rings[ring];
    const ElevationPair pair = elevation_pair(elevation, at);
    const auto azimuths = azimuth_panels(elevation, at, extent_);
    for (std::size_t side = 0; side + 1 < azimuths.size(); ++side) {
      const GaussRule& around = rule_of(azimuths[side], azimuths[side + 1], count, degree);
      for (std::size_t j = 0; j < around.nodes.size(); ++j) {
        const PanelPoint psi = panel_point(azimuths[side], azimuths[side + 1], around.nodes[j]);
        nodes.push_back({node_of_azimuth(pair, psi.at, weights[ring] * psi.stretch * around.weights[j]), psi.at});
      }
    }
  });
  return rings;
}

}  // namespace lobe
