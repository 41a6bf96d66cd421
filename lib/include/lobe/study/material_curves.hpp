#pragma once

#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Where curves have their points, radians.
struct CurveAngles {
  std::vector<double> theta;      ///< of incidence, of albedos
  std::vector<double> theta_in;   ///< of incidence, of reflectances
  std::vector<double> theta_out;  ///< of V in the plane of incidence, rising, below 0 on the retro side

  /// Albedos every 10 degrees up to 80, and at 85, 88 and 89; reflectances for light from 20, 45 and 70 degrees, of
  /// V every degree between the horizons. Of lobes narrower than that, the mirror and the retro direction are seen.
  [[nodiscard]] static CurveAngles usual();
};

/// Relative error that albedos of formulas are refined to, unless that takes too long.
inline constexpr double kCurveAlbedoTolerance = 1e-4;

/// What a material is like, for people: albedos, and values in the plane of incidence, for light of azimuth 0.
struct MaterialCurves {
  std::vector<std::vector<Estimate>> albedo;                    ///< [channel][theta]; NaN where some are not finite
  std::vector<std::vector<std::vector<Estimate>>> reflectance;  ///< sr^-1, [channel][theta_in][theta_out]
  bool has_delta = false;                                       ///< with delta parts, which count in albedos alone
};

/// Curves of formulas, which need no preparation, of a function with its own errors, or of a table by interpolation.
/// \throws ArgumentError for angles out of range; DeviceError; as albedo() and evaluate() of what it is.
[[nodiscard]] MaterialCurves material_curves(const Device& device, const Reflectance& reflectance,
                                             const CurveAngles& angles);

}  // namespace lobe
