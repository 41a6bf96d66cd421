#include <algorithm>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase disney_specular(const std::string& text, const std::string& f0) {
  const Real rough = std::stold(text);
  const Real at_normal = std::stold(f0);
  return {"disney_specular:rough=" + text + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::disney_specular(l, v, rough, at_normal); },
          // An ulp of angles near the horizon turns H by ulp / (N.L + N.V).
          [=](const Vector& l, const Vector& v) {
            const Real a = std::max(0.001L, rough * rough);
            const Real tan_squared = tan_squared_delta(half_vector(l, v));
            return 1 + schlick_condition(at_normal, l, v) + tan_squared / (a * a + tan_squared) / (l.z + v.z);
          },
          static_cast<double>(std::max(0.001L, rough * rough))};
}

}  // namespace

ModelTest disney_specular_test() {
  return {.budget = {16, 3.6, 8, 1.5},
          .cases = {disney_specular("0", "1"), disney_specular("0.3", "0.04"), disney_specular("1", "0.5")}};
}

}  // namespace lobe::test
