#include <algorithm>
#include <cmath>

#include "reference/fresnel.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"

namespace lobe::reference {

Real metal_phong(const Vector& light, const Vector& view, Real n) {
  const Real largest_cosine = std::max(dot(kNormal, light), dot(kNormal, view));
  return (n + 2) / (2 * kPi) * cosine_power(mirrored(light), view, n) / largest_cosine;
}

// Eq. 3.12.
Real p_model(const Vector& light, const Vector& view, Real n, Real p) {
  return phong(light, view, n) / std::pow(std::max(light.z, view.z), p);
}

// Eq. 3.13.
Real retro_metal_phong(const Vector& light, const Vector& view, Real n) {
  return (n + 2) / (2 * kPi) * cosine_power(light, view, n) / std::max(light.z, view.z);
}

// Eq. 3.29.
Real metal_phong_fresnel(const Vector& light, const Vector& view, Real n, Real index, Real k) {
  return metal_phong(light, view, n) * fresnel(std::max(light.z, view.z), index, k);
}

// Eq. 5.17.
Real phong_mean(const Vector& light, const Vector& view, Real n, Real p) {
  const Real mean =
      p == 0 ? std::sqrt(light.z * view.z) : std::pow((std::pow(light.z, p) + std::pow(view.z, p)) / 2, 1 / p);
  return phong(light, view, n) / mean;
}

// Eq. 5.17; the constant from the albedo at grazing incidence, over angles from R, of which half are above the horizon.
Real phong_bisector(const Vector& light, const Vector& view, Real n) {
  const Vector mirror = mirrored(light);
  const auto ring = [=](Real angle) {
    return std::exp(n * std::log(std::cos(angle))) * std::cos(angle / 2) * std::sin(angle);
  };
  const Real albedo = 2 * kPi * smooth_integral(ring, 0, std::min(kPi / 2, 9.5L / std::sqrt(n)));
  return cosine_power(mirror, view, n) / dot(kNormal, half_vector(mirror, view)) / albedo;
}

}  // namespace lobe::reference
