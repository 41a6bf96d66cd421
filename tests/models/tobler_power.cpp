#include <algorithm>
#include <cmath>

#include "models/family/tobler.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

using reference::kPi;

ModelCase power(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"tobler_power:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::tobler_power(l, v, exponent); },
          // 1 + n (1 - R_S.V_S) / R_S.V_S, with the last ulp of what the power is taken of
          [=](const Vector& l, const Vector& v) {
            const Real cosine = reference::tobler_power(l, v, 1) * kPi / 4;
            return 1 + exponent * (spread(l, v) + 0.5L) / std::max(cosine, 1e-10L);
          },
          static_cast<double>(0.5L / std::sqrt(exponent)),
          [=](Real eps) { return (exponent + 2) * std::pow(16 * eps, exponent); }};
}

}  // namespace

ModelTest tobler_power_test() {
  return {.budget = {4, 1.1, 4, 1.2}, .cases = {power("0.3"), power("1.5"), power("4"), power("20"), power("5000")}};
}

}  // namespace lobe::test
