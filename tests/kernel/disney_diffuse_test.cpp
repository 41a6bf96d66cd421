#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

ModelCase disney_diffuse(const std::string& text) {
  const Real rough = std::stold(text);
  return {"disney_diffuse:rough=" + text,
          [=](const Vector& l, const Vector& v) { return reference::disney_diffuse(l, v, rough); },
          [](const Vector&, const Vector&) -> Real { return 1; }};
}

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

INSTANTIATE_TEST_SUITE_P(disney_diffuse, ModelKernel,
                         ::testing::Values(disney_diffuse("0"), disney_diffuse("0.5"), disney_diffuse("1")), ByName{});

INSTANTIATE_TEST_SUITE_P(disney_specular, ModelKernel,
                         ::testing::Values(disney_specular("0", "1"), disney_specular("0.3", "0.04"),
                                           disney_specular("1", "0.5")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(disney_clearcoat, ModelKernel,
                         ::testing::Values(disney_clearcoat("0"), disney_clearcoat("0.9"), disney_clearcoat("1")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
