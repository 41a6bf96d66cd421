#include "hemisphere/cubature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "hemisphere/kronrod.hpp"
#include "support/random_materials.hpp"

namespace lobe::test {
namespace {

using Function = std::function<double(double u, double v)>;

const Rectangle kUnitSquare{{{0}, {1}}, {{0}, {1}}};

/// Of f over the unit square, and of what is carried along.
CubatureSums over_square(const Function& f, const CubatureGoal& goal, double carried = 0) {
  const Integrands integrands = [&](std::span<const CubaturePoint> points) {
    Eigen::MatrixXd values(static_cast<Eigen::Index>(points.size()), 2);
    for (std::size_t k = 0; k < points.size(); ++k) {
      values.row(static_cast<Eigen::Index>(k)) << f(points[k].u, points[k].v), carried;
    }
    return values;
  };
  return integrate_rectangles({kUnitSquare}, integrands, goal);
}

double sum_of_power(const std::vector<double>& weights, int degree) {
  const EmbeddedPair& pair = weights.size() == 7 ? short_pair() : weights.size() == 11 ? middle_pair() : long_pair();
  double sum = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * std::pow(2 * pair.nodes[k] - 1, degree);
  return sum;
}

class EmbeddedPairOf : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static const EmbeddedPair& pair() {
    return GetParam() == 3 ? short_pair() : GetParam() == 5 ? middle_pair() : long_pair();
  }
};

TEST_P(EmbeddedPairOf, HasKronrodsAndGaussDegrees) {
  const auto moment = [](int degree) { return degree % 2 == 1 ? 0 : 1.0 / (degree + 1); };
  for (int degree = 0; degree <= 3 * GetParam() + 1; ++degree) {
    EXPECT_NEAR(sum_of_power(pair().weights, degree), moment(degree), 4e-16) << degree;
  }
  for (int degree = 0; degree <= 2 * GetParam() - 1; ++degree) {
    EXPECT_NEAR(sum_of_power(pair().coarse_weights, degree), moment(degree), 4e-16) << degree;
  }
}

TEST_P(EmbeddedPairOf, HasANullRuleAsLargeAsTheDifference) {
  double difference = 0;
  double null = 0;
  for (std::size_t k = 0; k < pair().nodes.size(); ++k) {
    difference += std::pow(pair().weights[k] - pair().coarse_weights[k], 2);
    null += std::pow(pair().null_weights[k], 2);
  }
  EXPECT_NEAR(null, difference, 1e-14);
  const int highest = 2 * static_cast<int>(pair().nodes.size() / 2) - 1;
  for (int degree = 0; degree < highest; ++degree) {
    EXPECT_NEAR(sum_of_power(pair().null_weights, degree), 0, 1e-15) << degree;
  }
  EXPECT_GT(std::abs(sum_of_power(pair().null_weights, highest)), 1e-5);
}

TEST_P(EmbeddedPairOf, HasNullRulesOfFallingDegree) {
  const auto count = static_cast<Eigen::Index>(pair().nodes.size());
  const Eigen::Map<const Eigen::VectorXd> weights(pair().weights.data(), count);
  const Eigen::MatrixXd rules = weights.asDiagonal() * pair().relative_sums;
  const Eigen::Map<const Eigen::VectorXd> coarse(pair().coarse_weights.data(), count);
  const double size = (weights - coarse).norm();
  EXPECT_EQ(rules.col(0), weights);
  for (Eigen::Index k = 1; k < rules.cols(); ++k) {
    const std::vector<double> rule(rules.col(k).begin(), rules.col(k).end());
    const auto highest = static_cast<int>(count - 1 - k);
    for (int degree = 0; degree <= highest; ++degree)
      EXPECT_NEAR(sum_of_power(rule, degree), 0, 1e-15) << k << " " << degree;
    EXPECT_GT(std::abs(sum_of_power(rule, highest + 1)), 1e-5) << k;
    for (Eigen::Index j = 1; j <= k; ++j) {
      EXPECT_NEAR(rules.col(k).dot(rules.col(j)), j == k ? size * size : 0, 1e-15) << k << " " << j;
    }
  }
  // The first two are those of all estimates.
  const Eigen::Map<const Eigen::VectorXd> null(pair().null_weights.data(), count);
  EXPECT_NEAR(std::abs(rules.col(1).dot(weights - coarse)), size * size, 1e-15);
  EXPECT_NEAR(std::abs(rules.col(2).dot(null)), size * size, 1e-15);
}

/// An integral over a panel with an estimate of its error, the true error, and what the highest null rules give.
struct PanelCase {
  double estimate, error, highest;
};

PanelCase over_panel(const EmbeddedPair& pair, const std::function<double(double)>& f, double integral) {
  Eigen::ArrayXXd terms(1, static_cast<Eigen::Index>(pair.nodes.size()));
  for (std::size_t k = 0; k < pair.nodes.size(); ++k) {
    terms(0, static_cast<Eigen::Index>(k)) = pair.weights[k] * f(pair.nodes[k]);
  }
  const PanelIntegrals found = integrate_panels(pair, terms, terms.cols());
  const Eigen::RowVectorXd sums = terms.matrix() * pair.relative_sums;
  return {found.error(0), std::abs(found.value(0) - integral), std::hypot(sums(1), sums(2))};
}

// What lobes are like beside their peaks.
TEST_P(EmbeddedPairOf, StatesErrorsWhereItConverges) {
  for (int k = 0; k <= 60; ++k) {
    const double from = 0.05 * std::pow(100, k / 60.0);
    const auto [estimate, error, highest] = over_panel(
        pair(), [=](double x) { return 1 / (x + from); }, std::log1p(1 / from));
    EXPECT_LE(error, estimate / 100 + 1e-15) << from;
    EXPECT_LE(estimate, (from > 0.3 ? 0.1001 : 1) * highest + 1e-15) << from;
    EXPECT_GE(estimate, (from < 0.06 ? 0.9 : 0.0999) * highest - 1e-15) << from;
  }
  // The ratio of null rules is 0.27 to 0.28 here.
  const auto middle = over_panel(
      pair(), [](double x) { return 1 / (x + 0.1); }, std::log(11));
  EXPECT_NEAR(middle.estimate / middle.highest, GetParam() == 3 ? 0.46 : GetParam() == 5 ? 0.41 : 0.35, 0.01);
}

// A faint kink shows in the highest null rules alone, which beside a smooth function are as small as they should be.
TEST_P(EmbeddedPairOf, StatesErrorsOfFaintKinks) {
  for (int k = 120; k <= 880; ++k) {
    const double at = k / 1000.0;
    const double kink = (at * at + (1 - at) * (1 - at)) / 2;
    const auto [estimate, error, highest] = over_panel(
        pair(), [=](double x) { return std::exp(x) + 0.1 * std::abs(x - at); }, std::numbers::e - 1 + 0.1 * kink);
    EXPECT_LE(error, 8 * estimate) << at;
  }
}

TEST_P(EmbeddedPairOf, IntegratesChannelsOfPanels) {
  const auto count = static_cast<Eigen::Index>(pair().nodes.size());
  const Eigen::Index stride = count + 2;
  Eigen::ArrayXXd terms = Eigen::ArrayXXd::Constant(2, 3 * stride, 1e300);
  for (Eigen::Index panel = 0; panel < 3; ++panel) {
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto node = static_cast<std::size_t>(k);
      const double x = pair().nodes[node] + static_cast<double>(panel);
      terms(0, panel * stride + k) = pair().weights[node] * x * x;
      terms(1, panel * stride + k) = pair().weights[node] / (x + 0.1);
    }
  }
  const PanelIntegrals found = integrate_panels(pair(), terms, stride);
  for (Eigen::Index panel = 0; panel < 3; ++panel) {
    const auto low = static_cast<double>(panel);
    EXPECT_NEAR(found.value(0, panel), (std::pow(low + 1, 3) - std::pow(low, 3)) / 3, 1e-14) << panel;
    EXPECT_LE(found.error(0, panel), 1e-14) << panel;
    EXPECT_NEAR(found.value(1, panel), std::log((low + 1.1) / (low + 0.1)), found.error(1, panel) + 1e-15) << panel;
    EXPECT_LE(found.error(1, panel), 0.1) << panel;
    // As if it were alone.
    const PanelIntegrals alone = integrate_panels(pair(), terms.middleCols(panel * stride, stride), stride);
    EXPECT_TRUE((found.value.col(panel) == alone.value.col(0)).all()) << panel;
    EXPECT_TRUE((found.error.col(panel) == alone.error.col(0)).all()) << panel;
  }
}

