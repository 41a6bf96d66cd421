#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A distant point light.
struct PointLight {
  std::array<double, 3> direction{0, 0, 1};  ///< towards it, of any length: x to the right, y up, z towards the viewer
  double irradiance = 0;                     ///< of a surface that faces it
};

/// What a sphere is lit by, in the unit of radiance in which the sky is given, the same at all wavelengths or that of a
/// white light.
struct SphereLighting {
  std::vector<PointLight> points = {};  ///< any number of them
  double sky = 0;  ///< radiance of homogeneous daylight, the same from everywhere (Neumann 2001, eq. 3.32)
};
/// Three point lights: one from above left, weaker ones from the right and from behind.
[[nodiscard]] SphereLighting three_point_lights();
/// Homogeneous daylight, that of Lighting::daylight(): of radiance 1.
[[nodiscard]] SphereLighting homogeneous_daylight();

/// Ideal mirrors show point lights as discs of this angular radius, radians, of the same irradiance.
inline constexpr double kLightDiscRadius = 0.03;

/// How a sphere is rendered.
struct SphereOptions {
  std::size_t size = 192;         ///< pixels along an edge of the picture, which the sphere touches
  double white = 1;               ///< radiance that errors are relative to, where values are not above it
  double tolerance = 1.0 / 1024;  ///< wanted of each pixel, relative
  Eigen::MatrixXd weights = {};   ///< channels of the picture by those of the reflectance; empty: those
  Precision precision = Precision::double_precision;  ///< of the models
  ProgressCallback progress = {};                     ///< told of the progress; may cancel
};

/// A sphere as a distant viewer sees it, pixel by pixel, from the upper left on in rows.
struct SphereImage {
  std::size_t size = 0;      ///< pixels along an edge
  Eigen::VectorXd coverage;  ///< share of each pixel that the sphere covers
  Eigen::MatrixXd radiance;  ///< mean over the pixel, 0 beside the sphere; channels x pixels
  Eigen::MatrixXd error;  ///< of the quadratures; of tables and measurements, whose values are taken as they are, also
                          ///< that of their albedos
};

/// Renders a sphere, lit and seen from far away (Neumann 2001, 3.6): the reflected radiance f N.L E of point lights and
/// sky times albedo of daylight (3.32), averaged over pixels, by Gauss rules that are doubled until the tolerance is
/// met. Light comes from both sides of the horizon, and the sphere casts no shadow but on itself. Anisotropic
/// reflectances have their x axis along the parallels about the vertical axis, eastwards, and their y axis northwards.
/// \throws ArgumentError for a size outside 1 to 4096, weights that do not fit, a light without direction, an
/// irradiance or
///   a sky that is negative or no finite number, and for a light in the viewer's direction where there is a retro-
///   reflecting delta part; NumericError for lobes much narrower than a pixel, and where values are no finite numbers;
///   as evaluate() and albedo(); DeviceError; Cancelled.
[[nodiscard]] SphereImage render_sphere(const Device& device, const Reflectance& reflectance,
                                        const SphereLighting& lighting, const SphereOptions& options = {});

/// Albedo of the grey reference sphere.
inline constexpr double kReferenceAlbedo = 0.5;
/// What its median pixel is shown as, of 1.
inline constexpr double kReferenceLightness = 0.5;

/// The factor of radiances after which the median over a Lambertian sphere of the reference's albedo, under the same
/// lighting, is shown as the reference's lightness in sRGB (Neumann 2001, 3.6).
/// \throws ArgumentError where half of that sphere or more gets no light, and as render_sphere().
[[nodiscard]] double reference_exposure(const SphereLighting& lighting);

}  // namespace lobe
