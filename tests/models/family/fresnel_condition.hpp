#pragma once

#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"
#include "reference/fresnel.hpp"

namespace lobe::test {

/// How far an ulp of the cosine of incidence moves a Fresnel factor, in ulps, and what the difference of nearly equal
/// numbers adds near F = 0: (1 + |F'|) / F.
inline Real condition_at(const std::function<Real(Real cosine)>& f, Real cosine) {
  constexpr Real kStep = 1e-6L;
  const Real slope = (f(std::min(1.0L, cosine + kStep)) - f(std::max(0.0L, cosine - kStep))) / kStep;
  return (1 + std::abs(slope)) / f(cosine);
}

inline Real fresnel_condition(const std::function<Real(Real cosine)>& f, const Vector& light, const Vector& view) {
  return condition_at(f, length(light + view) / 2);
}

inline Real schlick_condition(Real f0, const Vector& light, const Vector& view) {
  return fresnel_condition([=](Real cosine) { return reference::schlick_fresnel(cosine, f0); }, light, view);
}

}  // namespace lobe::test
