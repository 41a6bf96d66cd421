#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/model_kernel.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

ModelCase oren_nayar(const std::string& sigma, const std::string& a_denominator) {
  const Real slope = std::stold(sigma);
  const Real denominator = std::stold(a_denominator);
  return {"oren_nayar:sigma=" + sigma + ",a_denominator=" + a_denominator,
          [=](const Vector& l, const Vector& v) { return reference::oren_nayar(l, v, slope, denominator); },
          // 1 + 1/max(N.L, N.V): the difference L.V - N.L N.V has an absolute error of an ulp
          [=](const Vector& l, const Vector& v) { return 1 + 1 / std::max(l.z, v.z); }, 1};
}

INSTANTIATE_TEST_SUITE_P(oren_nayar, ModelKernel,
                         ::testing::Values(oren_nayar("0", "0.33"), oren_nayar("0.2", "0.33"),
                                           oren_nayar("0.5", "0.33"), oren_nayar("0.5", "0.5"),
                                           oren_nayar("1.5", "0.33")),
                         ByName{});

ModelCase oren_nayar_full(const std::string& sigma, const std::string& rho) {
  const Real slope = std::stold(sigma);
  const Real reflectance = std::stold(rho);
  return {"oren_nayar_full:sigma=" + sigma + ",rho=" + rho,
          [=](const Vector& l, const Vector& v) { return reference::oren_nayar_full(l, v, slope, reflectance, 0.33L); },
          // Tangents of an angle whose cosine is off by an ulp, in terms that may all but cancel: (1 + tan) (1 + rho/f)
          [=](const Vector& l, const Vector& v) {
            const Real f = reference::oren_nayar_full(l, v, slope, reflectance, 0.33L);
            return (1 + 1 / std::max(l.z, v.z)) * (1 + reflectance / f);
          },
          1};
}

INSTANTIATE_TEST_SUITE_P(oren_nayar_full, ModelKernel,
                         ::testing::Values(oren_nayar_full("0", "1"), oren_nayar_full("0.3", "0.9"),
                                           oren_nayar_full("0.5", "0.1"), oren_nayar_full("1.5", "1")),
                         ByName{});

TEST(OrenNayarFull, IsNotNegativeWhereTheSumOfItsTermsIs) {
  const std::vector<Directions> grazing_mirror{{1.569, 1.569, std::acos(-1.0)}};

  EXPECT_EQ(evaluate(device(), parse_material("oren_nayar_full:sigma=1.5,rho=0.01"), grazing_mirror)(0, 0), 0);
}

}  // namespace
}  // namespace lobe::test
