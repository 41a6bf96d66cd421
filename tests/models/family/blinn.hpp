#pragma once

#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {

/// 1 + n |ln N.H|
inline auto blinn_condition(Real n) {
  return [=](const Vector& l, const Vector& v) { return 1 + n / 2 * std::log1p(tan_squared_delta(half_vector(l, v))); };
}

}  // namespace lobe::test
