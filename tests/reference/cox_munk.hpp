#pragma once

#include "reference/vector.hpp"

/// Slopes of a clean sea under wind (Cox and Munk 1954).
namespace lobe::reference {

struct SeaSlopes {
  /// \param wind m/s
  /// \param rotation azimuth to which the wind blows
  SeaSlopes(Real wind, Real rotation);

  /// Density of slopes, the gradient of the sea's height: negative far out.
  [[nodiscard]] Real density(Real slope_x, Real slope_y) const;
  /// Sum of the absolute values of the terms of the series, over that of the series; infinite where that is negative
  /// or nearly so.
  [[nodiscard]] Real cancellation(Real slope_x, Real slope_y) const;

  Real upwind, crosswind;  ///< mean squares
  Real to_x, to_y;         ///< where the wind blows to
  Real c21, c03;           ///< skewness
};

}  // namespace lobe::reference
