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

INSTANTIATE_TEST_SUITE_P(disney_diffuse, ModelKernel,
                         ::testing::Values(disney_diffuse("0"), disney_diffuse("0.5"), disney_diffuse("1")), ByName{});

}  // namespace
}  // namespace lobe::test
