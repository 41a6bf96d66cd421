#include <cmath>

#include "reference/fresnel.hpp"
#include "reference/microfacets.hpp"
#include "reference/models.hpp"

namespace lobe::reference {
namespace {

Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Real square(Real x) {
  return x * x;
}

/// Cotangent of the angle from the normal.
Real cotangent(const Vector& direction) {
  return direction.z / std::hypot(direction.x, direction.y);
}

/// He et al. 1991, eq. 24 and 25.
Real shadowing(const Vector& direction, Real sigma, Real tau) {
  const Real c = tau * cotangent(direction) / (2 * sigma);
  if (std::isinf(c)) return 1;
  const Real lambda = (1 / (std::sqrt(kPi) * c) - std::erfc(c)) / 2;
  return (1 - std::erfc(c) / 2) / (lambda + 1);
}

/// Eq. 76, with the polarisations s = k x n / |k x n| and p = s x k of both directions. s, p and k are orthonormal, so
/// that (s.x)^2 + (p.x)^2 = |k x x|^2: taken where both nearly vanish.
Real geometrical_factor(const Vector& light, const Vector& view) {
  constexpr Real kParallel = 1e-3L;
  const Vector in = -1 * light;
  const Vector v = view - in;
  const Real across = length(cross(in, view));
  const auto share = [&](const Vector& k, const Vector& other) {
    Vector s = cross(k, kNormal);
    s = length(s) > 0 ? normalised(s) : Vector{0, 1, 0};
    return square(dot(s, other)) + square(dot(cross(s, k), other));
  };
  const Real shares = across < kParallel ? 1 : share(view, in) * share(in, view) / square(square(across));
  return square(dot(v, v) / v.z) * shares;
}

/// sigma of eq. 80 and 81: sqrt(pi/2) z0 = sigma0/4 (K_i + K_r) exp(-z0^2/(2 sigma0^2)), by bisection and Newton's
/// steps for z = z0/sigma0.
Real effective_roughness(const Vector& light, const Vector& view, Real sigma, Real tau) {
  const auto hidden = [&](const Vector& direction) {
    const Real c = cotangent(direction);
    return std::isinf(c) ? 0 : std::erfc(tau * c / (2 * sigma)) / c;
  };
  const Real right = (hidden(light) + hidden(view)) / 4 / std::sqrt(kPi / 2);
  Real low = 0;
  Real high = 20;
  for (int step = 0; step < 60; ++step) {
    const Real z = (low + high) / 2;
    (z * std::exp(z * z / 2) < right ? low : high) = z;
  }
  Real z = low;
  for (int step = 0; step < 3; ++step) z -= (z - right * std::exp(-z * z / 2)) / (1 + z * right * std::exp(-z * z / 2));
  return sigma / std::sqrt(1 + z * z);
}

}  // namespace

Real roughness_sum(Real g, Real spread) {
  Real sum = 0;
  for (int m = 1; m <= 400; ++m) {
    const Real order = m;
    const Real term = std::exp(order * std::log(g) - g - std::lgamma(order + 1) - spread / order) / order;
    sum += term;
    if (order > g && term < 1e-25L * sum) break;
  }
  return sum;
}

Real he_torrance_phase(const Vector& light, const Vector& view, Real sigma, Real tau) {
  return square(2 * kPi * effective_roughness(light, view, sigma, tau) * (light.z + view.z));
}

Real he_torrance(const Vector& light, const Vector& view, Real sigma, Real tau, Real n, Real k) {
  // Eq. 84: v = 2 pi/lambda (k_r - k_i).
  const Real v_xy = 2 * kPi * std::hypot(light.x + view.x, light.y + view.y);
  const Real distribution =
      square(kPi * tau) / 4 * roughness_sum(he_torrance_phase(light, view, sigma, tau), square(v_xy * tau) / 4);
  return fresnel(cos_half_difference(light, view), n, k) * geometrical_factor(light, view) *
         shadowing(light, sigma, tau) * shadowing(view, sigma, tau) * distribution / (kPi * light.z * view.z);
}

// With k = 2 pi, u, v, w = L + V for L to the light, 1 + L.V = |L + V|^2/2.
Real stam(const Vector& light, const Vector& view, Real sigma, Real tau, Real n, Real k) {
  const Vector sum = light + view;
  const Real wave_number = 2 * kPi;
  const Real g = square(wave_number * sigma * sum.z);
  const Real spread = square(wave_number * tau) * (sum.x * sum.x + sum.y * sum.y) / 4;
  const Real density = kPi * tau * tau * roughness_sum(g, spread);
  const Real geometry = square(dot(sum, sum) / 2) / (light.z * view.z);
  return fresnel(cos_half_difference(light, view), n, k) * geometry / square(sum.z) * square(wave_number / (2 * kPi)) *
         density;
}

Real beard_maxwell(const Vector& light, const Vector& view, const BeardMaxwell& paint) {
  const Vector half = half_vector(light, view);
  const Real delta = std::atan2(std::hypot(half.x, half.y), half.z);
  const Real beta = std::atan2(length(light - view), length(light + view));
  const Real at_normal = fresnel(1, paint.n, paint.k);
  const Real first = at_normal / (4 * std::pow(half.z, 3.0L) * (square(paint.sigma) + tan_squared_delta(half)));
  const Real obscuration = (1 + delta / paint.omega * std::exp(-2 * beta / paint.tau)) / (1 + delta / paint.omega);
  return fresnel(cos_half_difference(light, view), paint.n, paint.k) / at_normal * first * square(half.z) /
         (light.z * view.z) * obscuration;
}

}  // namespace lobe::reference
