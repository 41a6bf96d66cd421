#pragma once

#include <Eigen/Core>
#include <cmath>

namespace lobe {

/// The direction at an angle from the normal and an azimuth, radians.
[[nodiscard]] inline Eigen::Vector3d unit_vector(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

}  // namespace lobe
