#pragma once

#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {

using Hapke = Real (*)(const Vector& light, const Vector& view, Real g);

inline ModelCase hapke(const std::string& model, Hapke f, const std::string& text) {
  const Real g = std::stold(text);
  return {model + ":g=" + text, [=](const Vector& l, const Vector& v) { return f(l, v, g); },
          [=](const Vector& l, const Vector& v) {
            return 1 + (1 + 1 / g) / std::max(2 * std::atan2(length(l - v), length(l + v)), 1e-12L);
          },
          1};
}

}  // namespace lobe::test
