#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/table/brdf_function.hpp"

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
  std::vector<double> rotations{0};
  std::vector<double> incidences{0, 5, 10, 20, 30, 40, 50, 60, 70, 80, 85, 88};
  std::vector<double> azimuths;
  std::vector<double> radials{0,  0.25, 0.5, 1,  1.5, 2,  3,  4,  5,   6,   8,   10,  12.5, 15,  17.5, 20,
                              25, 30,   40,  50, 60,  70, 80, 90, 100, 110, 120, 130, 140,  150, 160,  170};

  /// Half the azimuths do for reflectances that are the same on both sides.
  explicit SpecularGrid(const BrdfFunction& brdf);
  /// Takes all azimuths, for programs that do not know of a symmetry.
  void take_both_sides();
};

/// The grid of files of rows. Of anisotropic reflectances it has fewer angles, for readers interpolate between any
/// rows, which takes long, and worse where they lie close together in some of the four angles alone.
[[nodiscard]] SpecularGrid grid_of_rows(const BrdfFunction& brdf);

/// The pairs of directions of a grid whose viewer is above the horizon, each once; the light's azimuths are the
/// rotations, and differences of azimuth are in [0, 2 pi).
[[nodiscard]] std::vector<Directions> specular_pairs(const SpecularGrid& grid);

}  // namespace lobe
