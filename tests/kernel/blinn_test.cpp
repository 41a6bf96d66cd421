#include <cmath>

#include "kernel/model_kernel.hpp"

namespace lobe::test {
namespace {

/// 1 + n |ln N.H|
auto condition(Real n) {
  return [=](const Vector& l, const Vector& v) { return 1 + n / 2 * std::log1p(tan_squared_delta(half_vector(l, v))); };
}

ModelCase blinn(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"blinn:n=" + n, [=](const Vector& l, const Vector& v) { return reference::blinn(l, v, exponent); },
          condition(exponent), static_cast<double>(2 / std::sqrt(exponent))};
}

ModelCase blinn_phong(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"blinn_phong:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::blinn_phong(l, v, exponent); }, condition(exponent),
          static_cast<double>(2 / std::sqrt(exponent))};
}

INSTANTIATE_TEST_SUITE_P(blinn, ModelKernel,
                         ::testing::Values(blinn("1"), blinn("8"), blinn("20"), blinn("128"), blinn("512"),
                                           blinn("100000")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(blinn_phong, ModelKernel,
                         ::testing::Values(blinn_phong("1"), blinn_phong("20"), blinn_phong("1200"),
                                           blinn_phong("100000")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
