#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "plot/drawn_reflectance.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// One image for each: f over the angles of the half-vector theta_h (across) and of the difference theta_d (up) at
/// phi_d = 90 degrees, after Burley 2012.
[[nodiscard]] gnuplot::Picture slice_picture(const std::string& stem, std::span<const DrawnReflectance> drawn,
                                             PictureFormat format);

/// The slice's directions row by row, theta_h rising within each, theta_d from row to row.
[[nodiscard]] std::vector<Directions> slice_directions();

/// Directions with these half-vector angles (radians) and phi_d = 90 degrees.
[[nodiscard]] Directions half_difference_directions(double theta_h, double theta_d);

}  // namespace lobe
