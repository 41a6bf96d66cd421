#pragma once

#include "device/node_block.hpp"

/// Rows of a block that hold, until complete_nodes(), what nodes are made from. Those of cosines and the factor are
/// what they will be.
namespace lobe::place {

constexpr NodeBlock::Row psi = NodeBlock::cos_h;
constexpr NodeBlock::Row sin_difference = NodeBlock::cos_d;  ///< of the angles from the normal
constexpr NodeBlock::Row sines = NodeBlock::tan2_h;          ///< four times the product of both sines
constexpr NodeBlock::Row cos_difference = NodeBlock::log_cos_h;

}  // namespace lobe::place
