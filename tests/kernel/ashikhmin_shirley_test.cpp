#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

ModelCase specular(const std::string& n, const std::string& f0) {
  const Real exponent = std::stold(n);
  const Real at_normal = std::stold(f0);
  return {"ashikhmin_shirley:n=" + n + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::ashikhmin_shirley(l, v, exponent, at_normal); },
          // 1 + n |ln N.H|
          [=](const Vector& l, const Vector& v) {
            return 1 + exponent * std::log1p(tan_squared_delta(half_vector(l, v))) / 2 +
                   schlick_condition(at_normal, l, v);
          },
          static_cast<double>(1 / std::sqrt(exponent))};
}

ModelCase diffuse(const std::string& f0) {
  const Real at_normal = std::stold(f0);
  return {"ashikhmin_shirley_diffuse:f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::ashikhmin_shirley_diffuse(l, v, at_normal); },
          [](const Vector&, const Vector&) -> Real { return 1; }};
}

INSTANTIATE_TEST_SUITE_P(ashikhmin_shirley, ModelKernel,
                         ::testing::Values(specular("1", "1"), specular("20", "0.04"), specular("5000", "1")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(ashikhmin_shirley_diffuse, ModelKernel, ::testing::Values(diffuse("0"), diffuse("0.05")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
