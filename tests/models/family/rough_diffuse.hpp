#pragma once

#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {

inline constexpr Real kCircle = 3.14159265358979323846264338327950288L;

/// s/t of Fujii's form: s is the product of both directions along the base plane.
inline Real fujii_ratio(const Vector& light, const Vector& view) {
  const Real along = light.x * view.x + light.y * view.y;
  return along > 0 ? along / std::max(light.z, view.z) : along;
}

inline Real fujii_normal(Real r) {
  return 1 / (1 + (0.5L - 2 / (3 * kCircle)) * r);
}

/// Albedo of Fujii's form by its terms as Portsmouth, Kutz and Hill print them.
inline Real fujii_albedo(const Vector& direction, Real r) {
  const Real sine = std::hypot(direction.x, direction.y);
  const Real angle = std::atan2(sine, direction.z);
  const Real g =
      sine * (angle - sine * direction.z) + 2.0L / 3 * (sine / direction.z * (1 - sine * sine * sine) - sine);
  return fujii_normal(r) * (1 + r * g / kCircle);
}

}  // namespace lobe::test
