#include "hemisphere/albedo_rule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hemisphere/gauss.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/refinement.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kRatio = 0.3;         // of successive panels of theta
constexpr double kAzimuthRatio = 0.3;  // of successive panels of psi
constexpr double kInnermost = 0.7;     // smallest panel beside the mirror direction, in lobe widths

/// Panels of the elevation of V for L at `incident`.
std::vector<PanelEdge> elevation_edges(double incident, double width) {
  // sqrt(N.V) begins at the horizon, cusps lie at the mirror direction.
  std::vector<PanelEdge> edges{{0, true}, {incident, true}, {pi / 2}};
  for (double step = kInnermost * std::min(width, incident); step < pi / 2; step /= kRatio) {
    if (incident + step < pi / 2) edges.push_back({incident + step});
    if (step < 0.8 * incident) edges.push_back({incident - step});
  }
  // Where the kinks of G = 1 and R.V = 0 enter at psi = 0 or pi.
  for (const double e : {incident / 3, 3 * incident, (pi - incident) / 3, pi - 3 * incident, pi / 2 - incident}) {
    if (e > 0 && e < pi / 2) edges.push_back({e, true});
  }
  tidy_edges(edges);
  return edges;
}

/// Panels of psi in [0, pi].
std::vector<PanelEdge> azimuth_edges(double incident, double elevation, double width) {
  const double cos_i = std::sin(incident);
  const double cos_o = std::sin(elevation);
  const double product = std::cos(incident) * std::cos(elevation);  // sin sin
  std::vector<PanelEdge> edges{{0, true}, {pi / 2}, {pi}};
  const auto add_kink = [&](double cos_delta_phi, bool root) {
    if (std::abs(cos_delta_phi) < 1) edges.push_back({pi - std::acos(cos_delta_phi), root});
  };
  if (product > 0) {
    add_kink((2 * std::min(cos_i, cos_o) * (cos_i + cos_o) - 1 - cos_i * cos_o) / product, false);  // G = 1
    add_kink(cos_i * cos_o / product, true);                                                        // (R.V)^n begins
    const double off = std::abs(std::cos(elevation) - std::cos(incident));
    const double scale = 0.7 * std::max(width * (cos_i + cos_o), off) / std::sqrt(product);
    for (double psi = pi * kAzimuthRatio; psi > scale; psi *= kAzimuthRatio) edges.push_back({psi});
  }
  tidy_edges(edges);
  return edges;
}

}  // namespace

AlbedoRule::AlbedoRule(double width) : width_(std::min(width, 1.0)) {
  edges_ = {{0, true}, {pi / 6}, {pi / 4}, {pi / 2}};
  for (double e = pi / 6 * kRatio; e > 0.1 * width_; e *= kRatio) edges_.push_back({e});
  tidy_edges(edges_);
}

std::vector<IncidentNode> AlbedoRule::incident_nodes(std::size_t slab, int level) const {
  const GaussRule gauss = gauss_rule(kNodesPerPanel[static_cast<std::size_t>(level)]);
  std::vector<IncidentNode> nodes;
  for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
    const PanelPoint elevation = panel_point(edges_[slab], edges_[slab + 1], gauss.nodes[k]);
    nodes.push_back({elevation.at,
                     elevation.stretch * gauss.weights[k] * 2 * pi * std::sin(elevation.at) * std::cos(elevation.at)});
  }
  return nodes;
}

void AlbedoRule::place(double elevation, int level, NodeBlock& block, const std::function<void()>& flush) const {
  const GaussRule gauss = gauss_rule(kNodesPerPanel[static_cast<std::size_t>(level)]);
  const std::size_t count = gauss.nodes.size();
  const auto elevations = elevation_edges(elevation, width_);
  for (std::size_t panel = 0; panel + 1 < elevations.size(); ++panel) {
    for (std::size_t k = 0; k < count; ++k) {
      const PanelPoint out = panel_point(elevations[panel], elevations[panel + 1], gauss.nodes[k]);
      // Both halves of the azimuth; N.V sin(theta_V).
      const double weight = 2 * out.stretch * gauss.weights[k] * std::sin(out.at) * std::cos(out.at);
      const auto azimuths = azimuth_edges(elevation, out.at, width_);
      for (std::size_t side = 0; side + 1 < azimuths.size(); ++side) {
        for (std::size_t j = 0; j < count; ++j) {
          const PanelPoint psi = panel_point(azimuths[side], azimuths[side + 1], gauss.nodes[j]);
          block.push(node_of_elevations(elevation, out.at, psi.at, weight * psi.stretch * gauss.weights[j]));
          if (block.full()) flush();
        }
      }
    }
  }
}

}  // namespace lobe
