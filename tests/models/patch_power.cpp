#include <algorithm>
#include <cmath>

#include "models/family/patches.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase patch_power(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"patch_power:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::patch_power(l, v, exponent); },
          // 1 + n / (1 - |V_P - L'_P|)
          [=](const Vector& l, const Vector& v) { return 1 + exponent / std::max(1 - distance(l, v), 1e-10L); },
          static_cast<double>(1 / (1 + exponent)),
          [=](Real eps) { return (exponent + 1) * (exponent + 2) * std::pow(8 * eps, exponent); }};
}

}  // namespace

ModelTest patch_power_test() {
  return {.budget = {8, 1.6, 4, 0.89}, .cases = {patch_power("1"), patch_power("20"), patch_power("5000")}};
}

}  // namespace lobe::test
