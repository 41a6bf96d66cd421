#pragma once

#include <span>
#include <vector>

#include "lobe/device.hpp"
#include "lobe/estimate.hpp"
#include "lobe/material.hpp"

namespace lobe {

struct AlbedoOptions {
  double tolerance = 1e-6;  ///< relative to the albedo
  Precision precision = Precision::double_precision;
};

/// Albedo a(theta) = integral of f(L, V) cos(theta_V) over the hemisphere of V (Neumann 2001, eq. 1.13).
/// \param theta_in angles of incidence in radians, 0 <= theta < pi/2
/// \return estimate[channel][angle]
/// \throws ArgumentError for an angle out of range; NumericError where the tolerance cannot be met; DeviceError.
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const Device& device, const Material& material,
                                                        std::span<const double> theta_in,
                                                        const AlbedoOptions& options = {});

/// Mean albedo A = (1/pi) * integral of a(theta) cos(theta) over the hemisphere (eq. 1.20), per channel.
/// \throws as albedo().
[[nodiscard]] std::vector<Estimate> mean_albedo(const Device& device, const Material& material,
                                                const AlbedoOptions& options = {});

}  // namespace lobe
