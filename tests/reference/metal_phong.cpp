#include <algorithm>

#include "reference/fresnel.hpp"
#include "reference/models.hpp"

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

}  // namespace lobe::reference
