#include <algorithm>
#include <cmath>

#include "reference/fresnel.hpp"
#include "reference/microfacets.hpp"
#include "reference/models.hpp"

namespace lobe::reference {
namespace {

/// Walter et al. 2007, eq. 34.
Real smith(const Vector& direction, Real alpha) {
  const Real tangent = std::hypot(direction.x, direction.y) / direction.z;
  return 2 / (1 + std::sqrt(1 + alpha * alpha * tangent * tangent));
}

}  // namespace

Real disney_diffuse(const Vector& light, const Vector& view, Real rough) {
  const Real l_h = dot(light, half_vector(light, view));
  const Real grazing = 0.5L + 2 * rough * l_h * l_h;  // F_D90
  return (1 + (grazing - 1) * std::pow(1 - light.z, 5.0L)) * (1 + (grazing - 1) * std::pow(1 - view.z, 5.0L)) / kPi;
}

// Section 5.4: gamma = 2, masking of Walter et al. 2007, eq. 34, for the remapped roughness.
Real disney_specular(const Vector& light, const Vector& view, Real rough, Real f0) {
  const Real facets = std::max(0.001L, rough * rough);
  const Real masking = (0.5L + rough / 2) * (0.5L + rough / 2);
  return trowbridge_facets(half_vector(light, view), facets) * schlick_fresnel(cos_half_difference(light, view), f0) *
         smith(light, masking) * smith(view, masking) / (4 * light.z * view.z);
}

// Section 5.4: gamma = 1, c / (sin^2 + a^2 cos^2) with the integral of D cos over half-vectors 1; a quarter of its
// strength is in the text.
Real disney_clearcoat(const Vector& light, const Vector& view, Real gloss) {
  const Real facets = 0.1L - 0.099L * gloss;
  const Vector half = half_vector(light, view);
  const Real ellipse = half.x * half.x + half.y * half.y + facets * facets * half.z * half.z;
  const Real distribution = (1 - facets * facets) / (-2 * kPi * std::log(facets)) / ellipse;
  return distribution * schlick_fresnel(cos_half_difference(light, view), 0.04L) * smith(light, 0.25L) *
         smith(view, 0.25L) / (4 * light.z * view.z) / 4;
}

}  // namespace lobe::reference
