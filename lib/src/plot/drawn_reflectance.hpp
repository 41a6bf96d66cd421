#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// f in the plane of incidence for one direction of light; theta_out is positive on the mirror side and rises.
struct IncidencePlane {
  double theta_in = 0;
  std::vector<double> theta_out;
  std::vector<double> f;  ///< mean of the channels, sr^-1
  bool has_mirror = false;
  bool has_retro = false;
};

/// Albedos by the polar angle, means of the channels and over azimuth.
struct AlbedoByAngle {
  std::vector<double> theta;  ///< radians, rising; two for each ring of cells
  std::vector<double> in;     ///< for light from theta
  std::vector<double> out;    ///< for light into theta
  double mean = 0;            ///< (1.24)
};

/// What pictures show of a reflectance.
struct DrawnReflectance {
  std::string name = {};
  std::string source = {};    ///< where the values are from: a grid's name, or "own values"
  bool has_channels = false;  ///< several, of which means are drawn
  bool has_azimuths = false;  ///< it depends on the azimuth of L
  bool has_delta = false;
  bool has_steps = false;  ///< it is constant on cells
  std::vector<IncidencePlane> planes = {};
  std::vector<Estimate> slice = {};  ///< at slice_directions()
  AlbedoByAngle albedo = {};
};

/// \throws ArgumentError for an inconsistent table
[[nodiscard]] DrawnReflectance drawn(const BrdfTable& table);
/// Formulas and functions by their own values, without a table.
/// \throws as evaluate() and albedo()
[[nodiscard]] DrawnReflectance drawn(const Device& device, const Reflectance& reflectance);

/// Polar angles of light whose planes of incidence are drawn, radians.
[[nodiscard]] std::vector<double> plane_angles();
/// Largest angle of view that is drawn: many models grow without bound beyond it, in a spike along the horizon.
inline constexpr double kLastDrawn = 85 * kDegree;
/// Polar angles of view across the normal, with the directions of mirror and light, up to a last one.
[[nodiscard]] std::vector<double> plane_views(double theta_in, double last);

/// Planes for light from 0, 30, 60 and 75 degrees, interpolated between the nodes, up to the last ring and
/// 85 degrees of view. On grids of
/// cells: those of the nearest rows, each row once, with steps.
[[nodiscard]] std::vector<IncidencePlane> incidence_planes(const BrdfTable& table);

/// The sources, each once.
[[nodiscard]] std::string source_names(std::span<const DrawnReflectance> drawn);

}  // namespace lobe
