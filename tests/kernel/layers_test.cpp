#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

ModelCase lacquer(const std::string& text) {
  const Real s = std::stold(text);
  return {"lacquer:s=" + text, [=](const Vector& l, const Vector& v) { return reference::lacquer(l, v, s); },
          // 1 + s (1/N.L + 1/N.V)
          [=](const Vector& l, const Vector& v) { return 1 + s * (1 / l.z + 1 / v.z); }, 1};
}

ModelCase sandwich(const std::string& k, const std::string& n) {
  const Real ratio = std::stold(k);
  const Real order = std::stold(n);
  return {"sandwich:k=" + k + ",n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::sandwich(l, v, ratio, order); },
          // 1 + n (1 + |ln(...)|)
          [=](const Vector& l, const Vector& v) { return 1 + order * (1 + std::log(2 + ratio * (1 / l.z + 1 / v.z))); },
          1};
}

INSTANTIATE_TEST_SUITE_P(lacquer, ModelKernel, ::testing::Values(lacquer("0"), lacquer("0.1"), lacquer("2")), ByName{});
INSTANTIATE_TEST_SUITE_P(sandwich, ModelKernel,
                         ::testing::Values(sandwich("0.1", "1"), sandwich("1", "1"), sandwich("30", "3")), ByName{});

}  // namespace
}  // namespace lobe::test
