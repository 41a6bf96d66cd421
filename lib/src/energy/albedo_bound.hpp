#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/energy/plausibility.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// Least upper bounds of the albedos of a material, by channel, and how they were looked for.
struct AlbedoBounds {
  std::vector<AlbedoBound> channels;
  std::vector<double> certain;  ///< by channel: what the largest albedo is at least
  std::size_t incident = 0;
  std::size_t unresolved = 0;
  double least_elevation = 0;
  std::uint64_t nodes = 0;  ///< of quadrature
};

/// See check_plausibility().
/// \param material of at least one term
/// \throws as it
[[nodiscard]] AlbedoBounds albedo_bounds(const Device& device, const Material& material, bool is_isotropic,
                                         const PlausibilityOptions& options);

}  // namespace lobe
