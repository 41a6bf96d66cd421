#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

namespace lobe {

/// The direction at an angle from the normal and an azimuth, radians.
[[nodiscard]] inline Eigen::Vector3d unit_vector(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Unit vectors L and V by half-vector, at azimuth 0, and difference vector (Rusinkiewicz 1998).
[[nodiscard]] inline std::pair<Eigen::Vector3d, Eigen::Vector3d> half_difference_vectors(double theta_h, double theta_d,
                                                                                         double phi_d) {
  const Eigen::AngleAxisd tilt(theta_h, Eigen::Vector3d::UnitY());
  return {tilt * unit_vector(theta_d, phi_d), tilt * unit_vector(theta_d, phi_d + std::numbers::pi)};
}

}  // namespace lobe
