#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase disney_clearcoat(const std::string& text) {
  const Real gloss = std::stold(text);
  return {"disney_clearcoat:gloss=" + text,
          [=](const Vector& l, const Vector& v) { return reference::disney_clearcoat(l, v, gloss); },
          [=](const Vector& l, const Vector& v) {
            const Real a = 0.1L - 0.099L * gloss;
            const Real tan_squared = tan_squared_delta(half_vector(l, v));
            return 1 + schlick_condition(0.04L, l, v) + tan_squared / (a * a + tan_squared) / (l.z + v.z);
          },
          static_cast<double>(0.1L - 0.099L * gloss)};
}

}  // namespace

ModelTest disney_clearcoat_test() {
  return {.budget = {4, 0.84, 1, 0.27},
          .cases = {disney_clearcoat("0"), disney_clearcoat("0.9"), disney_clearcoat("1")}};
}

}  // namespace lobe::test
