#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// How albedos are computed.
struct AlbedoOptions {
  double tolerance = 1e-6;                            ///< of formulas, relative to the albedo
  Precision precision = Precision::double_precision;  ///< of the models
  double lobe_width = 0.005;  ///< of functions: smallest half-vector width of lobes that is followed, radians
  /// Called for each albedo of formulas whose error stays above the tolerance; empty: only its error says so.
  MissedToleranceCallback missed = {};
};

/// Albedo a(theta) = integral of f(L, V) cos(theta_V) over the hemisphere of V (Neumann 2001, eq. 1.13), delta parts
/// included, for light of azimuth 0.
///
/// Formulas: an albedo that the quadrature cannot bring to the tolerance is returned with the error that it has, and
/// told to `options.missed`.
///
/// Functions and tables have no tolerance to reach. Of functions the adaptive quadrature ends at an error of 2e-5 of
/// the albedo, a hundredth of the function's own, or at 30 000 points; errors are that of the quadrature and the
/// integral of the function's own errors, NaN where it does not know them. Tables, and functions that are constant on
/// cells: the sums over the rows (row_albedos()), interpolated.
/// \param theta_in angles of incidence in radians, 0 <= theta < pi/2
/// \return estimate[channel][angle]
/// \throws ArgumentError for an angle out of range and for inconsistent tables; NumericError where the quadrature does
///   not converge or gives no finite number, and what `options.missed` throws; as adjusted(); DeviceError.
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const Device& device, const Reflectance& reflectance,
                                                        std::span<const double> theta_in,
                                                        const AlbedoOptions& options = {});

/// The same for light from directions of any azimuth, which counts for anisotropic reflectances; above it is 0.
/// \return estimate[channel][direction]
/// \throws as above.
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const Device& device, const Reflectance& reflectance,
                                                        std::span<const Direction> incident,
                                                        const AlbedoOptions& options = {});

/// Mean albedo A = (1/pi) * integral of a(L) cos(theta) over the hemisphere of L (eq. 1.20), per channel. Errors are as
/// those of albedo(), of functions 2e-4 wanted; anisotropic functions are taken at 8 azimuths, which differ from node
/// to node.
/// \throws as albedo().
[[nodiscard]] std::vector<Estimate> mean_albedo(const Device& device, const Reflectance& reflectance,
                                                const AlbedoOptions& options = {});

/// Up to where albedos are searched for their largest value, radians: 89 degrees.
inline constexpr double kAlbedoPeakThetaMax = 89 * std::numbers::pi / 180;

/// The largest |a(theta)| and where it is taken.
struct AlbedoPeak {
  Estimate albedo;   ///< the error includes that of the search
  double theta = 0;  ///< radians
};

/// The largest absolute albedo over 0 <= theta <= theta_max, per channel: the factor by which a coefficient counts in
/// the energy balance of mixtures (Neumann 2001, eq. 5.4). Maxima narrower than a degree may be missed.
/// \throws ArgumentError unless 0 < theta_max < pi/2; NumericError for anisotropic reflectances; as albedo().
[[nodiscard]] std::vector<AlbedoPeak> largest_albedo(const Device& device, const Reflectance& reflectance,
                                                     double theta_max = kAlbedoPeakThetaMax,
                                                     const AlbedoOptions& options = {});

}  // namespace lobe
