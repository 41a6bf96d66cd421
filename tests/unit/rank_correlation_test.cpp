#include "lobe/compare/rank_correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using RankSeries = std::vector<double>;

/// Kendall's tau-b as it is defined, pair by pair.
double kendall_by_pairs(const RankSeries& a, const RankSeries& b) {
  double score = 0;
  double untied_a = 0;
  double untied_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int sign_a = (a[i] > a[j]) - (a[i] < a[j]);
      const int sign_b = (b[i] > b[j]) - (b[i] < b[j]);
      score += sign_a * sign_b;
      untied_a += sign_a * sign_a;
      untied_b += sign_b * sign_b;
    }
  }
  return score / std::sqrt(untied_a * untied_b);
}

/// Spearman's rho from ranks counted value by value.
double spearman_by_pairs(const RankSeries& a, const RankSeries& b) {
  const auto rank = [](const RankSeries& x, std::size_t i) {
    double below = 0;
    double equal = 0;
    for (const double other : x) {
      below += other < x[i];
      equal += other == x[i];
    }
    return below + (equal + 1) / 2;
  };
  const double mean = (static_cast<double>(a.size()) + 1) / 2;
  double xy = 0;
  double xx = 0;
  double yy = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = rank(a, i) - mean;
    const double y = rank(b, i) - mean;
    xy += x * y;
    xx += x * x;
    yy += y * y;
  }
  return xy / std::sqrt(xx * yy);
}

RankSeries random_series(std::size_t count, int values, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> value(0, values - 1);
  RankSeries series;
  for (std::size_t i = 0; i < count; ++i) series.push_back(value(generator));
  return series;
}

// Sums over some hundred ranks.
constexpr double kRankRounding = 1e-13;

TEST(RankCorrelation, IsOneForTheSameOrder) {
  EXPECT_NEAR(spearman(RankSeries{1, 2, 5, 9}, RankSeries{0.1, 7, 8, 1e9}), 1, kRankRounding);
  EXPECT_NEAR(kendall(RankSeries{1, 2, 5, 9}, RankSeries{0.1, 7, 8, 1e9}), 1, kRankRounding);
}

TEST(RankCorrelation, IsMinusOneForTheReverse) {
  EXPECT_NEAR(spearman(RankSeries{1, 2, 5, 9}, RankSeries{4, 3, 2, 1}), -1, kRankRounding);
  EXPECT_NEAR(kendall(RankSeries{1, 2, 5, 9}, RankSeries{4, 3, 2, 1}), -1, kRankRounding);
}

TEST(RankCorrelation, OfFiveValuesIsAsByHand) {
  // Ranks 1 2 3 4 5 against 2 1 4 3 5: sum d^2 = 4, rho = 1 - 6*4/(5*24) = 0.8; 8 concordant, 2 discordant: tau = 0.6.
  const RankSeries a{10, 20, 30, 40, 50};
  const RankSeries b{2, 1, 4, 3, 5};
  EXPECT_NEAR(spearman(a, b), 0.8, kRankRounding);
  EXPECT_NEAR(kendall(a, b), 0.6, kRankRounding);
}

TEST(RankCorrelation, SharesRanksAmongTies) {
  // Ranks 1.5 1.5 3 4 against 1 2 3.5 3.5.
  const RankSeries a{1, 1, 2, 3};
  const RankSeries b{1, 2, 3, 3};
  // Centred ranks (-1 -1 .5 1.5) and (-1.5 -.5 1 1): xy = 1.5 + .5 + .5 + 1.5 = 4, xx = yy = 4.5.
  EXPECT_NEAR(spearman(a, b), 4 / 4.5, kRankRounding);
  // p = 6, one tie in each: 4 / sqrt(5 * 5).
  EXPECT_NEAR(kendall(a, b), 0.8, kRankRounding);
}

TEST(RankCorrelation, AgreesWithItsDefinitionWithManyTies) {
  const RankSeries a = random_series(301, 12, 1);
  const RankSeries b = random_series(301, 9, 2);
  EXPECT_NEAR(kendall(a, b), kendall_by_pairs(a, b), kRankRounding);
  EXPECT_NEAR(spearman(a, b), spearman_by_pairs(a, b), kRankRounding);
}

TEST(RankCorrelation, AgreesWithItsDefinitionWithTiesInBoth) {
  const RankSeries a = random_series(200, 5, 3);
  RankSeries b = a;
  for (std::size_t i = 0; i < b.size(); i += 3) b[i] += 1;
  EXPECT_NEAR(kendall(a, b), kendall_by_pairs(a, b), kRankRounding);
  EXPECT_NEAR(spearman(a, b), spearman_by_pairs(a, b), kRankRounding);
}

TEST(RankCorrelation, AgreesWithItsDefinitionAlmostWithoutTies) {
  const RankSeries a = random_series(500, 1000000, 4);
  const RankSeries b = random_series(500, 1000000, 5);
  EXPECT_NEAR(kendall(a, b), kendall_by_pairs(a, b), kRankRounding);
  EXPECT_NEAR(spearman(a, b), spearman_by_pairs(a, b), kRankRounding);
}

