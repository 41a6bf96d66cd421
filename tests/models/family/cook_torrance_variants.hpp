#pragma once

#include <algorithm>
#include <cmath>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {

inline ModelCase blinn(const std::string& n, const std::string& f0) {
  const Real exponent = std::stold(n);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance_blinn:n=" + n + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance_blinn(l, v, exponent, at_normal); },
          // 1 + n |ln N.H|
          [=](const Vector& l, const Vector& v) {
            return 1 + exponent * std::log1p(tan_squared_delta(half_vector(l, v))) / 2 +
                   schlick_condition(at_normal, l, v);
          },
          static_cast<double>(1 / std::sqrt(exponent))};
}

inline ModelCase fresnel(const std::string& m, const std::string& n, const std::string& k) {
  const Real roughness = std::stold(m);
  const Real index = std::stold(n);
  const Real extinction = std::stold(k);
  return {"cook_torrance_fresnel:m=" + m + ",ior=" + n + ",k=" + k,
          [=](const Vector& l, const Vector& v) {
            return reference::cook_torrance_fresnel(l, v, roughness, index, extinction);
          },
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) / (roughness * roughness) +
                   fresnel_condition([=](Real c) { return reference::fresnel(c, index, extinction); }, l, v);
          },
          static_cast<double>(2 * roughness)};
}

/// Of the angle from the normal; the kernel has it from the cosine.
inline Real sine(const Vector& x) {
  return std::max(std::hypot(x.x, x.y), 1e-12L);
}

inline ModelCase smith(const std::string& m, const std::string& f0) {
  const Real roughness = std::stold(m);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance_smith:m=" + m + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance_smith(l, v, roughness, at_normal); },
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) / (roughness * roughness) +
                   schlick_condition(at_normal, l, v) + roughness / sine(l) + roughness / sine(v);
          },
          static_cast<double>(2 * roughness)};
}

inline ModelCase torrance(const std::string& m, const std::string& f0) {
  const Real width = std::stold(m);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance_torrance:m=" + m + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance_torrance(l, v, width, at_normal); },
          // 1 + delta^2 / m^2
          [=](const Vector& l, const Vector& v) {
            const Real delta = std::atan(std::sqrt(tan_squared_delta(half_vector(l, v))));
            return 1 + delta * delta / (width * width) + schlick_condition(at_normal, l, v);
          },
          static_cast<double>(2 * width)};
}

inline ModelCase trowbridge(const std::string& q, const std::string& f0) {
  const Real width = std::stold(q);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance_trowbridge:q=" + q + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance_trowbridge(l, v, width, at_normal); },
          [=](const Vector& l, const Vector& v) { return 1 + schlick_condition(at_normal, l, v); },
          static_cast<double>(2 * width)};
}

/// A case with f0 = 1, where F = 1, times Fresnel's equations.
inline ModelCase with_fresnel(ModelCase plain, const std::string& n, const std::string& k) {
  const Real index = std::stold(n);
  const Real extinction = std::stold(k);
  const auto reflectance = [=](Real cosine) { return reference::fresnel(cosine, index, extinction); };
  plain.name.insert(plain.name.find(':'), "_fresnel");
  plain.name.replace(plain.name.find(",f0=1"), 5, ",ior=" + n + ",k=" + k);
  plain.f = [=, f = plain.f](const Vector& l, const Vector& v) { return f(l, v) * reflectance(length(l + v) / 2); };
  plain.condition = [=, condition = plain.condition](const Vector& l, const Vector& v) {
    return condition(l, v) + fresnel_condition(reflectance, l, v);
  };
  return plain;
}

}  // namespace lobe::test
