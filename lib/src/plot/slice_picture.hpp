#pragma once

#include <span>
#include <string>

#include "lobe/table/table.hpp"
#include "plot/gnuplot.hpp"

namespace lobe {

/// One image per table: f over the angles of the half-vector theta_h (across) and of the difference theta_d (up) at
/// phi_d = 90 degrees, after Burley 2012.
[[nodiscard]] gnuplot::Picture slice_picture(const std::string& stem, std::span<const BrdfTable> tables,
                                             PictureFormat format);

/// Directions with these half-vector angles (radians) and phi_d = 90 degrees.
[[nodiscard]] Directions half_difference_directions(double theta_h, double theta_d);

}  // namespace lobe
