#pragma once

/// Code that anisotropic models share.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lobe/model/model.hpp"

namespace lobe {

inline Parameter rotation() {
  return {"rotation",       "rad", -std::numbers::pi,
          std::numbers::pi, 0.0,   "azimuth of the lobe's first axis from the x axis"};
}

/// Cosine and sine of an azimuth; at quarter turns without the rounding of pi.
struct Axis {
  explicit Axis(double azimuth) : cosine(clean(std::cos(azimuth))), sine(clean(std::sin(azimuth))) {}
  static double clean(double x) { return std::abs(x) < 1e-15 ? 0 : x; }
  double cosine, sine;
};

/// How many times longer a lobe is than wide.
inline double aspect_of(double one, double other) {
  return std::max(one, other) / std::min(one, other);
}

}  // namespace lobe
