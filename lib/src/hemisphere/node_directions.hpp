#pragma once

#include <cstddef>

#include "device/node_block.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {

/// The pair of directions of a node, phi_in 0 and delta_phi in [0, pi]. Blocks hold cosines: near the mirror direction
/// delta_phi loses half its digits, to 1e-8, and at normal incidence all. A rule that has nodes there gives their
/// angles itself (AlbedoRule::view_nodes).
[[nodiscard]] Directions directions_at(const NodeBlock& block, std::size_t node);

/// Weight of a value at the node in the sum of its rule.
[[nodiscard]] double factor_at(const NodeBlock& block, std::size_t node);

}  // namespace lobe
