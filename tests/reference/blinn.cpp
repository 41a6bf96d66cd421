#include <algorithm>

#include "reference/models.hpp"

namespace lobe::reference {

// C(n) = 1 / (8 pi [2/(n+4) (1 - 2^-(n+4)/2) - 1/(n+2) (1 - 2^-(n+2)/2)]): albedo 1 at normal incidence.
Real blinn_constant(Real n) {
  const Real first = 2 / (n + 4) * (1 - std::pow(2.0L, -(n + 4) / 2));
  const Real second = 1 / (n + 2) * (1 - std::pow(2.0L, -(n + 2) / 2));
  return 1 / (8 * kPi * (first - second));
}

Real blinn(const Vector& light, const Vector& view, Real n) {
  return blinn_constant(n) * cosine_power(kNormal, half_vector(light, view), n);
}

Real blinn_phong(const Vector& light, const Vector& view, Real n) {
  return (n + 2) / (2 * kPi) * cosine_power(kNormal, half_vector(light, view), n);
}

// For n >= 4, where the albedo is largest at normal incidence and max(N.L, N.V) = 1 there: the constant of Blinn.
Real blinn_metal(const Vector& light, const Vector& view, Real n) {
  return blinn(light, view, n) / std::max(light.z, view.z);
}

}  // namespace lobe::reference
