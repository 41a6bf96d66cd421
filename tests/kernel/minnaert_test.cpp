#include <cmath>
#include <vector>

#include "kernel/model_kernel.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

ModelCase minnaert(const std::string& k) {
  const Real exponent = std::stold(k);
  return {"minnaert:k=" + k, [=](const Vector& l, const Vector& v) { return reference::minnaert(l, v, exponent); },
          // 1 + k (1 + |ln N.L| + |ln N.V|): the cosines have an error of an ulp, their logarithms too
          [=](const Vector& l, const Vector& v) {
            return 1 + exponent * (1 + std::abs(std::log(l.z)) + std::abs(std::log(v.z)));
          },
          1};
}

INSTANTIATE_TEST_SUITE_P(minnaert, ModelKernel,
                         ::testing::Values(minnaert("0"), minnaert("0.5"), minnaert("1"), minnaert("2"), minnaert("10"),
                                           minnaert("100")),
                         ByName{});

TEST(Minnaert, WithoutExponentIsLambertExactly) {
  const std::vector<Directions> directions{{0, 0, 0}, {0.5, 1.2, 2}, {1.57, 1.57, 3}};

  EXPECT_EQ(evaluate(device(), parse_material("minnaert:k=0"), directions),
            evaluate(device(), parse_material("lambert"), directions));
}

}  // namespace
}  // namespace lobe::test
