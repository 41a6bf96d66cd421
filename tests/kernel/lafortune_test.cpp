#include <algorithm>
#include <cmath>

#include "kernel/model_kernel.hpp"

namespace lobe::test {
namespace {

/// 1 + n (|c_xy| + |c_z|) / base: the base of the power is a sum with an absolute error of an ulp
auto condition(Real c_xy, Real c_z, Real n) {
  return [=](const Vector& l, const Vector& v) {
    const Real base = c_xy * (l.x * v.x + l.y * v.y) + c_z * l.z * v.z;
    return 1 + n * (std::abs(c_xy) + std::abs(c_z)) / std::max(base, 1e-10L);
  };
}

template <typename Function>
ModelCase make_case(const std::string& model, Function f, const std::string& c_xy, const std::string& c_z,
                    const std::string& n) {
  const Real xy = std::stold(c_xy);
  const Real z = std::stold(c_z);
  const Real exponent = std::stold(n);
  return {model + ":c_xy=" + c_xy + ",c_z=" + c_z + ",n=" + n,
          [=](const Vector& l, const Vector& v) { return f(l, v, xy, z, exponent); }, condition(xy, z, exponent),
          static_cast<double>(1 / std::sqrt(exponent)),
          [=](Real eps) { return (exponent + 2) * std::pow(8 * eps, exponent); }};
}

ModelCase lafortune(const std::string& c_xy, const std::string& c_z, const std::string& n) {
  return make_case("lafortune", reference::lafortune, c_xy, c_z, n);
}

ModelCase lafortune_ngan(const std::string& c_xy, const std::string& c_z, const std::string& n) {
  return make_case("lafortune_ngan", reference::lafortune_ngan, c_xy, c_z, n);
}

INSTANTIATE_TEST_SUITE_P(lafortune, ModelKernel,
                         ::testing::Values(lafortune("-1", "1", "20"), lafortune("-1", "0.8", "10"),
                                           lafortune("-1", "1.1", "10"), lafortune("1", "0.5", "3"),
                                           lafortune("-1", "1", "2000")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(lafortune_ngan, ModelKernel,
                         ::testing::Values(lafortune_ngan("-0.98", "0.95", "50"), lafortune_ngan("-1.02", "0.9", "5"),
                                           lafortune_ngan("-0.57", "0.56", "800"), lafortune_ngan("-1", "1", "100000")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
