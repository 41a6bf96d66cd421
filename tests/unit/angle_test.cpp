// The angle between two materials of a metric, by numbers made up for the purpose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "lobe/metric/metric.hpp"

namespace lobe::test {
namespace {

/// Two vectors of given norms and angle, known to a relative error.
Metric metric_of(double a, double b, double radians, double relative_error) {
  const double product = a * b * std::cos(radians);
  const double half = std::sin(radians / 2);
  const double distance = std::sqrt((a - b) * (a - b) + 4 * a * b * half * half);
  Metric metric;
  metric.norm = Eigen::Vector2d(a, b);
  metric.norm_error = relative_error * metric.norm;
  metric.gram = (Eigen::Matrix2d() << a * a, product, product, b * b).finished();
  metric.gram_error = relative_error * metric.gram.cwiseAbs();
  metric.distance = (Eigen::Matrix2d() << 0, distance, distance, 0).finished();
  metric.distance_error = relative_error * metric.distance;
  return metric;
}

void expect_angle(double a, double b, double radians, double largest_error) {
  const Estimate found = angle(metric_of(a, b, radians, 0), 0, 1);

  EXPECT_NEAR(found.value, radians, found.error);
  EXPECT_LE(found.error, largest_error) << radians;
}

TEST(Angle, OfExactNumbersIsKnownToTheirRounding) {
  expect_angle(2, 3, std::numbers::pi / 2, 1e-14);
  expect_angle(2, 3, 1, 1e-14);
  expect_angle(2, 2, 1e-6, 1e-14);
  expect_angle(1000, 0.001, 1, 1e-14);
}

TEST(Angle, OfExactNumbersIsOffByNoLessThanATenthOfWhatIsStated) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> size(0.1, 10);
  std::uniform_real_distribution<double> radians(0.1, 3);
  double worst = 0;
  for (int k = 0; k < 10000; ++k) {
    const double truth = radians(random);
    const Estimate found = angle(metric_of(size(random), size(random), truth, 0), 0, 1);
    worst = std::max(worst, std::abs(found.value - truth) / found.error);
  }
  EXPECT_LE(worst, 1);
  EXPECT_GE(worst, 0.1);
}

TEST(Angle, AtTheEndsIsKnownToTheRootOfTheRounding) {
  expect_angle(2, 3, 0, 1e-7);
  expect_angle(2, 3, std::numbers::pi, 1e-7);
}

TEST(Angle, OfNearParallelVectorsOfEqualNormIsKnownBetterThanByTheirProduct) {
  const Estimate found = angle(metric_of(2, 2, 1e-3, 1e-7), 0, 1);

  // Of the product: sqrt(2 * 3e-7), as large as the angle.
  EXPECT_NEAR(found.value, 1e-3, 1e-9);
  EXPECT_LT(found.error, 1e-6);
}

TEST(Angle, StaysWithinItsErrorWhenAllNumbersMoveWithinTheirs) {
  constexpr double kError = 1e-3;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> size(0.1, 10);
  std::uniform_real_distribution<double> radians(0, std::numbers::pi);
  std::uniform_int_distribution<int> sign(0, 1);
  const auto moved = [&](double& value, double error) { value += sign(random) == 1 ? error : -error; };
  for (int k = 0; k < 10000; ++k) {
    const double truth = radians(random);
    // The stated errors are those of the exact numbers, which the moved ones are within by construction.
    Metric metric = metric_of(size(random), size(random), truth, kError);
    moved(metric.norm(0), metric.norm_error(0));
    moved(metric.norm(1), metric.norm_error(1));
    moved(metric.gram(0, 1), metric.gram_error(0, 1));
    moved(metric.distance(0, 1), metric.distance_error(0, 1));
    const Estimate found = angle(metric, 0, 1);

    ASSERT_NEAR(found.value, truth, found.error) << k;
  }
}

TEST(Angle, IsNoneWhereANormIsNotAboveItsError) {
  EXPECT_TRUE(std::isnan(angle(metric_of(0, 1, 1, 1e-6), 0, 1).value));
  Metric metric = metric_of(1, 1e-9, 1, 1e-6);
  metric.norm_error(1) = 2e-9;
  EXPECT_TRUE(std::isnan(angle(metric, 0, 1).value));
}

TEST(Angle, HasAnUnknownErrorWhereThatOfANumberIsUnknown) {
  Metric metric = metric_of(1, 2, 1, 1e-6);
  metric.gram_error(0, 1) = std::numeric_limits<double>::quiet_NaN();

  EXPECT_NEAR(angle(metric, 0, 1).value, 1, 1e-14);
  EXPECT_TRUE(std::isnan(angle(metric, 0, 1).error));
}

}  // namespace
}  // namespace lobe::test
