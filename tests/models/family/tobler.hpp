#pragma once

#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {

/// 1 - R_S.V_S and the difference of the cosines, of which an ulp is what the kernel has.
inline Real spread(const Vector& l, const Vector& v) {
  const Real product = l.z * v.z;
  const Real difference = l.z - v.z;
  const Real m2 = (l.x + v.x) * (l.x + v.x) + (l.y + v.y) * (l.y + v.y);
  return 2 * (difference * difference * (1 + product) + product * m2) + std::abs(difference);
}

}  // namespace lobe::test
