#pragma once

#include "lobe/core/directions.hpp"

namespace lobe {

/// A point of the square [-1, 1]^2.
struct SquarePoint {
  double a = 0;
  double b = 0;
};

/// Shirley and Chiu 1997: the square to the unit disc, area for area; the disc is sin(theta), phi.
[[nodiscard]] Direction square_to_hemisphere(SquarePoint p);
/// The inverse.
/// \param direction its azimuth may be any
[[nodiscard]] SquarePoint hemisphere_to_square(Direction direction);

}  // namespace lobe
