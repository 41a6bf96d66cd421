#include "device/cosine_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace lobe::test {
namespace {

using Values = std::vector<double>;

Values apply(const CosinePlan::Direction& direction, std::size_t outputs, const Values& inputs) {
  Values result(outputs + CosinePlan::kStrip);
  for (const auto& strip : direction.strips) {
    for (std::size_t r = 0; r < CosinePlan::kStrip; ++r) {
      double sum = 0;
      for (std::size_t i = 0; i < strip.inputs; ++i) {
        sum += direction.coefficients[strip.entry + i * CosinePlan::kStrip + r] * inputs[strip.input + i];
      }
      result[strip.output + r] = sum;
    }
  }
  result.resize(outputs);
  return result;
}

/// What fold() and apply_strip() of the kernels make of the azimuths: orders in the plan's sequence.
Values transform(const CosinePlan& plan, Values f) {
  std::size_t length = plan.points - 1;
  for (std::size_t level = 0; level < plan.levels; ++level, length /= 2) {
    for (std::size_t k = 0; 2 * k <= length; ++k) {
      const double head = f[k];
      const double tail = f[length - k];
      f[length - k] = head - tail;
      f[k] = head + tail;
    }
  }
  return apply(plan.forward, plan.points, f);
}

/// And back: apply_strip() and unfold().
Values restore(const CosinePlan& plan, const Values& orders) {
  Values f = apply(plan.inverse, plan.points, orders);
  for (std::size_t level = plan.levels; level-- > 0;) {
    const std::size_t length = (plan.points - 1) >> level;
    for (std::size_t k = 0; 2 * k < length; ++k) {
      const double even = f[k];
      const double odd = f[length - k];
      f[k] = even + odd;
      f[length - k] = even - odd;
    }
  }
  return f;
}

Values ramp(std::size_t points) {
  Values f(points);
  for (std::size_t k = 0; k < points; ++k) f[k] = 1 + std::exp(-0.3 * static_cast<double>(k));
  return f;
}

class CosinePlans : public ::testing::TestWithParam<std::size_t> {};

TEST_P(CosinePlans, HaveEachOrderOnce) {
  auto orders = make_cosine_plan(GetParam()).orders;

  std::sort(orders.begin(), orders.end());

  std::vector<unsigned> expected(GetParam() / 2 + 1);
  std::iota(expected.begin(), expected.end(), 0U);
  EXPECT_EQ(orders, expected);
}

TEST_P(CosinePlans, IntegrateOverAFullTurn) {
  const auto plan = make_cosine_plan(GetParam());
  const Values f = ramp(plan.points);
  const std::size_t n = GetParam();

  const Values orders = transform(plan, f);

  for (std::size_t at = 0; at < plan.points; ++at) {
    double expected = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k * plan.orders[at] % n) / static_cast<double>(n);
      expected += 2 * std::numbers::pi / static_cast<double>(n) * f[std::min(k, n - k)] * std::cos(angle);
    }
    ASSERT_NEAR(orders[at], expected, 1e-13) << "order " << plan.orders[at];
  }
}

TEST_P(CosinePlans, RestoreWhatTheyTransformed) {
  const auto plan = make_cosine_plan(GetParam());
  const Values f = ramp(plan.points);

  const Values again = restore(plan, transform(plan, f));

  for (std::size_t k = 0; k < plan.points; ++k) ASSERT_NEAR(again[k], f[k], 1e-14) << "azimuth " << k;
}

// One pair, a middle, odd halves, powers of two, and what grids have.
INSTANTIATE_TEST_SUITE_P(host, CosinePlans, ::testing::Values(2, 4, 6, 8, 14, 26, 64, 72, 90, 128, 360));

TEST(CosinePlan, NeedsAboutAThirdOfTheWholeMatrix) {
  const auto plan = make_cosine_plan(256);

  EXPECT_LT(plan.forward.coefficients.size(), 0.38 * static_cast<double>(plan.points * plan.points));
}

}  // namespace
}  // namespace lobe::test
