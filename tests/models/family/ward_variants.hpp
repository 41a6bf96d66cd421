#pragma once

#include "models/model_test.hpp"

namespace lobe::test {

inline ModelCase ward_case(const std::string& model, Real (*f)(const Vector&, const Vector&, Real),
                           const std::string& m) {
  const Real roughness = std::stold(m);
  return {model + ":m=" + m, [=](const Vector& l, const Vector& v) { return f(l, v, roughness); },
          // 1 + tan^2 delta / m^2
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) / (roughness * roughness);
          },
          static_cast<double>(2 * roughness)};
}

}  // namespace lobe::test
