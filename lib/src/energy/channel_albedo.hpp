#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// One channel of a material; terms without weight in it are left out.
[[nodiscard]] Material channel_of(const Material& material, std::size_t channel);

/// The albedo of a material of one channel as a curve (hemisphere/albedo_curve.hpp).
/// \param what cannot be done without it, for messages
/// \throws NumericError where it is 0 or not smooth enough
[[nodiscard]] std::vector<double> albedo_curve(const Device& device, const Material& material, std::string_view what);

/// \throws NumericError for anisotropic models
void require_isotropic(const Material& material, std::string_view what);

}  // namespace lobe
