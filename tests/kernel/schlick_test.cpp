#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

ModelCase schlick(const std::string& text) {
  const Real r = std::stold(text);
  return {"schlick:r=" + text, [=](const Vector& l, const Vector& v) { return reference::schlick(l, v, r); },
          [](const Vector&, const Vector&) -> Real { return 1; }, static_cast<double>(2 * std::sqrt(r))};
}

INSTANTIATE_TEST_SUITE_P(schlick, ModelKernel,
                         ::testing::Values(schlick("0.0001"), schlick("0.01"), schlick("0.2"), schlick("1")), ByName{});

}  // namespace
}  // namespace lobe::test
