#include "reference/microfacets.hpp"

#include <algorithm>
#include <cmath>

#include "reference/quadrature.hpp"

namespace lobe::reference {
namespace {

/// Normalising integral of exp(-angle^2/m^2) cos sin over [0, pi/2].
Real gaussian_area(Real m) {
  return smooth_integral(
      [=](Real angle) { return std::exp(-angle * angle / (m * m)) * std::cos(angle) * std::sin(angle); }, 0,
      std::min(kPi / 2, 7 * m));
}

}  // namespace

Real with_v_cavities(const Vector& light, const Vector& view, Real distribution) {
  const Real n_h = dot(kNormal, half_vector(light, view));
  const Real l_h = cos_half_difference(light, view);
  const Real masking = std::min({1.0L, 2 * n_h * light.z / l_h, 2 * n_h * view.z / l_h});
  return distribution * masking / (4 * light.z * view.z);
}

Real beckmann_facets(const Vector& half, Real m) {
  return std::exp(-tan_squared_delta(half) / (m * m)) / (kPi * m * m * std::pow(half.z, 4.0L));
}

Real blinn_facets(const Vector& half, Real n) {
  return (n + 2) / (2 * kPi) * cosine_power(kNormal, half, n);
}

Real torrance_facets(const Vector& half, Real m) {
  const Real angle = std::atan2(std::hypot(half.x, half.y), half.z);
  return std::exp(-angle * angle / (m * m)) / (2 * kPi * gaussian_area(m));
}

Real trowbridge_facets(const Vector& half, Real q) {
  // 1 + (q^2 - 1) cos^2 = sin^2 + q^2 cos^2
  const Real ellipse = half.x * half.x + half.y * half.y + q * q * half.z * half.z;
  return q * q / (kPi * ellipse * ellipse);
}

}  // namespace lobe::reference
