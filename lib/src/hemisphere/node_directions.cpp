#include "hemisphere/node_directions.hpp"

#include <algorithm>
#include <cmath>

namespace lobe {
namespace {

double row_at(const NodeBlock& block, NodeBlock::Row row, std::size_t node) {
  return block.data()[row * block.capacity() + node];
}

}  // namespace

Directions directions_at(const NodeBlock& block, std::size_t node) {
  constexpr double kHorizon = 1e-12;  // functions are defined above it
  const double cos_i = std::clamp(row_at(block, NodeBlock::cos_i, node), kHorizon, 1.0);
  const double cos_o = std::clamp(row_at(block, NodeBlock::cos_o, node), kHorizon, 1.0);
  const double cos_d = row_at(block, NodeBlock::cos_d, node);
  const double sines = std::sqrt((1 - cos_i * cos_i) * (1 - cos_o * cos_o));
  const double cosine = sines > 0 ? (2 * cos_d * cos_d - 1 - cos_i * cos_o) / sines : 1;
  return {std::acos(cos_i), std::acos(cos_o), std::acos(std::clamp(cosine, -1.0, 1.0))};
}

double factor_at(const NodeBlock& block, std::size_t node) {
  return row_at(block, NodeBlock::factor, node);
}

}  // namespace lobe
