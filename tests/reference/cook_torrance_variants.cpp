#include <cmath>

#include "reference/fresnel.hpp"
#include "reference/microfacets.hpp"
#include "reference/models.hpp"

namespace lobe::reference {
namespace {

/// Neumann 2001, eq. 1.38, with h = cot^2 / m^2.
Real gaussian_surface_masking(Real cosine, Real m) {
  const Real h = cosine * cosine / (m * m * (1 - cosine * cosine));
  const Real g = std::sqrt(kPi * h) * (2 - std::erfc(std::sqrt(h)));
  return std::isinf(h) ? 1 : g / (g + 1);
}

}  // namespace

Real cook_torrance_blinn(const Vector& light, const Vector& view, Real n, Real f0) {
  return schlick_fresnel(cos_half_difference(light, view), f0) *
         with_v_cavities(light, view, blinn_facets(half_vector(light, view), n));
}

Real cook_torrance_fresnel(const Vector& light, const Vector& view, Real m, Real n, Real k) {
  return fresnel(cos_half_difference(light, view), n, k) *
         with_v_cavities(light, view, beckmann_facets(half_vector(light, view), m));
}

Real cook_torrance_smith(const Vector& light, const Vector& view, Real m, Real f0) {
  const Real masking = gaussian_surface_masking(light.z, m) * gaussian_surface_masking(view.z, m);
  return schlick_fresnel(cos_half_difference(light, view), f0) * beckmann_facets(half_vector(light, view), m) *
         masking / (4 * light.z * view.z);
}

Real cook_torrance_torrance(const Vector& light, const Vector& view, Real m, Real f0) {
  return schlick_fresnel(cos_half_difference(light, view), f0) *
         with_v_cavities(light, view, torrance_facets(half_vector(light, view), m));
}

Real cook_torrance_trowbridge(const Vector& light, const Vector& view, Real q, Real f0) {
  return schlick_fresnel(cos_half_difference(light, view), f0) *
         with_v_cavities(light, view, trowbridge_facets(half_vector(light, view), q));
}

}  // namespace lobe::reference
