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

Real low_smooth(const Vector& light, const Vector& view, Real a, Real b, Real c, Real index) {
  const Real to_mirror = std::hypot(light.x + view.x, light.y + view.y);  // eq. 10
  const Real sine = std::hypot(light.x - view.x, light.y - view.y) / 2;   // eq. 14
  return a / std::pow(1 + b * to_mirror * to_mirror, c) * fresnel(std::sqrt((1 - sine) * (1 + sine)), index, 0);
}

}  // namespace lobe::reference
