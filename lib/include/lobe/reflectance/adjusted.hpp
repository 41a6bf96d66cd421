#pragma once

#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// The formulas with their adjustments done, in order, and user-written ones tested; a function or a table as it is.
/// Every verb does this by itself: what asks much of the same material does it once here.
///
/// A user's formula is compiled, and looked at for 512 pairs of directions: its values are finite, and f(L,V) = f(V,L)
/// to 1e-9 of the sum of both where it claims so.
///
/// Scales of `normalise`, divisors of `pump` and albedos of `mirror` carry relative errors of their own, at most 2e-6
/// and as a rule below 1e-7, which error estimates of the material do not know of.
/// \throws ArgumentError "FILE:LINE:COLUMN message" for a formula that does not compile, and for one that is not what
///   it claims; NumericError for an adjustment that cannot be done: an albedo of 0, one that cannot be computed, is not
///   smooth enough or, for `mirror`, above 1, anisotropic models, pumping of what was pumped by another correction.
[[nodiscard]] Reflectance adjusted(const Device& device, const Reflectance& reflectance);

}  // namespace lobe
