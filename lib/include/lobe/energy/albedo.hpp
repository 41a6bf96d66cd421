#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for albedos.
struct AlbedoOptions {
  double tolerance = 1e-6;                            ///< for formulas, relative to the albedo
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  double lobe_width = 0.005;  ///< for functions: half-vector width of the narrowest lobes followed, radians
  /// Called for each albedo of formulas whose error stays above the tolerance; if empty, only the error itself tells.
  MissedToleranceCallback missed = {};
};

/// Directional albedo a(theta) = integral of f(L, V) cos(theta_V) over the hemisphere of V (Neumann 2001, eq. 1.13),
/// delta parts included, for light of azimuth 0.
///
/// Formulas: an albedo that the quadrature cannot bring to the tolerance is returned with the error that it has, and
/// reported to `options.missed`.
///
/// Functions and tables have no tolerance to reach. For functions the adaptive quadrature stops at an error of 2e-5 of
/// the albedo, at a hundredth of the function's own error, or at 30 000 points. The error contains that of the
/// quadrature and the integral of the function's own errors, and is NaN if the function does not know them. For tables,
/// and for functions that are constant on cells, the sums over the rows (row_albedos()) are interpolated.
/// \param theta_in angles of incidence in radians, 0 <= theta < pi/2
/// \return estimate[channel][angle]
/// \throws ArgumentError for an angle out of range and for inconsistent tables; NumericError if the quadrature does not
///   converge or gives no finite number, and whatever `options.missed` throws; as adjusted(); DeviceError
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const Device& device, const Reflectance& reflectance,
                                                        std::span<const double> theta_in,
                                                        const AlbedoOptions& options = {});

/// Directional albedo for light from directions with any azimuth, which matters for anisotropic reflectances; the
/// overload for angles takes azimuth 0.
/// \return estimate[channel][direction]
/// \throws as the overload for angles
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const Device& device, const Reflectance& reflectance,
                                                        std::span<const Direction> incident,
                                                        const AlbedoOptions& options = {});

/// Mean albedo A = (1/pi) * integral of a(L) cos(theta) over the hemisphere of L (eq. 1.20), per channel: the result of
/// a white furnace. Errors are as for albedo(); functions aim at 2e-4. Anisotropic functions are evaluated at 8
/// azimuths, which differ from node to node.
/// \throws as albedo()
[[nodiscard]] std::vector<Estimate> mean_albedo(const Device& device, const Reflectance& reflectance,
                                                const AlbedoOptions& options = {});

/// Largest angle, in radians, up to which largest_albedo() searches: 89 degrees.
inline constexpr double kAlbedoPeakThetaMax = 89 * std::numbers::pi / 180;

/// The largest |a(theta)| and its place.
struct AlbedoPeak {
  Estimate albedo;   ///< the largest value; its error includes that of the search
  double theta = 0;  ///< radians
};

/// Finds the largest absolute albedo over 0 <= theta <= theta_max, per channel: the factor by which a coefficient
/// counts in the energy balance of mixtures (Neumann 2001, eq. 5.4). Maxima narrower than a degree, of functions than
/// two, may be missed.
/// \throws ArgumentError unless 0 < theta_max < pi/2; NumericError for anisotropic reflectances; as albedo()
[[nodiscard]] std::vector<AlbedoPeak> largest_albedo(const Device& device, const Reflectance& reflectance,
                                                     double theta_max = kAlbedoPeakThetaMax,
                                                     const AlbedoOptions& options = {});

}  // namespace lobe
