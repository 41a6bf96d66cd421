#include "table/nodes.hpp"

#include <cmath>

#include "hemisphere/square_map.hpp"

namespace lobe {
namespace {

void add(NodeSet& set, const HemisphereGrid& grid, std::size_t node, std::size_t points, double weight) {
  const auto directions = grid.cell_points(node, points);
  set.directions.points = directions.size();
  set.directions.directions.insert(set.directions.directions.end(), directions.begin(), directions.end());
  set.weights.push_back(weight);
  ++set.directions.count;
}

}  // namespace

NodeSet ring_nodes(const HemisphereGrid& grid, std::size_t points) {
  NodeSet set;
  for (const Ring& ring : grid.rings()) {
    add(set, grid, ring.first_node, points, ring.weight * static_cast<double>(ring.count));
  }
  return set;
}

NodeSet all_nodes(const HemisphereGrid& grid, std::size_t points) {
  NodeSet set;
  for (std::size_t node = 0; node < grid.nodes(); ++node) add(set, grid, node, points, grid.weights()[node]);
  return set;
}

NodeSet half_nodes(const HemisphereGrid& grid, std::size_t points) {
  NodeSet set;
  const std::size_t half = grid.half_azimuths();
  for (const Ring& ring : grid.rings()) {
    for (std::size_t k = 0; k < half; ++k) {
      add(set, grid, ring.first_node + k, points, ring.weight * (k == 0 || k + 1 == half ? 1 : 2));
    }
  }
  return set;
}

NodeSet row_nodes(const HemisphereGrid& grid, std::size_t points) {
  return grid.is_product() ? half_nodes(grid, points) : all_nodes(grid, points);
}

RingRule ring_rule(const HemisphereGrid& grid, std::size_t node, std::size_t count, std::span<const PanelEdge> kinks) {
  const Ring& ring = grid.rings()[grid.ring_of(node)];
  if (!grid.has_cells()) return {{ring.theta}, {1}};
  const GaussRule gauss = gauss_rule(static_cast<int>(count));
  const SquarePoint middle = hemisphere_to_square(grid.directions()[node]);
  const bool is_square = grid.kind() == GridKind::shirley_chiu;
  // Squares on a diagonal are arcs that open with the radius, others arcs of equal length.
  const bool is_corner = is_square && std::abs(std::abs(middle.a) - std::abs(middle.b)) < 1e-9;
  std::vector<PanelEdge> edges{{ring.theta_low}, {ring.theta_high}};
  for (const PanelEdge& kink : kinks) {
    if (kink.at > ring.theta_low && kink.at < ring.theta_high) edges.push_back(kink);
  }
  tidy_edges(edges);
  RingRule rule;
  double sum = 0;
  for (std::size_t panel = 0; panel + 1 < edges.size(); ++panel) {
    for (std::size_t k = 0; k < count; ++k) {
      const auto [theta, stretch] = panel_point(edges[panel], edges[panel + 1], gauss.nodes[k]);
      const double arc = is_corner ? std::sin(theta) - std::sin(ring.theta_low) : is_square ? 1 : std::sin(theta);
      const double share = stretch / (ring.theta_high - ring.theta_low);
      rule.thetas.push_back(theta);
      rule.weights.push_back(share * gauss.weights[k] * std::cos(theta) * arc);
      sum += rule.weights.back();
    }
  }
  for (double& weight : rule.weights) weight /= sum;
  return rule;
}

}  // namespace lobe
