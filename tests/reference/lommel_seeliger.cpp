#include <cmath>

#include "reference/models.hpp"
#include "reference/quadrature.hpp"

namespace lobe::reference {

Real lommel_seeliger(const Vector& light, const Vector& view) {
  return 1 / (4 * kPi * (dot(kNormal, light) + dot(kNormal, view)));
}

// Eq. 1.52 with S = 1.
Real hapke_isotropic(const Vector& light, const Vector& view, Real g) {
  const Real alpha = 2 * std::atan2(length(light - view), length(light + view));  // phase angle
  Real opposition = 1;
  if (alpha == 0) {
    opposition = 2;
  } else if (alpha < kPi / 2) {
    const Real taken = -std::expm1(-g / std::tan(alpha));  // 1 - e^(-g/tan alpha)
    opposition = 2 - std::tan(alpha) / (2 * g) * taken * (2 + taken);
  }
  return opposition / (kPi * (light.z + view.z));
}

// Eq. 1.53.
Real hapke_forward(const Vector& light, const Vector& view, Real g) {
  return hapke_isotropic(light, view, g) * 4 / 9 * (1 - dot(light, view) / 2);
}

// Eq. 1.54.
Real hapke_lommel_seeliger(const Vector& light, const Vector& view, Real g) {
  const Real rest = 2 * std::atan2(length(light + view), length(light - view));  // pi - alpha
  // sin(alpha) + (pi - alpha) cos(alpha) = sin(rest) - rest cos(rest), without its cancellation
  const Real scattering = smooth_integral([](Real t) { return t * std::sin(t); }, 0, rest) / kPi;
  return hapke_isotropic(light, view, g) * scattering;
}

}  // namespace lobe::reference
