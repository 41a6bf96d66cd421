#pragma once

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// The material with an ideal mirror for the light that it does not reflect, channel by channel (Neumann 2001, eq. 4.56
/// and 4.57).
/// \throws NumericError for anisotropic models, an albedo that is above 1, 0 or not smooth enough for a curve.
[[nodiscard]] Material extended_by_mirror(const Device& device, const Material& material, const Adjustment& adjustment);

}  // namespace lobe
