#pragma once

#include "device/node_block.hpp"

/// Rows of a block that hold, until complete_nodes(), what nodes are made from. The rows cos_i, cos_o and factor
/// already have their final values.
namespace lobe::place {

inline constexpr NodeBlock::Row kPsi = NodeBlock::cos_h;
inline constexpr NodeBlock::Row kSinDifference = NodeBlock::cos_d;  ///< of the angles from the normal
inline constexpr NodeBlock::Row kSines = NodeBlock::tan2_h;         ///< four times the product of both sines
inline constexpr NodeBlock::Row kCosDifference = NodeBlock::log_cos_h;

/// Until complete_directions(), which takes no other rows but the factor.
inline constexpr NodeBlock::Row kThetaIn = NodeBlock::cos_i;
inline constexpr NodeBlock::Row kThetaOut = NodeBlock::cos_o;
inline constexpr NodeBlock::Row kDeltaPhi = NodeBlock::cos_h;
inline constexpr NodeBlock::TangentRow kPhiIn = NodeBlock::slope_x;  ///< among the tangents

}  // namespace lobe::place
