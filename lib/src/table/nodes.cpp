#include "table/nodes.hpp"

namespace lobe {
namespace {

void add(NodeSet& set, const HemisphereGrid& grid, std::size_t node, std::size_t samples, double weight) {
  const auto directions = grid.samples(node, samples);
  set.directions.samples = directions.size();
  set.directions.directions.insert(set.directions.directions.end(), directions.begin(), directions.end());
  set.weights.push_back(weight);
  ++set.directions.count;
}

}  // namespace

NodeSet ring_nodes(const HemisphereGrid& grid, std::size_t samples) {
  NodeSet set;
  for (const Ring& ring : grid.rings()) {
    add(set, grid, ring.first_node, samples, ring.weight * static_cast<double>(ring.count));
  }
  return set;
}

NodeSet all_nodes(const HemisphereGrid& grid, std::size_t samples) {
  NodeSet set;
  for (std::size_t node = 0; node < grid.nodes(); ++node) add(set, grid, node, samples, grid.weights()[node]);
  return set;
}

NodeSet half_nodes(const HemisphereGrid& grid, std::size_t samples) {
  NodeSet set;
  const std::size_t half = grid.half_azimuths();
  for (const Ring& ring : grid.rings()) {
    for (std::size_t k = 0; k < half; ++k) {
      add(set, grid, ring.first_node + k, samples, ring.weight * (k == 0 || k + 1 == half ? 1 : 2));
    }
  }
  return set;
}

NodeSet row_nodes(const HemisphereGrid& grid, std::size_t samples) {
  return grid.is_product() ? half_nodes(grid, samples) : all_nodes(grid, samples);
}

}  // namespace lobe
