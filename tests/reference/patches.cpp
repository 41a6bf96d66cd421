#include <algorithm>
#include <cmath>
#include <functional>

#include "reference/fresnel.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"

namespace lobe::reference {

namespace {

/// Integral of g over [low, high], split at 1, where the area of a patch stops growing (4.7).
Real split_integral(const std::function<Real(Real)>& g, Real low, Real high) {
  const Real middle = std::clamp(1.0L, low, high);
  return smooth_integral(g, low, middle) + smooth_integral(g, middle, high);
}

Real patch_area(Real radius) {
  return kPi * std::min(1.0L, radius * radius);
}

}  // namespace

// Eq. 4.39; 4.42 with the slope -1 / (R - rR) between the radii.
Real patch_frustum(const Vector& light, const Vector& view, Real radius, Real inner) {
  const Real low = radius * inner;
  const Real distance = std::hypot(light.x + view.x, light.y + view.y);
  const Real constant = (radius - low) / split_integral(patch_area, low, radius);
  return constant * std::clamp((radius - distance) / (radius - low), 0.0L, 1.0L);
}

// Eq. 4.20: patches of all radii from the distance on.
Real patch_band(const Vector& light, const Vector& view, Real radius, Real inner, Real rise) {
  const Real low = radius * inner;
  const Real distance = std::hypot(light.x + view.x, light.y + view.y);
  if (distance >= radius) return 0;
  const auto density = [&](Real t) { return (1 - rise) * (radius - t) + rise * (t - low); };
  const Real total = smooth_integral(density, low, radius);
  // In ln t, so that a wide band is smooth.
  const auto part = [&](Real s) { return density(std::exp(s)) / total / patch_area(std::exp(s)) * std::exp(s); };
  const Real from = std::log(std::max(distance, low));
  const Real to = std::log(radius);
  const Real middle = std::clamp(0.0L, from, to);
  return smooth_integral(part, from, middle) + smooth_integral(part, middle, to);
}

// Eq. 5.12.
Real patch_power(const Vector& light, const Vector& view, Real n) {
  const Real distance = std::hypot(light.x + view.x, light.y + view.y);
  return distance < 1 ? (n + 1) * (n + 2) / (2 * kPi) * std::pow(1 - distance, n) : 0;
}

// Eq. 4.59; the constant from the albedo at grazing incidence, over circles of radius m = 2 sin(t) about the edge of
// the disc, of which the arc of 2 arccos(m/2) lies inside.
Real generalised_lambert(const Vector& light, const Vector& view, Real d, Real clip) {
  const auto profile = [&](Real m) {
    const Real bounded = std::min(m, clip) / 2;
    return std::pow(1 - bounded * bounded, -d / 2);
  };
  const auto area = [&](Real t) {
    const Real m = 2 * std::sin(t);
    return profile(m) * m * 2 * std::acos(std::min(1.0L, m / 2)) * 2 * std::cos(t);
  };
  const Real edge = std::asin(clip / 2);
  return profile(std::hypot(light.x + view.x, light.y + view.y)) /
         (smooth_integral(area, 0, edge) + smooth_integral(area, edge, kPi / 2));
}

// Eq. 5.11. B lies above the middle of L'_P and V_P: (N.B)^2 = 1 - |V_P-L_P|^2/4, multiplied out for unit vectors.
Real patch_character(const Vector& light, const Vector& view, Real s, Real alpha) {
  const Vector sum = light + view;
  const Real difference = light.z - view.z;
  const Real square = (dot(sum, sum) + difference * difference) / 4;
  return exponential_patch(light, view, s) * std::pow(square, alpha / 2);
}

// Eq. 4.54.
Real coated_metal(const Vector& light, const Vector& view, Real s, Real index, Real k) {
  const Real sine = std::hypot(light.x - view.x, light.y - view.y) / 2;
  return exponential_patch(light, view, s) * fresnel(std::sqrt(std::max(0.0L, (1 - sine) * (1 + sine))), index, k);
}

}  // namespace lobe::reference
