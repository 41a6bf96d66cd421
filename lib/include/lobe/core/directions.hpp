#pragma once

#include <numbers>

namespace [[gnu::visibility("default")]] lobe {

/// One degree, radians.
inline constexpr double kDegree = std::numbers::pi / 180;

/// An angle in degrees.
/// \param radians the angle
[[nodiscard]] constexpr double to_degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

/// A direction in the upper hemisphere, in radians.
struct Direction {
  double theta = 0;  ///< from the normal
  double phi = 0;    ///< azimuth
};

/// A pair of directions, in radians. theta_in points towards the light and theta_out towards the viewer, both from the
/// normal, in [0, pi/2]. delta_phi = phi_out - phi_in is 0 on the retro side and pi on the mirror side. phi_in is the
/// azimuth of the light from the x axis, on which only anisotropic reflectances depend.
struct Directions {
  double theta_in = 0;   ///< towards the light
  double theta_out = 0;  ///< towards the viewer
  double delta_phi = 0;  ///< phi_out - phi_in
  double phi_in = 0;     ///< azimuth of the light
};

}  // namespace lobe
