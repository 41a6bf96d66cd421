#pragma once

#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {

/// 1 + n (|c_xy| + |c_z|) / base: the base of the power is a sum with an absolute error of an ulp
inline auto cosine_condition(Real c_xy, Real c_z, Real n) {
  return [=](const Vector& l, const Vector& v) {
    const Real base = c_xy * (l.x * v.x + l.y * v.y) + c_z * l.z * v.z;
    return 1 + n * (std::abs(c_xy) + std::abs(c_z)) / std::max(base, 1e-10L);
  };
}

template <typename Function>
ModelCase lafortune_case(const std::string& model, Function f, const std::string& c_xy, const std::string& c_z,
                         const std::string& n) {
  const Real xy = std::stold(c_xy);
  const Real z = std::stold(c_z);
  const Real exponent = std::stold(n);
  return {model + ":c_xy=" + c_xy + ",c_z=" + c_z + ",n=" + n,
          [=](const Vector& l, const Vector& v) { return f(l, v, xy, z, exponent); }, cosine_condition(xy, z, exponent),
          static_cast<double>(1 / std::sqrt(exponent)),
          [=](Real eps) { return (exponent + 2) * std::pow(8 * eps, exponent); }};
}

}  // namespace lobe::test
