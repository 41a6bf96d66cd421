#include <gtest/gtest.h>

#include "core/bisection.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/metric/unit.hpp"

namespace lobe::test {
namespace {

TEST(EstimateArithmetic, AddsErrors) {
  const Estimate sum = Estimate{1, 0.1} + Estimate{-3, 0.2};
  EXPECT_DOUBLE_EQ(sum.value, -2);
  EXPECT_DOUBLE_EQ(sum.error, 0.3);
}

TEST(EstimateArithmetic, ScalesErrorsByTheAbsoluteValue) {
  EXPECT_DOUBLE_EQ((-2 * Estimate{1, 0.1}).error, 0.2);
}

TEST(EstimateArithmetic, BoundsAProductByItsWorstCorner) {
  const Estimate product = Estimate{2, 0.5} * Estimate{-3, 0.1};
  EXPECT_DOUBLE_EQ(product.value, -6);
  EXPECT_DOUBLE_EQ(product.error, 2.5 * 3.1 - 6);
}

TEST(EstimateArithmetic, AddsRelativeErrorsOfAQuotient) {
  const Estimate quotient = Estimate{-6, 0.6} / Estimate{2, 0.1};
  EXPECT_DOUBLE_EQ(quotient.value, -3);
  EXPECT_DOUBLE_EQ(quotient.error, 3 * (0.1 + 0.05));
}

TEST(EstimateArithmetic, TakesTheRootOfASquareThatRoundingMadeNegative) {
  const Estimate root = square_root({-1e-20, 4e-18});
  EXPECT_EQ(root.value, 0);
  EXPECT_DOUBLE_EQ(root.error, 2e-9);
  EXPECT_DOUBLE_EQ(square_root({4, 0.4}).error, 0.2);
}

TEST(Bisection, FindsWhereAPredicateChanges) {
  const Bracket found = bisect({0, 4}, 60, [](double x) { return x * x < 2; });
  EXPECT_LT(found.low * found.low, 2);
  EXPECT_GE(found.high * found.high, 2);
  EXPECT_NEAR(found.high - found.low, 0, 1e-15);
  EXPECT_EQ(bisect(
                {0, 4}, 60, [](double x) { return x < 1.5; }, 1.0)
                .high,
            2);
}

TEST(NormUnit, HasOneSpellingPerMedium) {
  EXPECT_EQ(norm_unit(Lighting::daylight()), "sr^1/2");
  EXPECT_EQ(norm_unit(Lighting::daylight(), UnitStyle::udunits), "sr^0.5");
  EXPECT_EQ(norm_unit(Lighting::daylight(), UnitStyle::printed), "√sr");
  EXPECT_EQ(norm_unit(Lighting::point()), "1");
  EXPECT_EQ(product_unit(Lighting::mean_albedo()), "sr^2");
  EXPECT_EQ(product_unit(Lighting::mean_albedo(), UnitStyle::udunits), "sr2");
}

}  // namespace
}  // namespace lobe::test