INSTANTIATE_TEST_SUITE_P(hemisphere, EmbeddedPairOf, ::testing::Values(3, 5, 7), ::testing::PrintToStringParamName());

TEST(Cubature, IntegratesPolynomialsAtOnce) {
  const auto sums = over_square([](double u, double v) { return std::pow(u, 4) * v * v; },
                                {.relative = 1e-12, .most_points = 1000, .steering = 1});
  EXPECT_NEAR(sums.value(0), 1.0 / 15, 1e-16);
  EXPECT_EQ(sums.points, 49U + 4);
}

// A quarter of a disc: the integrand jumps on an arc.
TEST(Cubature, StatesItsErrorAtAJump) {
  const Function disc = [](double u, double v) { return std::hypot(u, v) < 1 ? 1.0 : 0.0; };
  for (const std::size_t points : {1000U, 4000U, 16000U, 64000U}) {
    const auto sums = over_square(disc, {.relative = 1e-9, .most_points = points, .steering = 1});
    EXPECT_NEAR(sums.value(0), std::numbers::pi / 4, sums.error(0)) << points;
    EXPECT_LT(sums.error(0), 3.0 / std::sqrt(static_cast<double>(points))) << points;
  }
}

/// Shares of stated errors that the true ones are, falling.
std::vector<double> shares_of(const std::vector<std::pair<Function, double>>& cases) {
  std::vector<double> shares;
  for (const auto& [f, integral] : cases) {
    const auto sums = over_square(f, {.relative = 1e-5, .most_points = 20'000, .steering = 1});
    shares.push_back(std::abs(sums.value(0) - integral) / sums.error(0));
  }
  std::ranges::sort(shares, std::greater<>());
  return shares;
}

// The difference of two rules vanishes for some places of the kink, where the null rule does not, and both for those
// before the first node of a cell or after the last, where the ends do not. All cells err with the same sign.
TEST(Cubature, StatesItsErrorAtAKinkAcrossOneVariable) {
  std::vector<std::pair<Function, double>> cases;
  for (int k = 30; k <= 970; ++k) {
    const double at = k / 1000.0;
    cases.emplace_back([at](double u, double) { return std::abs(u - at); }, (at * at + (1 - at) * (1 - at)) / 2);
  }
  EXPECT_LE(shares_of(cases).front(), 1);
}

TEST(Cubature, StatesItsErrorAtAJumpAcrossOneVariable) {
  std::vector<std::pair<Function, double>> cases;
  for (int k = 30; k <= 970; ++k) {
    const double at = k / 1000.0;
    cases.emplace_back([at](double, double v) { return v > at ? 1 : 0.2; }, 1 - 0.8 * at);
  }
  EXPECT_LE(shares_of(cases).front(), 1);
}

// Polynomials of the degree of the nodes lead to their values at both ends.
TEST_P(EmbeddedPairOf, LeadsToTheEnds) {
  for (std::size_t degree = 0; degree < pair().nodes.size(); ++degree) {
    double at_low = 0;
    double at_high = 0;
    for (std::size_t k = 0; k < pair().nodes.size(); ++k) {
      const double power = std::pow(pair().nodes[k], static_cast<double>(degree));
      at_low += pair().end_weights[k] * power;
      at_high += pair().end_weights[pair().nodes.size() - 1 - k] * power;
    }
    EXPECT_NEAR(at_low, degree == 0 ? 1 : 0, 1e-14) << degree;
    EXPECT_NEAR(at_high, 1, 1e-13) << degree;
  }
}

// |u cos a + v sin a - c| by a third antiderivative of the absolute value.
TEST(Cubature, StatesItsErrorAtObliqueKinks) {
  std::vector<std::pair<Function, double>> cases;
  Dice dice(7);
  for (int k = 0; k < 1000; ++k) {
    const double a = dice.uniform(0.05, std::numbers::pi / 2 - 0.05);
    const double c = dice.uniform(0.1, 0.9) * (std::cos(a) + std::sin(a));
    const auto third = [&](double u, double v) {
      const double x = u * std::cos(a) + v * std::sin(a) - c;
      return std::abs(x) * x * x / 6;
    };
    const double whole = (third(1, 1) - third(1, 0) - third(0, 1) + third(0, 0)) / (std::cos(a) * std::sin(a));
    cases.emplace_back([a, c](double u, double v) { return std::abs(u * std::cos(a) + v * std::sin(a) - c); }, whole);
  }
  const auto shares = shares_of(cases);
  EXPECT_LE(shares.front(), 2);
  EXPECT_LE(shares[cases.size() / 100], 1);
}

// Of the many cells along an arc each errs with its own sign.
TEST(Cubature, StatesErrorsOfManyCellsAsLargeAsTheyAreTogether) {
  std::vector<std::pair<Function, double>> cases;
  Dice dice(8);
  for (int k = 0; k < 400; ++k) {
    const double radius = dice.uniform(0.2, 0.45);
    const double u0 = dice.uniform(radius, 1 - radius);
    const double v0 = dice.uniform(radius, 1 - radius);
    cases.emplace_back([=](double u, double v) { return 1 + std::max(radius - std::hypot(u - u0, v - v0), 0.0); },
                       1 + std::numbers::pi * radius * radius * radius / 3);
  }
  const auto shares = shares_of(cases);
  EXPECT_LE(shares.front(), 1);
  EXPECT_GE(shares[cases.size() / 2], 0.04);  // 0.032 where each counts as if it were alone
}

// Squares of such values vanish.
TEST(Cubature, StatesErrorsOfValuesBelowTheRootOfTheSmallestNumber) {
  constexpr double kTiny = 0x1p-700;
  const auto disc_of = [](double height) -> Function {
    return [height](double u, double v) { return std::hypot(u, v) < 1 ? height : 0.0; };
  };
  const CubatureGoal goal{.relative = 1e-9, .most_points = 4000, .steering = 1};
  const auto tiny = over_square(disc_of(kTiny), goal);
  EXPECT_GT(tiny.error(0), 0);
  EXPECT_DOUBLE_EQ(tiny.error(0) / kTiny, over_square(disc_of(1), goal).error(0));
}

TEST(Cubature, EndsWhereAnotherErrorIsLarger) {
  const Function kink = [](double u, double v) { return std::abs(u - v - 0.1); };
  const CubatureGoal goal{.relative = 1e-7, .most_points = 50'000, .steering = 1, .has_errors = true};
  EXPECT_GE(over_square(kink, goal).points, goal.most_points);
  EXPECT_LT(over_square(kink, goal, 0.1).points, 2000U);
  EXPECT_GE(over_square(kink, goal, std::numeric_limits<double>::quiet_NaN()).points, goal.most_points);
}

}  // namespace
}  // namespace lobe::test
