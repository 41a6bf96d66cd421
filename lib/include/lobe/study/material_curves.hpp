#pragma once

#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Angles at which curves have their points, radians.
struct CurveAngles {
  std::vector<double> theta;      ///< angles of incidence, for albedos
  std::vector<double> theta_in;   ///< angles of incidence, for reflectances
  std::vector<double> theta_out;  ///< angles of V in the plane of incidence, rising, below 0 on the retro side

  /// Makes the usual angles: albedos every 10 degrees up to 80, and at 85, 88 and 89; reflectances for light from 20,
  /// 45 and 70 degrees, and for V at every degree between the horizons. Of lobes narrower than that, the mirror and the
  /// retro direction are sampled.
  [[nodiscard]] static CurveAngles usual();
};

/// Relative error to which albedos of formulas are refined, unless that takes too long.
inline constexpr double kCurveAlbedoTolerance = 1e-4;

/// Curves that describe a material to people: albedos, and values in the plane of incidence, for light of azimuth 0.
struct MaterialCurves {
  std::vector<std::vector<Estimate>> albedo;                    ///< [channel][theta]; NaN where some are not finite
  std::vector<std::vector<std::vector<Estimate>>> reflectance;  ///< sr^-1, [channel][theta_in][theta_out]
  bool has_delta = false;  ///< whether it has delta parts, which count in albedos alone
};

/// Computes curves of formulas, which need no preparation, of a function with its own errors, or of a table by
/// interpolation.
/// \throws ArgumentError for angles out of range; DeviceError; as albedo() and evaluate() for its kind
[[nodiscard]] MaterialCurves material_curves(const Device& device, const Reflectance& reflectance,
                                             const CurveAngles& angles);

}  // namespace lobe
