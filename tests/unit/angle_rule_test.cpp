#include "hemisphere/angle_rule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace lobe::test {
namespace {

using std::numbers::pi;

double integral(const AngleRule& rule, int nodes, const std::function<double(double cos_i, double cos_o)>& g) {
  NodeBlock block(512);
  double sum = 0;
  for (std::size_t slab = 0; slab < rule.slabs(); ++slab) {
    rule.place(slab, nodes, block, [&] {
      const auto at = [&](NodeBlock::Row row, std::size_t k) { return block.data()[row * block.capacity() + k]; };
      for (std::size_t k = 0; k < block.size(); ++k)
        sum += at(NodeBlock::factor, k) * g(at(NodeBlock::cos_i, k), at(NodeBlock::cos_o, k));
      block.clear();
    });
  }
  return sum;
}

TEST(AngleRule, MeasuresTheAnglesUpToTheLargest) {
  const AngleRule rule({0.05, {}, 1, {}}, 1.3);
  EXPECT_NEAR(integral(rule, 4, [](double, double) { return 1.0; }), 2 * pi * 1.3 * 1.3, 1e-12);
}

TEST(AngleRule, MeasuresTheWholeHemisphereWithPatches) {
  const AngleRule rule({0.3, {0.5}, 0.2, {0.4}}, pi / 2);
  EXPECT_NEAR(integral(rule, 4, [](double, double) { return 1.0; }), pi * pi * pi / 2, 1e-12);
}

TEST(AngleRule, IntegratesCosinesOfBothDirections) {
  const AngleRule rule({0.01, {}, 1, {}}, 1.2);
  // sin(1.2) and the integral of cos^2.
  const double expected = 2 * pi * std::sin(1.2) * (0.6 + std::sin(2.4) / 4);
  EXPECT_NEAR(integral(rule, 12, [](double c, double d) { return c * d * d; }), expected, 1e-12 * expected);
}

TEST(AngleRule, PlacesNoNodeBeyondTheLargestAngle) {
  const AngleRule rule({0.01, {}, 1, {}}, 1.2);
  double lowest = 1;
  (void)integral(rule, 3, [&](double c, double d) {
    lowest = std::min({lowest, c, d});
    return 0.0;
  });
  EXPECT_GT(lowest, std::cos(1.2));
}

}  // namespace
}  // namespace lobe::test
