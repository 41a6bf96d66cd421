#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A distant point light.
struct PointLight {
  std::array<double, 3> direction{0, 0, 1};  ///< towards the light, any length: x to the right, y up, z to the viewer
  double irradiance = 0;                     ///< irradiance of a surface that faces it
};

/// Lighting of a sphere. Irradiances are in units of the sky's radiance; the light is the same at all wavelengths, or
/// that of a white light.
struct SphereLighting {
  std::vector<PointLight> points = {};  ///< any number of point lights
  double sky = 0;                       ///< radiance of homogeneous daylight (Neumann 2001, eq. 3.32)
};
/// Makes three point lights: one from above left, weaker ones from the right and from behind.
[[nodiscard]] SphereLighting three_point_lights();
/// Makes homogeneous daylight of radiance 1, as in Lighting::daylight().
[[nodiscard]] SphereLighting homogeneous_daylight();

/// Angular radius, in radians, of the discs of equal irradiance as which ideal mirrors show point lights.
inline constexpr double kLightDiscRadius = 0.03;

/// Options for rendering a sphere.
struct SphereOptions {
  std::size_t size = 192;         ///< pixels along an edge of the picture, which the sphere touches
  double white = 1;               ///< radiance to which errors are relative, where values are not above it
  double tolerance = 1.0 / 1024;  ///< relative error wanted for each pixel
  Eigen::MatrixXd weights = {};   ///< channels of the picture x channels of the reflectance; empty: the same channels
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  ProgressCallback progress = {};                     ///< told of the progress; may cancel
};

/// A sphere as a distant viewer sees it, pixel by pixel in rows from the upper left.
struct SphereImage {
  std::size_t size = 0;      ///< pixels along an edge
  Eigen::VectorXd coverage;  ///< fraction of each pixel that the sphere covers
  Eigen::MatrixXd radiance;  ///< mean over the pixel, 0 outside the sphere; channels x pixels
  Eigen::MatrixXd error;     ///< error of the quadratures; for tables and measurements also of albedos
};

/// Renders a sphere that is lit and seen from far away (Neumann 2001, 3.6): the reflected radiance f N.L E for point
/// lights, and sky times albedo for daylight (3.32), averaged over pixels by Gauss rules that are doubled until the
/// tolerance is met. Light comes from both sides of the horizon, and the sphere shadows only itself. Anisotropic
/// reflectances have their x axis along the parallels about the vertical axis, eastwards, and their y axis northwards.
/// \throws ArgumentError for a size outside 1 to 4096, weights that do not fit, a light without direction, an
///   irradiance or a sky that is negative or not finite, and a light in the viewer's direction if there is a
///   retro-reflecting delta part; NumericError for lobes much narrower than a pixel, and if values are not finite; as
///   evaluate() and albedo(); DeviceError; Cancelled
[[nodiscard]] SphereImage render_sphere(const Device& device, const Reflectance& reflectance,
                                        const SphereLighting& lighting, const SphereOptions& options = {});

/// Radiance towards viewers under a sky of radiance 1; channels of the picture x viewers.
struct SkyRadiance {
  Eigen::MatrixXd value;  ///< radiances
  Eigen::MatrixXd error;  ///< their errors
};

/// Computes the radiance of a surface under homogeneous daylight of radiance 1 towards viewers: the integral of
/// f(L, V) N.L over L, delta parts included, as the spheres of render_sphere() show it. For reciprocal reflectances it
/// is the albedo of light from the direction of the viewer.
/// \param viewers directions with 0 <= theta < pi/2
/// \param options `weights` and `progress` count, for formulas also `tolerance` and `precision`
/// \throws ArgumentError for directions out of range, weights that do not fit and a tolerance that is not above 0;
///   NumericError for values that are not finite; as adjusted(); DeviceError; Cancelled
[[nodiscard]] SkyRadiance sky_radiance(const Device& device, const Reflectance& reflectance,
                                       std::span<const Direction> viewers, const SphereOptions& options = {});

/// Albedo of the grey reference sphere.
inline constexpr double kReferenceAlbedo = 0.5;
/// Lightness at which the median pixel of the grey reference sphere is shown, of 1.
inline constexpr double kReferenceLightness = 0.5;

/// Factor on radiances that shows the median over a Lambertian sphere of albedo kReferenceAlbedo, under the same
/// lighting, at kReferenceLightness in sRGB (Neumann 2001, 3.6).
/// \throws ArgumentError if half of that sphere or more gets no light, and as render_sphere()
[[nodiscard]] double reference_exposure(const SphereLighting& lighting);

}  // namespace lobe
