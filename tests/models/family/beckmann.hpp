#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "models/family/cook_torrance_variants.hpp"
#include "models/model_test.hpp"
#include "reference/microfacets.hpp"

namespace lobe::test {

/// Smith's Lambda, with erfc for erf - 1 (Walter et al. 2007, eq. 26).
inline Real smith_lambda(const Vector& direction, Real m) {
  const Real tangent = std::hypot(direction.x, direction.y) / direction.z;
  if (tangent == 0) return 0;
  const Real a = 1 / (m * tangent);
  return (std::exp(-a * a) / (a * std::sqrt(std::numbers::pi_v<Real>)) - std::erfc(a)) / 2;
}

inline Real correlated_attenuation(const Vector& l, const Vector& v, Real m) {
  return 1 / (1 + smith_lambda(l, m) + smith_lambda(v, m));
}

inline Real separable_attenuation(const Vector& l, const Vector& v, Real m) {
  return 1 / ((1 + smith_lambda(l, m)) * (1 + smith_lambda(v, m)));
}

/// A case of facets with any attenuation G and any Fresnel term.
template <typename Attenuation, typename Fresnel>
ModelCase beckmann_case(const std::string& name, Real m, Attenuation attenuation, Fresnel reflectance) {
  return {name,
          [=](const Vector& l, const Vector& v) {
            return reference::beckmann_facets(reference::half_vector(l, v), m) *
                   reflectance(reference::cos_half_difference(l, v)) * attenuation(l, v, m) / (4 * l.z * v.z);
          },
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) / (m * m) + fresnel_condition(reflectance, l, v) +
                   m / sine(l) + m / sine(v);
          },
          static_cast<double>(2 * m)};
}

}  // namespace lobe::test
