#include <algorithm>

#include "reference/models.hpp"

namespace lobe::reference {

Real cook_torrance(const Vector& light, const Vector& view, Real m, Real f0) {
  const Vector half = half_vector(light, view);
  const Real n_h = dot(kNormal, half);
  const Real n_l = dot(kNormal, light);
  const Real n_v = dot(kNormal, view);
  // L.H = V.H as half the length of L + V: the dot product with H loses digits at grazing angles.
  const Real l_h = length(light + view) / 2;
  // Eq. 2.9: Beckmann's distribution, normalised to 1/(4 pi m^2 cos^4).
  const Real distribution = std::exp(-tan_squared_delta(half) / (m * m)) / (4 * kPi * m * m * std::pow(n_h, 4.0L));
  // Eq. 2.10.
  const Real masking = std::min({2 * n_h * n_v / l_h, 2 * n_h * n_l / l_h, 1.0L});
  // Schlick 1994.
  const Real fresnel = f0 + (1 - f0) * std::pow(1 - l_h, 5.0L);
  return distribution * masking * fresnel / (n_l * n_v);
}

}  // namespace lobe::reference
