#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

using reference::kPi;

ModelCase hapke_lommel_seeliger(const std::string& text) {
  const Real g = std::stold(text);
  return {"hapke_lommel_seeliger:g=" + text,
          [=](const Vector& l, const Vector& v) { return reference::hapke_lommel_seeliger(l, v, g); },
          // An ulp of L.H moves the angle alpha between L and V by ulp/alpha, the peak by 3/(2 g) of that; S, the
          // difference of two numbers like pi - alpha, is its cube.
          [=](const Vector& l, const Vector& v) {
            const Real alpha = 2 * std::atan2(length(l - v), length(l + v));
            return 1 + (1 + 1 / g) / std::max(alpha, 1e-12L) + 1 / std::pow(std::max(kPi - alpha, 0.125L), 2.0L);
          },
          1};
}

}  // namespace

ModelTest hapke_lommel_seeliger_test() {
  return {.budget = {16, 3, 8, 2.7},
          .cases = {hapke_lommel_seeliger("0.05"), hapke_lommel_seeliger("0.4"), hapke_lommel_seeliger("5")},
          .excess = AlbedoExcess{"hapke_lommel_seeliger:g=10", 89.99, 1.2}};
}

}  // namespace lobe::test
