#include "hemisphere/gauss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "support/names.hpp"

namespace lobe::test {
namespace {

class GaussRuleOf : public ::testing::TestWithParam<int> {};

double integral_of_power(const GaussRule& rule, int degree) {
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], degree);
  return sum;
}

TEST_P(GaussRuleOf, IsExactToTheDegreeItPromises) {
  const auto rule = gauss_rule(GetParam());

  for (int degree = 0; degree <= 2 * GetParam() - 1; ++degree) {
    EXPECT_NEAR(integral_of_power(rule, degree) * (degree + 1), 1, 1e-15 * (degree + 10)) << "degree " << degree;
  }
}

TEST_P(GaussRuleOf, HasRisingNodesInsideTheIntervalAndPositiveWeights) {
  const auto rule = gauss_rule(GetParam());

  ASSERT_EQ(rule.nodes.size(), static_cast<std::size_t>(GetParam()));
  ASSERT_EQ(rule.weights.size(), rule.nodes.size());
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    EXPECT_GT(rule.nodes[i], i == 0 ? 0.0 : rule.nodes[i - 1]) << i;
    EXPECT_LT(rule.nodes[i], 1) << i;
    EXPECT_GT(rule.weights[i], 0) << i;
  }
}

TEST_P(GaussRuleOf, IsSymmetric) {
  const auto rule = gauss_rule(GetParam());

  for (std::size_t i = 0, j = rule.nodes.size() - 1; i < rule.nodes.size(); ++i, --j) {
    EXPECT_NEAR(rule.nodes[i] + rule.nodes[j], 1, 1e-15) << i;
    EXPECT_NEAR(rule.weights[i], rule.weights[j], 1e-15) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(hemisphere, GaussRuleOf, ::testing::Values(1, 2, 3, 6, 10, 15, 22, 33, 64),
                         ::testing::PrintToStringParamName());

TEST(GaussRule, OfTwoNodesIsTheTextbookRule) {
  const auto rule = gauss_rule(2);

  EXPECT_NEAR(rule.nodes[0], 0.5 - 0.5 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(rule.weights[0], 0.5, 1e-15);
}

/// Integral of (degree + 1) x^degree, which is 1, by weights at the nodes of the embedded pair.
double kronrod_power(const std::array<double, KronrodRule::kNodes>& weights, int degree) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * std::pow(kronrod_rule().nodes[i], degree);
  return sum * (degree + 1);
}

TEST(KronrodRule, IsExactToDegree22) {
  for (int degree = 0; degree <= 22; ++degree)
    EXPECT_NEAR(kronrod_power(kronrod_rule().weights, degree), 1, 4e-15) << degree;
}

TEST(KronrodRule, HoldsAGaussRuleOfDegree13) {
  const auto& weights = kronrod_rule().coarse_weights;
  for (int degree = 0; degree <= 13; ++degree) EXPECT_NEAR(kronrod_power(weights, degree), 1, 4e-15) << degree;
}

TEST(TidyEdges, SortsAndDropsCoincidingLimits) {
  std::vector<PanelEdge> edges{{1.0}, {0.0}, {0.5}, {0.5 + 1e-17}, {0.25}, {1.0}};

  tidy_edges(edges);

  ASSERT_EQ(edges.size(), 4U);
  EXPECT_EQ(edges[0].at, 0.0);
  EXPECT_EQ(edges[1].at, 0.25);
  EXPECT_EQ(edges[2].at, 0.5);
  EXPECT_EQ(edges[3].at, 1.0);
}

TEST(TidyEdges, ALimitStaysARootWhenItCoincidesWithAnother) {
  std::vector<PanelEdge> edges{{0.0}, {0.5, true}, {0.5}, {1.0}};

  tidy_edges(edges);

  ASSERT_EQ(edges.size(), 3U);
  EXPECT_TRUE(edges[1].root);
}

TEST(GradeEdges, LetsPanelsGrowNoFasterThanAsked) {
  std::vector<PanelEdge> edges{{0, true}, {0.5, true}, {0.5001}, {2}};

  grade_edges(edges, 3);

  EXPECT_EQ(edges.front().at, 0);
  EXPECT_EQ(edges.back().at, 2);
  for (std::size_t i = 2; i < edges.size(); ++i) {
    const double ratio = (edges[i].at - edges[i - 1].at) / (edges[i - 1].at - edges[i - 2].at);
    EXPECT_GT(edges[i].at, edges[i - 1].at) << i;
    EXPECT_LE(ratio, 3 + 1e-9) << i;
    EXPECT_GE(ratio, 1 / (3 + 1e-9)) << i;
  }
}

TEST(GradeEdges, KeepsTheLimitsThatWereThere) {
  std::vector<PanelEdge> edges{{0, true}, {0.5, true}, {0.5001}, {2}};

  grade_edges(edges, 3);

  const auto kept = std::count_if(edges.begin(), edges.end(), [](const PanelEdge& edge) { return edge.root; });
  EXPECT_EQ(kept, 2);
  EXPECT_TRUE(std::any_of(edges.begin(), edges.end(), [](const PanelEdge& edge) { return edge.at == 0.5001; }));
}

struct Panel {
  std::string name;
  PanelEdge low;
  PanelEdge high;
};
std::ostream& operator<<(std::ostream& out, const Panel& panel) {
  return out << panel.name;
}

class PanelPointOf : public ::testing::TestWithParam<Panel> {};

double integrate(const Panel& panel, const std::function<double(double)>& g) {
  const auto rule = gauss_rule(12);
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const auto point = panel_point(panel.low, panel.high, rule.nodes[i]);
    sum += rule.weights[i] * point.stretch * g(point.at);
  }
  return sum;
}

TEST_P(PanelPointOf, MapsTheUnitIntervalOntoThePanel) {
  const PanelEdge low = GetParam().low;
  const PanelEdge high = GetParam().high;

  EXPECT_NEAR(panel_point(low, high, 0).at, low.at, 1e-16);
  EXPECT_NEAR(panel_point(low, high, 1).at, high.at, 1e-16);
  EXPECT_NEAR(integrate(GetParam(), [](double t) { return t * t; }), (0.512 - 0.008) / 3, 1e-15);
}

TEST_P(PanelPointOf, IntegratesRootsAtItsRootLimits) {
  const PanelEdge low = GetParam().low;
  const PanelEdge high = GetParam().high;
  const double width = high.at - low.at;
  const double expected = 2.0 / 3 * std::pow(width, 1.5);

  if (low.root) {
    EXPECT_NEAR(integrate(GetParam(), [&](double t) { return std::sqrt(t - low.at); }), expected, 1e-6 * expected);
  }
  if (high.root) {
    EXPECT_NEAR(integrate(GetParam(), [&](double t) { return std::sqrt(high.at - t); }), expected, 1e-6 * expected);
  }
}

INSTANTIATE_TEST_SUITE_P(hemisphere, PanelPointOf,
                         ::testing::Values(Panel{"plain", {0.2}, {0.8}}, Panel{"low_root", {0.2, true}, {0.8}},
                                           Panel{"high_root", {0.2}, {0.8, true}},
                                           Panel{"both_roots", {0.2, true}, {0.8, true}}),
                         ByName{});

}  // namespace
}  // namespace lobe::test
