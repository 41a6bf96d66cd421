#include <cmath>

#include "reference/models.hpp"

namespace lobe::reference {

Real schlick(const Vector& light, const Vector& view, Real r) {
  const Vector half = half_vector(light, view);
  // 1 - (1-r) cos^2 = sin^2 + r cos^2
  const Real zenith = half.x * half.x + half.y * half.y + r * half.z * half.z;
  const auto smith = [=](Real cosine) { return cosine / (r + (1 - r) * cosine); };
  return r / (zenith * zenith) * smith(light.z) * smith(view.z) / (4 * kPi * light.z * view.z);
}

}  // namespace lobe::reference
