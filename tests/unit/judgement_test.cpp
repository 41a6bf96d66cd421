#include "lobe/compare/judgement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "lobe/compare/rank_correlation.hpp"
#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using Series = std::vector<double>;

std::string complaint_about(const std::string& text) {
  try {
    (void)parse_judgements(text);
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Judgements, AreReadAsPublished) {
  const auto judgements = parse_judgements(
      "\"METHOD\";\"BRDF\";\"DISTANCE\"\r\n\"ABC\";\"alum-bronze\";0.216666666666667\r\n\"WARD\";\"gold\";1\r\n");

  ASSERT_EQ(judgements.size(), 2U);
  EXPECT_EQ(judgements[0].method, "ABC");
  EXPECT_EQ(judgements[0].material, "alum-bronze");
  EXPECT_EQ(judgements[0].distance, 0.216666666666667);
}

TEST(Judgements, MayHaveTheirColumnsInAnyOrderAndBesideOthers) {
  const auto judgements = parse_judgements(
      "\xEF\xBB\xBF"
      "brdf,observers,Distance,method\n\"a,b\",12,0.5,WARD\n");

  ASSERT_EQ(judgements.size(), 1U);
  EXPECT_EQ(judgements[0].material, "a,b");
  EXPECT_EQ(judgements[0].method, "WARD");
  EXPECT_EQ(judgements[0].distance, 0.5);
}

TEST(Judgements, ThatCannotBeReadAreToldByTheirLine) {
  EXPECT_THAT(complaint_about(""), HasSubstr("no judgements"));
  EXPECT_THAT(complaint_about("METHOD;MATERIAL;DISTANCE\nA;b;1\n"), HasSubstr("line 1: no column 'brdf'"));
  EXPECT_THAT(complaint_about("METHOD;BRDF;DISTANCE\nA;b\n"), HasSubstr("line 2: 2 fields"));
  EXPECT_THAT(complaint_about("METHOD;BRDF;DISTANCE\n\nA;b;far\n"), HasSubstr("line 3: 'far' is no distance"));
  EXPECT_THAT(complaint_about("METHOD;BRDF;DISTANCE\nA;b;1\na;b;2\n"),
              HasSubstr("line 3: 'a' of 'b' is judged a second"));
  EXPECT_THAT(complaint_about("METHOD;BRDF;DISTANCE\n\"A;b;1\n"), HasSubstr("line 2: a quote is not closed"));
  EXPECT_THAT(complaint_about("METHOD;BRDF;DISTANCE\nA\x1b[2J;b;1\n"), HasSubstr("line 2: 'A\\x1b[2J' has control"));
  EXPECT_LE(complaint_about("METHOD;BRDF;DISTANCE\n" + std::string(5000, '\x01') + ";b;1\n").size(), 300U);
}

/// Pairs of normal numbers with a correlation.
struct Pairs {
  Series a, b;
};
Pairs normal_pairs(std::size_t count, double correlation, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  Pairs pairs;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = normal(engine);
    pairs.a.push_back(x);
    pairs.b.push_back(correlation * x + std::sqrt(1 - correlation * correlation) * normal(engine));
  }
  return pairs;
}

TEST(JudgementCorrelation, IsThatOfTheSeries) {
  const auto [a, b] = normal_pairs(50, 0.5, 1);

  const auto found = judgement_correlation(a, b);

  EXPECT_EQ(found.spearman.value, spearman(a, b));
  EXPECT_EQ(found.kendall.value, kendall(a, b));
  EXPECT_LT(found.spearman.low, found.spearman.value);
  EXPECT_GT(found.spearman.high, found.spearman.value);
}

TEST(JudgementCorrelation, OfIndependentSeriesHasTheIntervalOfTheory) {
  const auto [a, b] = normal_pairs(300, 0, 2);

  const auto interval = judgement_correlation(a, b).spearman;

  // The variance of rho is 1 / (n - 1) exactly; a percentile of 1000 samples is known to some 6 %.
  const double expected = 2 * 1.96 / std::sqrt(299.0);
  EXPECT_NEAR(interval.high - interval.low, expected, 0.2 * expected);
}

TEST(JudgementCorrelation, HoldsTheTrueOneAsOftenAsItSays) {
  // Spearman's rho of normal numbers is 6/pi asin(r/2).
  const double truth = 6 / std::acos(-1.0) * std::asin(0.25);
  constexpr int kTrials = 300;
  int held = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto [a, b] = normal_pairs(100, 0.5, 100 + static_cast<std::uint64_t>(trial));
    const auto interval = judgement_correlation(a, b, {}, {.samples = 300}).spearman;
    if (interval.low <= truth && truth <= interval.high) ++held;
  }
  // 95 % to three standard deviations of the count, less what percentiles of 100 pairs are known to be short of.
  EXPECT_GE(held, 0.89 * kTrials);
  EXPECT_LE(held, 0.99 * kTrials);
}

TEST(JudgementCorrelation, TakesNoComfortFromPairsThatAreTheSame) {
  const auto [a, b] = normal_pairs(60, 0.3, 3);
  Pairs thrice;
  std::vector<std::string> group;
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (int copy = 0; copy < 3; ++copy) {
      thrice.a.push_back(a[k]);
      thrice.b.push_back(b[k]);
      group.push_back(std::to_string(k));
    }
  }
  const auto width = [](const JudgementCorrelation& found) { return found.spearman.high - found.spearman.low; };

  const double once = width(judgement_correlation(a, b));
  EXPECT_NEAR(width(judgement_correlation(thrice.a, thrice.b, group)), once, 0.15 * once);
  EXPECT_LT(width(judgement_correlation(thrice.a, thrice.b)), 0.7 * once);
}

TEST(JudgementCorrelation, IsTheSameForTheSameSeed) {
  const auto [a, b] = normal_pairs(40, 0.3, 4);

  const double low = judgement_correlation(a, b).kendall.low;
  EXPECT_EQ(judgement_correlation(a, b).kendall.low, low);
  EXPECT_NE(judgement_correlation(a, b, {}, {.seed = 2}).kendall.low, low);
}

TEST(JudgementCorrelation, RefusesWhatHasNone) {
  const Series three{1, 2, 3};
  EXPECT_THROW((void)judgement_correlation(Series{1, 2}, Series{1, 2}), ArgumentError);
  EXPECT_THROW((void)judgement_correlation(three, Series{1, 2, 3, 4}), ArgumentError);
  EXPECT_THROW((void)judgement_correlation(three, three, std::vector<std::string>{"a"}), ArgumentError);
  EXPECT_THROW((void)judgement_correlation(three, three, {}, {.samples = 5}), ArgumentError);
  EXPECT_THROW((void)judgement_correlation(three, three, {}, {.coverage = 1}), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