TEST(RankCorrelation, DoesNotExistForAConstantSeries) {
  EXPECT_TRUE(std::isnan(spearman(RankSeries{1, 1, 1}, RankSeries{1, 2, 3})));
  EXPECT_TRUE(std::isnan(kendall(RankSeries{1, 2, 3}, RankSeries{4, 4, 4})));
}

TEST(RankCorrelation, NeedsSeriesOfOneLength) {
  EXPECT_THROW((void)spearman(RankSeries{1, 2}, RankSeries{1}), ArgumentError);
  EXPECT_THROW((void)kendall(RankSeries{}, RankSeries{}), ArgumentError);
}

TEST(RankCorrelation, RefusesWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)kendall(RankSeries{1, nan}, RankSeries{1, 2}), NumericError);
}

TEST(RankAgreement, TakesThePairsOfMaterials) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, 3);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(3, 3);
  a(1, 0) = a(0, 1) = 1;
  a(2, 0) = a(0, 2) = 2;
  a(2, 1) = a(1, 2) = 3;
  b(1, 0) = b(0, 1) = 5;
  b(2, 0) = b(0, 2) = 9;
  b(2, 1) = b(1, 2) = 7;

  const RankAgreement agreement = rank_agreement(std::vector<Eigen::MatrixXd>{a, b});

  // Ranks 1 2 3 against 1 3 2: rho = 1 - 6*2/(3*8), tau = (2 - 1)/3.
  EXPECT_NEAR(agreement.spearman(1, 0), 0.5, kRankRounding);
  EXPECT_NEAR(agreement.kendall(0, 1), 1.0 / 3, kRankRounding);
  EXPECT_NEAR(agreement.spearman(0, 0), 1, kRankRounding);
  EXPECT_EQ(agreement.kendall(0, 1), agreement.kendall(1, 0));
}

TEST(RankAgreement, NeedsMatricesOfOneSize) {
  EXPECT_THROW(
      (void)rank_agreement(std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Zero(3, 3), Eigen::MatrixXd::Zero(4, 4)}),
      ArgumentError);
  EXPECT_THROW((void)rank_agreement(std::vector<Eigen::MatrixXd>{}), ArgumentError);
}

/// Six materials on a line, the second three far away.
Eigen::MatrixXd line(const std::vector<double>& places) {
  const auto n = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd distance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      distance(i, j) = std::abs(places[static_cast<std::size_t>(i)] - places[static_cast<std::size_t>(j)]);
  }
  return distance;
}

const std::vector<std::string> kGroups{"a", "a", "a", "b", "b", "b"};

TEST(RankAgreementWithin, DoesNotSeeWhatSetsGroupsApart) {
  // Within a group distances rank 1 2 3 against 2 1 3; between groups all are large by both.
  const std::vector<Eigen::MatrixXd> distances{line({0, 1, 3, 100, 101, 103}), line({0, 2, 3, 100, 102, 103})};

  const RankAgreement within = rank_agreement_within(distances, kGroups);

  EXPECT_NEAR(within.spearman(1, 0), 0.5, kRankRounding);
  EXPECT_NEAR(within.kendall(1, 0), 1.0 / 3, kRankRounding);
  EXPECT_NEAR(within.spearman(1, 1), 1, kRankRounding);
  EXPECT_GT(rank_agreement(distances).spearman(1, 0), 0.9);
}

TEST(RankAgreementWithin, WeighsGroupsByTheirPairs) {
  // Three materials agree fully (3 pairs), four fully disagree (6 pairs).
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(7, 7);
  Eigen::MatrixXd b = a;
  double rank = 0;
  for (Eigen::Index i = 0; i < 7; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      a(i, j) = a(j, i) = ++rank;
      b(i, j) = b(j, i) = i < 3 ? rank : -rank + 100;
    }
  }
  const RankAgreement within =
      rank_agreement_within(std::vector{a, b}, std::vector<std::string>{"a", "a", "a", "b", "b", "b", "b"});

  EXPECT_NEAR(within.spearman(1, 0), (3.0 - 6.0) / 9, kRankRounding);
}

TEST(RankAgreementWithin, LeavesOutGroupsOfTwoAndConstantOnes) {
  const std::vector<Eigen::MatrixXd> distances{line({0, 1, 3, 5, 9}), line({0, 1, 3, 7, 7.5})};

  const RankAgreement within = rank_agreement_within(distances, std::vector<std::string>{"a", "a", "a", "b", "b"});
  const RankAgreement none = rank_agreement_within(std::vector<Eigen::MatrixXd>{Eigen::MatrixXd::Zero(3, 3)},
                                                   std::vector<std::string>{"a", "a", "a"});

  EXPECT_NEAR(within.spearman(1, 0), 1, kRankRounding);
  EXPECT_TRUE(std::isnan(none.spearman(0, 0)));
}

TEST(RankAgreementWithin, NeedsAGroupForEachMaterial) {
  EXPECT_THROW((void)rank_agreement_within(std::vector<Eigen::MatrixXd>{line({0, 1, 2})}, kGroups), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
