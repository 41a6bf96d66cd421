#pragma once

#include "lobe/device.hpp"
#include "lobe/material.hpp"

namespace lobe {

/// The material pumped up, each channel by its own albedo (Neumann 2001, eq. 2.16 and following).
/// \throws NumericError for anisotropic models, what was pumped by another correction, an albedo that is 0
///   or not smooth enough for a curve (see Pumping).
[[nodiscard]] Material pumped(const Device& device, const Material& material, const Adjustment& adjustment);

/// The material with an ideal mirror for the light that it does not reflect, channel by channel (eq. 4.56, 4.57).
/// \throws NumericError for anisotropic models, an albedo that is above 1, 0 or not smooth enough for a curve.
[[nodiscard]] Material extended_by_mirror(const Device& device, const Material& material, const Adjustment& adjustment);

}  // namespace lobe
