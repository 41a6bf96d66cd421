#include "reference/models.hpp"

namespace lobe::reference {

Real exponential_patch(const Vector& light, const Vector& view, Real s) {
  const Vector h = light + view;
  const Vector in_plane = h - dot(kNormal, h) * kNormal;
  const Real m = length(in_plane);  // eq. 4.1
  return s * s / (2 * kPi * (1 - (1 + s) * std::exp(-s))) * std::exp(-s * m);
}

}  // namespace lobe::reference
