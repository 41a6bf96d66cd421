#include <cmath>

#include "reference/fresnel.hpp"
#include "reference/microfacets.hpp"
#include "reference/models.hpp"

namespace lobe::reference {
namespace {

/// Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2 of Walter et al. 2007, eq. 34, where G1 = 1/(1 + Lambda).
Real lambda(const Vector& direction, Real alpha) {
  const Real tan_squared = (direction.x * direction.x + direction.y * direction.y) / (direction.z * direction.z);
  return (std::sqrt(1 + alpha * alpha * tan_squared) - 1) / 2;
}

Real without_fresnel(const Vector& light, const Vector& view, Real alpha) {
  const Real attenuation = 1 / (1 + lambda(light, alpha) + lambda(view, alpha));
  return trowbridge_facets(half_vector(light, view), alpha) * attenuation / (4 * light.z * view.z);
}

}  // namespace

Real ggx(const Vector& light, const Vector& view, Real alpha, Real f0) {
  return schlick_fresnel(cos_half_difference(light, view), f0) * without_fresnel(light, view, alpha);
}

Real ggx_fresnel(const Vector& light, const Vector& view, Real alpha, Real n, Real k) {
  return fresnel(cos_half_difference(light, view), n, k) * without_fresnel(light, view, alpha);
}

}  // namespace lobe::reference
