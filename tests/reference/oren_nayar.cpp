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

}  // namespace lobe::reference
