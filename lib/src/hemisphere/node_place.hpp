#pragma once

#include "device/node_block.hpp"

/// Rows of a block that hold what nodes are made from until complete_nodes() or complete_directions() has made them.
/// The factor already has its final value, and for complete_nodes() cos_i and cos_o do.
namespace lobe::place {

inline constexpr NodeBlock::Row kPsi = NodeBlock::cos_h;
inline constexpr NodeBlock::Row kSinDifference = NodeBlock::cos_d;  ///< of the angles from the normal
inline constexpr NodeBlock::Row kSines = NodeBlock::tan2_h;         ///< four times the product of both sines
inline constexpr NodeBlock::Row kCosDifference = NodeBlock::log_cos_h;

/// For complete_directions(), angles in radians.
inline constexpr NodeBlock::Row kThetaIn = NodeBlock::cos_i;
inline constexpr NodeBlock::Row kThetaOut = NodeBlock::cos_o;
inline constexpr NodeBlock::Row kDeltaPhi = NodeBlock::cos_h;
inline constexpr NodeBlock::TangentRow kPhiIn = NodeBlock::slope_x;  ///< among the tangents

}  // namespace lobe::place
