#include <algorithm>

#include "reference/models.hpp"

namespace lobe::reference {

// Printed with L.V + N.L N.V; the sine product s1 s2 cos(delta_phi) is L.V - N.L N.V (errata to eq. 1.56). It is taken
// from the projections onto the base plane, where it does not cancel.
Real oren_nayar(const Vector& light, const Vector& view, Real sigma, Real a_denominator) {
  const Real sigma2 = sigma * sigma;
  const Real a = 1 - 0.5L * sigma2 / (sigma2 + a_denominator);
  const Real b = 0.45L * sigma2 / (sigma2 + 0.09L);
  const Real sines = light.x * view.x + light.y * view.y;
  const Real largest_cosine = std::max(dot(kNormal, light), dot(kNormal, view));
  return (a + b * std::max(sines, 0.0L) / largest_cosine) / kPi;
}

// Oren and Nayar 1994, eq. 27 to 30 (Neumann 2001, eq. 1.57 to 1.59 with the signs repaired), in angles.
Real oren_nayar_full(const Vector& light, const Vector& view, Real sigma, Real rho, Real a_denominator) {
  const Real theta_i = std::atan2(std::hypot(light.x, light.y), light.z);
  const Real theta_o = std::atan2(std::hypot(view.x, view.y), view.z);
  const Real alpha = std::max(theta_i, theta_o);
  const Real beta = std::min(theta_i, theta_o);
  const Real sines = std::sin(theta_i) * std::sin(theta_o);
  const Real cosine = sines > 0 ? (light.x * view.x + light.y * view.y) / sines : 0;
  const Real s2 = sigma * sigma;
  const Real c1 = 1 - 0.5L * s2 / (s2 + a_denominator);
  const Real c2 = 0.45L * s2 / (s2 + 0.09L) * (std::sin(alpha) - (cosine < 0 ? std::pow(2 * beta / kPi, 3.0L) : 0.0L));
  const Real c3 = 0.125L * s2 / (s2 + 0.09L) * std::pow(4 * alpha * beta / (kPi * kPi), 2.0L);
  const Real direct =
      rho / kPi * (c1 + cosine * c2 * std::tan(beta) + (1 - std::abs(cosine)) * c3 * std::tan((alpha + beta) / 2));
  const Real again = 0.17L * rho * rho / kPi * s2 / (s2 + 0.13L) * (1 - cosine * std::pow(2 * beta / kPi, 2.0L));
  return std::max(0.0L, direct + again);  // negative for small rho and sigma > 0.65 near grazing mirror directions
}

}  // namespace lobe::reference
