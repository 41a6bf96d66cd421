#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "lobe/core/directions.hpp"

namespace lobe {

/// The direction by angles about the specular one, radians, of light whose specular direction has the azimuth 0:
/// azimuth 0 is towards the normal, 90 degrees along specular x that.
[[nodiscard]] inline Eigen::Vector3d scattered_direction(double incidence, double azimuth, double radial) {
  const Eigen::Vector3d specular(std::sin(incidence), 0, std::cos(incidence));
  const Eigen::Vector3d upward(-std::cos(incidence), 0, std::sin(incidence));
  return std::cos(radial) * specular +
         std::sin(radial) * (std::cos(azimuth) * upward + std::sin(azimuth) * specular.cross(upward));
}

/// Angles at which files about the specular direction are written, degrees: dense about it.
struct SpecularGrid {
  std::vector<double> incidences{0, 5, 10, 20, 30, 40, 50, 60, 70, 80, 85, 88};
  std::vector<double> azimuths;
  std::vector<double> radials{0,  0.25, 0.5, 1,  1.5, 2,  3,  4,  5,   6,   8,   10,  12.5, 15,  17.5, 20,
                              25, 30,   40,  50, 60,  70, 80, 90, 100, 110, 120, 130, 140,  150, 160,  170};

  /// \param last of the azimuths about the specular direction: 180 where both sides are the same
  explicit SpecularGrid(double last) {
    constexpr double kStep = 10;
    for (double azimuth = 0; azimuth <= last; azimuth += kStep) azimuths.push_back(azimuth);
  }
};

}  // namespace lobe
