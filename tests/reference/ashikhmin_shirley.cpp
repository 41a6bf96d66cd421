#include <algorithm>
#include <cmath>

#include "reference/fresnel.hpp"
#include "reference/microfacets.hpp"
#include "reference/models.hpp"

namespace lobe::reference {

Real ashikhmin_shirley(const Vector& light, const Vector& view, Real n, Real f0) {
  const Vector half = half_vector(light, view);
  const Real l_h = cos_half_difference(light, view);
  return (n + 1) / (8 * kPi) * cosine_power(kNormal, half, n) / (l_h * std::max(light.z, view.z)) *
         schlick_fresnel(l_h, f0);
}

Real ashikhmin_shirley_diffuse(const Vector& light, const Vector& view, Real f0) {
  const auto entering = [](Real cosine) { return 1 - std::pow(1 - cosine / 2, 5.0L); };
  return 28 / (23 * kPi) * (1 - f0) * entering(light.z) * entering(view.z);
}

}  // namespace lobe::reference
