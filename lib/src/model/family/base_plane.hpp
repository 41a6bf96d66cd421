#pragma once

#include <algorithm>
#include <numbers>

#include "model/catalogue.hpp"

namespace lobe {

inline constexpr double kWholeBasePlane = 2;  // no two points of the unit disc are farther apart

/// \param v R
inline Coefficients basic_patch_coefficients(Values v) {
  const double square = v[0] * v[0];
  // At R = 2 rounding must not cut off the farthest direction at grazing angles.
  const double limit = v[0] < kWholeBasePlane ? square : 2 * square;
  return {1 / (std::numbers::pi * std::min(1.0, square)), limit};
}

/// \param v R, its share that is the inner radius
inline double inner_radius(Values v) {
  return v[0] * v[1];
}

}  // namespace lobe
