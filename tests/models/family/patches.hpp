#pragma once

#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {

inline Real distance(const Vector& l, const Vector& v) {
  return std::hypot(l.x + v.x, l.y + v.y);
}

}  // namespace lobe::test
