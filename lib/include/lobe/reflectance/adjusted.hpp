#pragma once

#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Applies the adjustments of formulas, in order, and tests user-written formulas; returns a function or a table
/// unchanged. Every verb does this by itself: call it if you use the same material often.
///
/// A user's formula is compiled and evaluated for 512 pairs of directions: its values must be finite and, if it claims
/// reciprocity, f(L,V) = f(V,L) to 1e-9 of the sum of both.
///
/// Scales of `normalise`, divisors of `pump` and albedos of `mirror` carry relative errors of their own, at most 2e-6
/// and usually below 1e-7, which the error estimates of the material do not include.
/// \throws ArgumentError "FILE:LINE:COLUMN message" for a formula that does not compile, and for one that breaks its
///   claims; NumericError for an adjustment that cannot be applied: an albedo of 0, one that cannot be computed, that
///   is not smooth enough or, for `mirror`, above 1, anisotropic models, pumping-up after another correction
[[nodiscard]] Reflectance adjusted(const Device& device, const Reflectance& reflectance);

}  // namespace lobe
