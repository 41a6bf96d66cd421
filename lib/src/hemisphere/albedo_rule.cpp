#include "hemisphere/albedo_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "hemisphere/gauss.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/half_vector_rule.hpp"
#include "hemisphere/refinement.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kRatio = 0.3;           // of successive slabs
constexpr double kAlbedoAzimuths = 0.6;  // density of azimuths; products of two albedos are smooth

/// Azimuths of L for the mean over a turn. Where lobes have a plane of mirror images, L has the albedos of its own
/// image.
std::vector<Azimuth> incident_turns(const LobeExtent& extent, int nodes_per_panel) {
  if (extent.aspect == 0) return {{0, 1}};
  std::vector<Azimuth> turns = equal_azimuths(extent.aspect, nodes_per_panel, kAlbedoAzimuths);
  if (!extent.mirror_plane) return turns;
  turns.resize(turns.size() / 2 + 1);  // of an odd number: the first one is its own image
  for (std::size_t k = 0; k < turns.size(); ++k) {
    turns[k].at += *extent.mirror_plane;
    if (k > 0) turns[k].share *= 2;
  }
  return turns;
}

}  // namespace

AlbedoRule::AlbedoRule(LobeExtent extent, double tolerance)
    : extent_(std::move(extent)),
      is_loose_(tolerance >= kLooseTolerance),
      sin_max_(std::sqrt((1 - extent_.cos_min) * (1 + extent_.cos_min))) {
  extent_.common = CommonKinks::all();
  extent_.width = std::min(extent_.width, 1.0);
  edges_ = {{0, true}, {pi / 6}, {pi / 4}, {pi / 2}};
  const double narrowest = std::min(extent_.width, extent_.retro_width);
  for (double e = pi / 6 * kRatio; e > 0.1 * narrowest; e *= kRatio) edges_.push_back({e});
  // Patches reach the horizon where their circle touches that of the base plane.
  for (const auto* radii : {&extent_.patch_radii, &extent_.retro_patch_radii}) {
    for (const double radius : *radii) {
      const double distance = std::abs(sin_max_ - radius);
      if (distance < 1) edges_.push_back({std::acos(distance), true});
    }
  }
  for (const auto* patch_edges : {&extent_.patch_edges, &extent_.retro_patch_edges}) {
    for (const PatchEdge& edge : *patch_edges) {
      PatchEdge scaled = edge;
      scaled.radius /= sin_max_;
      horizons_.emplace_back(scaled);
      for (const double distance : horizons_.back().distances()) {
        edges_.push_back({std::acos(sin_max_ * distance), true});
      }
    }
  }
  tidy_edges(edges_);
  add_kink_slabs(extent_, std::asin(extent_.cos_min), edges_);
  if (extent_.cos_min == 0) return;
  // Lobes that grow as 1/(N.L) have albedos that do so, too.
  const double lowest = std::asin(extent_.cos_min);
  for (double e = lowest / kRatio; e < pi / 6; e /= kRatio) edges_.push_back({e});
  edges_ = cut_below(lowest, std::move(edges_));
}

int AlbedoRule::nodes_per_panel(int level) const {
  const auto& nodes = is_loose_ && !horizons_.empty() ? kLooseNodesPerPanel : kNodesPerPanel;
  return nodes[static_cast<std::size_t>(level)];
}

/// Limits of the azimuth of L, over half a turn or a whole one.
std::vector<PanelEdge> AlbedoRule::incident_azimuths(double elevation) const {
  std::vector<PanelEdge> limits;
  for (const PatchHorizon& horizon : horizons_) {
    const auto of_edge = horizon.azimuths(std::cos(elevation) / sin_max_);
    limits.insert(limits.end(), of_edge.begin(), of_edge.end());
  }
  return turn_panels(std::move(limits), extent_.aspect, extent_.half_turn);
}

std::vector<IncidentNode> AlbedoRule::incident_nodes_of(std::size_t slab, int nodes_per_panel) const {
  const GaussRule gauss = gauss_rule(nodes_per_panel);
  const auto equal_turns = incident_turns(extent_, nodes_per_panel);
  const bool is_scattered = extent_.hides_jumps && !extent_.mirror_plane;
  std::vector<IncidentNode> nodes;
  for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
    const PanelPoint elevation = panel_point(edges_[slab], edges_[slab + 1], gauss.nodes[k]);
    const double weight =
        elevation.stretch * gauss.weights[k] * 2 * pi * std::sin(elevation.at) * std::cos(elevation.at);
    const auto turns = horizons_.empty() ? equal_turns : panel_azimuths(incident_azimuths(elevation.at), gauss);
    const double by = is_scattered ? scatter(slab * gauss.nodes.size() + k, turns.size()) : 0;
    for (const Azimuth& turn : turns) nodes.push_back({elevation.at, weight * turn.share, turn.at + by});
  }
  return nodes;
}

template <typename Visit>
void AlbedoRule::visit_rings(double elevation, int level, const Visit& visit) const {
  const GaussRule gauss = gauss_rule(nodes_per_panel(level));
  const auto elevations = elevation_panels(elevation, extent_);
  std::vector<ViewNode> ring;
  for (std::size_t panel = 0; panel + 1 < elevations.size(); ++panel) {
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const PanelPoint out = panel_point(elevations[panel], elevations[panel + 1], gauss.nodes[k]);
      // Both halves of the azimuth; N.V sin(theta_V).
      const double weight = 2 * out.stretch * gauss.weights[k] * std::sin(out.at) * std::cos(out.at);
      const auto azimuths = azimuth_panels(elevation, out.at, extent_);
      ring.clear();
      for (std::size_t side = 0; side + 1 < azimuths.size(); ++side) {
        for (std::size_t j = 0; j < gauss.nodes.size(); ++j) {
          const PanelPoint psi = panel_point(azimuths[side], azimuths[side + 1], gauss.nodes[j]);
          ring.push_back({out.at, psi.at, weight * psi.stretch * gauss.weights[j]});
        }
      }
      visit(out.at, ring);
    }
  }
}

void AlbedoRule::place(double elevation, int level, NodeBlock& block, const std::function<void()>& flush) const {
  visit_rings(elevation, level, [&](double elevation_out, std::span<const ViewNode> ring) {
    const ElevationPair pair = elevation_pair(elevation, elevation_out);
    std::size_t first = block.size();
    for (const ViewNode& view : ring) {
      place_node(block, pair, view.psi, view.factor);
      if (!block.full()) continue;
      complete_nodes(block, first, block.size() - first);
      flush();
      first = block.size();
    }
    complete_nodes(block, first, block.size() - first);
  });
}

std::vector<ViewNode> AlbedoRule::view_nodes(double elevation, int level) const {
  std::vector<ViewNode> nodes;
  visit_rings(elevation, level,
              [&](double, std::span<const ViewNode> ring) { nodes.insert(nodes.end(), ring.begin(), ring.end()); });
  return nodes;
}

}  // namespace lobe
