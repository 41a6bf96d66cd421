#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

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

using Hapke = Real (*)(const Vector& light, const Vector& view, Real g);

ModelCase hapke(const std::string& model, Hapke f, const std::string& text) {
  const Real g = std::stold(text);
  return {model + ":g=" + text, [=](const Vector& l, const Vector& v) { return f(l, v, g); },
          [=](const Vector& l, const Vector& v) {
            return 1 + (1 + 1 / g) / std::max(2 * std::atan2(length(l - v), length(l + v)), 1e-12L);
          },
          1};
}

INSTANTIATE_TEST_SUITE_P(lommel_seeliger, ModelKernel,
                         ::testing::Values(ModelCase{"lommel_seeliger", reference::lommel_seeliger,
                                                     [](const Vector&, const Vector&) -> Real { return 1; }}),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(hapke_lommel_seeliger, ModelKernel,
                         ::testing::Values(hapke_lommel_seeliger("0.05"), hapke_lommel_seeliger("0.4"),
                                           hapke_lommel_seeliger("5")),
                         ByName{});

INSTANTIATE_TEST_SUITE_P(hapke_forward, ModelKernel,
                         ::testing::Values(hapke("hapke_forward", reference::hapke_forward, "0.05"),
                                           hapke("hapke_forward", reference::hapke_forward, "5")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(hapke_isotropic, ModelKernel,
                         ::testing::Values(hapke("hapke_isotropic", reference::hapke_isotropic, "0.05"),
                                           hapke("hapke_isotropic", reference::hapke_isotropic, "5")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
