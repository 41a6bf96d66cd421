#pragma once

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// Whether prepare() has anything to do.
[[nodiscard]] bool needs_preparation(const Material& material);

/// Makes a material ready for computations: tests its formulas and does its adjustments, in order.
///
/// A formula is compiled, and looked at for 512 pairs of directions: its values are finite, and f(L,V) = f(V,L) to 1e-9
/// of the sum of both where it claims so.
///
/// Scales of `normalise`, divisors of `pump` and albedos of `mirror` carry relative errors of their own, at most 2e-6
/// and as a rule below 1e-7, which error estimates of the material do not know of.
/// \throws ArgumentError "FILE:LINE:COLUMN message" for a formula that does not compile, and for one that is not what
///   it claims; NumericError for an adjustment that cannot be done: an albedo of 0, one that cannot be computed, is not
///   smooth enough or, for `mirror`, above 1, anisotropic models, pumping of what was pumped by another correction.
[[nodiscard]] Material prepare(const Device& device, Material material);

}  // namespace lobe
