#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/model_kernel.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

using reference::kPi;

ModelCase li_sparse(const std::string& height, const std::string& shape) {
  const Real h_b = std::stold(height);
  const Real b_r = std::stold(shape);
  return {"li_sparse:h_b=" + height + ",b_r=" + shape,
          [=](const Vector& l, const Vector& v) { return reference::li_sparse(l, v, h_b, b_r); },
          // The magnitudes of the terms, and what an ulp of the cosines does to the angle t.
          [=](const Vector& l, const Vector& v) {
            const Real product = l.z * v.z;
            const auto stretched = [&](const Vector& x) { return std::hypot(x.z, b_r * x.x, b_r * x.y); };
            const Real secants = (stretched(l) / l.z + stretched(v) / v.z);
            const Real apart =
                std::hypot(l.x / l.z - v.x / v.z, l.y / l.z - v.y / v.z, b_r * (l.x * v.y - l.y * v.x) / product) *
                product;
            const Real spread = std::abs(l.z - v.z) * (l.z + v.z) + product + b_r * b_r;
            const Real terms = 1 + secants + (b_r * b_r + h_b * b_r * spread / std::max(apart, 1e-9L)) / product;
            return terms / std::abs(kPi * reference::li_sparse(l, v, h_b, b_r));
          },
          0.3};
}

INSTANTIATE_TEST_SUITE_P(ross_thick, ModelKernel,
                         ::testing::Values(ModelCase{"ross_thick", reference::ross_thick,
                                                     [](const Vector& l, const Vector& v) -> Real {
                                                       return 1 + 1 / std::abs(kPi * reference::ross_thick(l, v));
                                                     }}),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(li_sparse, ModelKernel,
                         ::testing::Values(li_sparse("2", "1"), li_sparse("1", "0.4"), li_sparse("2", "1.8")),
                         ByName{});

TEST(RossLi, VanishesWithSunAndViewerAtTheZenith) {
  const std::vector<Directions> zenith{{0, 0, 0}};

  EXPECT_NEAR(evaluate(device(), parse_material("ross_thick"), zenith)(0, 0), 0, 1e-15);
  EXPECT_NEAR(evaluate(device(), parse_material("li_sparse"), zenith)(0, 0), 0, 1e-15);
}

}  // namespace
}  // namespace lobe::test
