#pragma once

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// The material pumped up, each channel by its own albedo (Neumann 2001, eq. 2.16 and following).
/// \throws NumericError for anisotropic models, what was pumped by another correction, an albedo that is 0
///   or not smooth enough for a curve (see Pumping).
[[nodiscard]] Material pumped(const Device& device, const Material& material, const Adjustment& adjustment);

}  // namespace lobe
