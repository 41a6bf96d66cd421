#include <cmath>

#include "reference/fresnel.hpp"
#include "reference/microfacets.hpp"
#include "reference/models.hpp"

namespace lobe::reference {

Real low_microfacet(const Vector& light, const Vector& view, Real a, Real b, Real c, Real index) {
  const Vector from_normal = half_vector(light, view) - kNormal;
  const Real away = dot(from_normal, from_normal) / 2;  // 1 - N.H
  const Real distribution = a / std::pow(1 + b * away, c);
  // with_v_cavities() divides by 4.
  return 4 / kPi * with_v_cavities(light, view, distribution) * fresnel(cos_half_difference(light, view), index, 0);
}

}  // namespace lobe::reference
