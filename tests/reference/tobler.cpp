#include <cmath>

#include "reference/models.hpp"

namespace lobe::reference {

namespace {

/// R_S . V_S (1.69).
Real sphere_cosine(const Vector& light, const Vector& view) {
  const Vector mirror = mirrored(light);
  const Vector r = 2 * mirror.z * mirror - kNormal;
  const Vector v = 2 * view.z * view - kNormal;
  const Vector difference = r - v;
  return 1 - dot(difference, difference) / 2;
}

}  // namespace

// Eq. 1.71 with the factor 2/pi.
Real tobler_power(const Vector& light, const Vector& view, Real n) {
  const Real cosine = sphere_cosine(light, view);
  return cosine > 0 ? 2 * (n + 1) / kPi * std::pow(cosine, n) : 0;
}

// Eq. 1.72 with the factor 2/pi.
Real tobler_exponential(const Vector& light, const Vector& view, Real s) {
  return 2 * s / (kPi * -std::expm1(-2 * s)) * std::exp(-s * (1 - sphere_cosine(light, view)));
}

}  // namespace lobe::reference
