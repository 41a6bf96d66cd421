#include <algorithm>

#include "reference/models.hpp"

namespace lobe::reference {

Real metal_phong(const Vector& light, const Vector& view, Real n) {
  const Real largest_cosine = std::max(dot(kNormal, light), dot(kNormal, view));
  return (n + 2) / (2 * kPi) * cosine_power(mirrored(light), view, n) / largest_cosine;
}

}  // namespace lobe::reference
