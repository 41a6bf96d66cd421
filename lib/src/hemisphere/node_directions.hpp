#pragma once

#include <cstddef>

#include "device/node_block.hpp"
#include "lobe/directions.hpp"

namespace lobe {

/// The pair of directions of a node, phi_in 0 and delta_phi in [0, pi]. Rules give cosines: near the mirror direction
/// delta_phi loses half its digits, to 1e-8.
[[nodiscard]] Directions directions_at(const NodeBlock& block, std::size_t node);

/// What a value at the node counts with in the sum of its rule.
[[nodiscard]] double factor_at(const NodeBlock& block, std::size_t node);

}  // namespace lobe
