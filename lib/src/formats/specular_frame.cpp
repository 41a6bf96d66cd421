#include "formats/specular_frame.hpp"

#include <algorithm>
#include <numbers>

namespace lobe {
namespace {

/// Degrees: 0, step, 2 step, ... below an end.
std::vector<double> multiples(double step, double end) {
  std::vector<double> angles;
  for (int i = 0; i * step < end; ++i) angles.push_back(i * step);
  return angles;
}

}  // namespace

SpecularGrid::SpecularGrid(const BrdfFunction& brdf) {
  constexpr double kTurn = 360;
  if (brdf.is_isotropic) {
    azimuths = multiples(10, brdf.is_bilateral ? 181 : kTurn);
    return;
  }
  rotations = multiples(15, kTurn);
  incidences = {0, 10, 20, 30, 40, 50, 60, 70, 80, 87};
  azimuths = multiples(10, kTurn);
  radials = {0, 1, 2, 4, 6, 8, 11, 15, 20, 26, 33, 42, 54, 70, 90, 110, 130, 150, 170};
}

void SpecularGrid::take_both_sides() {
  const double last = azimuths.back();
  for (std::size_t k = azimuths.size(); last == 180 && k-- > 1;) {
    if (azimuths[k] < 180) azimuths.push_back(360 - azimuths[k]);
  }
}

SpecularGrid grid_of_rows(const BrdfFunction& brdf) {
  SpecularGrid grid(brdf);
  if (brdf.is_isotropic) return grid;
  grid.rotations = multiples(30, 360);
  grid.incidences = {0, 15, 30, 45, 60, 75, 85};
  grid.azimuths = multiples(30, 360);
  grid.radials = {0, 4, 8, 13, 20, 30, 42, 55, 70, 90, 115, 145};
  return grid;
}

std::vector<Directions> specular_pairs(const SpecularGrid& grid) {
  constexpr double kNearHorizon = 1e-3;  // cosine: functions may be anything there
  constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<Directions> pairs;
  for (const double rotation : grid.rotations) {
    for (const double incidence : grid.incidences) {
      if (incidence == 0 && rotation != grid.rotations.front()) continue;  // the azimuths do that
      for (const double azimuth : grid.azimuths) {
        for (const double radial : grid.radials) {
          if (radial == 0 && azimuth != grid.azimuths.front()) continue;
          const Eigen::Vector3d v = scattered_direction(incidence * kDegree, azimuth * kDegree, radial * kDegree);
          if (v.z() <= kNearHorizon) continue;
          const double delta_phi = std::atan2(v.y(), v.x()) + std::numbers::pi;  // the light stands opposite
          pairs.push_back({incidence * kDegree, std::acos(std::min(v.z(), 1.0)), delta_phi < kTurn ? delta_phi : 0,
                           rotation * kDegree});
        }
      }
    }
  }
  return pairs;
}

}  // namespace lobe
