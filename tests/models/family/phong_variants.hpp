#pragma once

#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {

/// 1 + n (|ln R.V| + 1/R.V): an ulp of R.V, raised to n.
inline Real mirror_condition(Real n, const Vector& l, const Vector& v) {
  const Vector mirror = reference::mirrored(l);
  const Real deficit = dot(mirror - v, mirror - v) / 2;
  return deficit < 1 ? 1 + n * (1 / (1 - deficit) - std::log1p(-deficit)) : 1;
}

/// Where R.V or L.V is an ulp above 0 and not below it.
inline auto floor_of(Real n) {
  return [=](Real eps) { return (n + 2) * std::pow(8 * eps, n) / 1e-4L; };
}

}  // namespace lobe::test
