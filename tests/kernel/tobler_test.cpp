#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

using reference::kPi;

/// 1 - R_S.V_S and the difference of the cosines, of which an ulp is what the kernel has.
Real spread(const Vector& l, const Vector& v) {
  const Real product = l.z * v.z;
  const Real difference = l.z - v.z;
  const Real m2 = (l.x + v.x) * (l.x + v.x) + (l.y + v.y) * (l.y + v.y);
  return 2 * (difference * difference * (1 + product) + product * m2) + std::abs(difference);
}

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

ModelCase exponential(const std::string& text) {
  const Real s = std::stold(text);
  return {"tobler_exponential:s=" + text,
          [=](const Vector& l, const Vector& v) { return reference::tobler_exponential(l, v, s); },
          [=](const Vector& l, const Vector& v) { return 1 + s * spread(l, v); },
          static_cast<double>(0.5L / std::sqrt(s))};
}

INSTANTIATE_TEST_SUITE_P(tobler_power, ModelKernel,
                         ::testing::Values(power("0.3"), power("1.5"), power("4"), power("20"), power("5000")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(tobler_exponential, ModelKernel,
                         ::testing::Values(exponential("0.01"), exponential("4"), exponential("5000")), ByName{});

}  // namespace
}  // namespace lobe::test
