#include "hemisphere/angle_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hemisphere/geometry.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kSlabRatio = 0.3;      // of successive slabs
constexpr double kInnermostSlab = 0.7;  // smallest slab, in lobe widths

}  // namespace

AngleRule::AngleRule(LobeExtent extent, double theta_max) : extent_(std::move(extent)), lowest_(pi / 2 - theta_max) {
  extent_.common = CommonKinks::all();
  extent_.width = std::min(extent_.width, 1.0);
  const double narrowest = std::min(extent_.width, extent_.retro_width);
  edges_ = {{0, true}, {pi / 6}, {pi / 4}, {pi / 2}};
  for (double e = pi / 6 * kSlabRatio; e > kInnermostSlab * narrowest; e *= kSlabRatio) edges_.push_back({e});
  for (double theta = pi / 4 * kSlabRatio; theta > kInnermostSlab * narrowest; theta *= kSlabRatio)
    edges_.push_back({pi / 2 - theta});
  for (const auto* radii : {&extent_.patch_radii, &extent_.retro_patch_radii}) {
    for (const double radius : *radii) edges_.push_back({std::acos(std::abs(1 - radius)), true});
  }
  tidy_edges(edges_);
  add_kink_slabs(extent_, lowest_, edges_);
  edges_ = cut_below(lowest_, std::move(edges_));
}

void AngleRule::place(std::size_t slab, int nodes_per_panel, NodeBlock& block,
                      const std::function<void()>& flush) const {
  const GaussRule gauss = gauss_rule(nodes_per_panel);
  const std::size_t count = gauss.nodes.size();
  std::size_t first = block.size();
  const auto flush_nodes = [&] {
    complete_nodes(block, first, block.size() - first);
    flush();
    first = block.size();
  };
  for (std::size_t a = 0; a < count; ++a) {
    const PanelPoint in = panel_point(edges_[slab], edges_[slab + 1], gauss.nodes[a]);
    const double weight_in = 2 * in.stretch * gauss.weights[a];  // both halves of the azimuth
    const auto elevations = cut_below(lowest_, elevation_panels(in.at, extent_));
    for (std::size_t panel = 0; panel + 1 < elevations.size(); ++panel) {
      for (std::size_t k = 0; k < count; ++k) {
        const PanelPoint out = panel_point(elevations[panel], elevations[panel + 1], gauss.nodes[k]);
        const double weight_out = weight_in * out.stretch * gauss.weights[k];
        const ElevationPair pair = elevation_pair(in.at, out.at);
        const auto azimuths = azimuth_panels(in.at, out.at, extent_);
        for (std::size_t side = 0; side + 1 < azimuths.size(); ++side) {
          for (std::size_t j = 0; j < count; ++j) {
            const PanelPoint psi = panel_point(azimuths[side], azimuths[side + 1], gauss.nodes[j]);
            place_node(block, pair, psi.at, weight_out * psi.stretch * gauss.weights[j]);
            if (block.full()) flush_nodes();
          }
        }
      }
    }
  }
  if (block.size() > 0) flush_nodes();
}

}  // namespace lobe
