#include "lobe/hemisphere/grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "hemisphere/embedded_rule.hpp"
#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

double integral(const HemisphereGrid& grid, double (*g)(double theta, double phi)) {
  double sum = 0;
  for (std::size_t node = 0; node < grid.nodes(); ++node) {
    sum += grid.weights()[node] * g(grid.directions()[node].theta, grid.directions()[node].phi);
  }
  return sum;
}

/// Unit vector's base-plane part.
std::pair<double, double> projected(Direction d) {
  return {std::sin(d.theta) * std::cos(d.phi), std::sin(d.theta) * std::sin(d.phi)};
}

class Grid : public ::testing::TestWithParam<std::string> {
 protected:
  HemisphereGrid grid = HemisphereGrid::parse(GetParam());
};

INSTANTIATE_TEST_SUITE_P(all, Grid,
                         ::testing::Values("gauss:1x2", "gauss:12x24", "gauss:65x130", "uniform:17x36", "cells:16x30",
                                           "shirley-chiu:2", "shirley-chiu:16", "klems:145", "klems:77", "klems:73",
                                           "klems:41"),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

TEST_P(Grid, HasPositiveWeightsThatSumToPi) {
  for (const double weight : grid.weights()) EXPECT_GT(weight, 0);
  // Rounding of one addition per node.
  EXPECT_NEAR(std::accumulate(grid.weights().begin(), grid.weights().end(), 0.0), pi,
              1e-16 * pi * static_cast<double>(grid.nodes()) + 4e-15);
}

TEST_P(Grid, HasANameThatGivesTheSameGrid) {
  EXPECT_EQ(grid.name(), GetParam());
  EXPECT_EQ(HemisphereGrid::parse(grid.name()), grid);
}

TEST_P(Grid, MapsOntoItselfWhenTurnedHalfAround) {
  for (std::size_t node = 0; node < grid.nodes(); ++node) {
    const auto [x, y] = projected(grid.directions()[node]);
    const auto [opposite_x, opposite_y] = projected(grid.directions()[grid.opposite(node)]);
    EXPECT_NEAR(opposite_x, -x, 1e-15) << node;
    EXPECT_NEAR(opposite_y, -y, 1e-15) << node;
    EXPECT_EQ(grid.opposite(grid.opposite(node)), node) << node;
  }
}

TEST_P(Grid, HasRingsThatPartitionTheNodesAndTheHemisphere) {
  double limit = 0;
  std::size_t first = 0;
  double weight = 0;
  for (const Ring& ring : grid.rings()) {
    SCOPED_TRACE(ring.theta);
    EXPECT_EQ(ring.first_node, first);
    EXPECT_NEAR(ring.theta_low, limit, 1e-14);
    EXPECT_GE(ring.theta, ring.theta_low);
    EXPECT_LT(ring.theta, ring.theta_high);
    weight += ring.weight * static_cast<double>(ring.count);
    EXPECT_NEAR(weight, pi * std::pow(std::sin(ring.theta_high), 2), 1e-13);
    limit = ring.theta_high;
    first += ring.count;
  }
  EXPECT_EQ(first, grid.nodes());
  EXPECT_NEAR(limit, pi / 2, 1e-7);  // asin of nearly 1
}

TEST_P(Grid, FindsEveryNodeInItsOwnCell) {
  for (std::size_t node = 0; node < grid.nodes(); ++node) EXPECT_EQ(grid.node_at(grid.directions()[node]), node);
}

TEST_P(Grid, HasSamplesInsideTheirCells) {
  if (!grid.has_cells()) {
    EXPECT_EQ(grid.cell_points(0, 4).size(), 1U);
    return;
  }
  for (std::size_t node = 0; node < grid.nodes(); ++node) {
    const auto samples = grid.cell_points(node, 4);
    EXPECT_EQ(samples.size(), 16U) << node;
    for (const Direction& sample : samples) EXPECT_EQ(grid.node_at(sample), node);
  }
}

TEST_P(Grid, IsDividedByItsRefinement) {
  const auto fine = grid.refined();

  EXPECT_EQ(fine.nodes(), 4 * grid.nodes());
  EXPECT_NEAR(std::accumulate(fine.weights().begin(), fine.weights().end(), 0.0), pi, 1e-12);
}

TEST(GaussGrid, IntegratesPolynomialsInTheCosineExactly) {
  const auto grid = HemisphereGrid::gauss(8, 16);

  // integral of cos^14 dmu = 2 pi / 16: degree 15 with the cosine of the measure.
  EXPECT_NEAR(integral(grid, [](double theta, double) { return std::pow(std::cos(theta), 14); }), pi / 8, 1e-15);
  EXPECT_NEAR(integral(grid, [](double, double phi) { return std::cos(15 * phi); }), 0, 1e-15);
}

TEST(GaussGrid, KeepsThetaNearTheNormal) {
  const auto grid = HemisphereGrid::gauss(1024, 2);

  // First zero of the Bessel function: theta_1 = j0 / (n + 1/2) on [-1, 1], sqrt(2) of a half-range rule.
  EXPECT_NEAR(grid.rings().front().theta, 2.404825557695773 / (1024.5) / std::numbers::sqrt2, 1e-8);
}

TEST(EmbeddedRule, IsExactForPolynomialsOfLowDegree) {
  const auto grid = HemisphereGrid::gauss(16, 2);
  const auto weights = embedded_ring_weights(grid);

  for (int degree = 0; degree < 8; ++degree) {
    SCOPED_TRACE(degree);
    double sum = 0;
    for (std::size_t r = 0; r < weights.size(); ++r) {
      if (r % 2 == 0) {
        EXPECT_EQ(weights[r], 0) << r;
      }
      sum += weights[r] * std::pow(std::cos(grid.rings()[r].theta), degree);
    }
    EXPECT_NEAR(sum, 1.0 / (degree + 2), 1e-13) << degree;
  }
}

TEST(ShirleyChiuGrid, HasEqualWeights) {
  const auto grid = HemisphereGrid::shirley_chiu(8);

  EXPECT_EQ(grid.nodes(), 64U);
  for (const double weight : grid.weights()) EXPECT_EQ(weight, grid.weights().front());
}

TEST(KlemsGrid, HasTheRingsOfTheFullBasis) {
  const auto grid = HemisphereGrid::klems(145);
  std::vector<std::size_t> counts;
  for (const Ring& ring : grid.rings()) counts.push_back(ring.count);

  EXPECT_THAT(counts, ::testing::ElementsAre(1, 8, 16, 20, 24, 24, 24, 16, 12));
  EXPECT_NEAR(grid.rings()[1].theta, 10 * pi / 180, 1e-15);
  EXPECT_EQ(grid.rings()[0].theta, 0);
  EXPECT_NEAR(grid.rings()[8].theta, 82.5 * pi / 180, 1e-15);
}

TEST(KlemsGrid, HasTheHalfBasisOfCalcEngine) {
  // Middles and counts as CalcEngine has them; each limit lies as far below the middle as the one above it.
  const std::vector<double> middles{0, 13, 26, 39, 52, 65, 80.75};
  const auto grid = HemisphereGrid::klems(77);
  std::vector<std::size_t> counts;
  for (const Ring& ring : grid.rings()) counts.push_back(ring.count);

  EXPECT_THAT(counts, ::testing::ElementsAre(1, 8, 12, 16, 20, 12, 8));
  double limit = 90;
  for (std::size_t r = middles.size(); r-- > 0;) {
    SCOPED_TRACE(r);
    EXPECT_NEAR(grid.rings()[r].theta, middles[r] * pi / 180, 1e-15);
    EXPECT_NEAR(grid.rings()[r].theta_high, limit * pi / 180, 1e-7);  // asin of nearly 1
    limit = std::max(0.0, 2 * middles[r] - limit);
  }
}

struct BadGrid {
  const char* text;
  const char* complaint;
};

class UnreadableGrid : public ::testing::TestWithParam<BadGrid> {};

INSTANTIATE_TEST_SUITE_P(all, UnreadableGrid,
                         ::testing::Values(BadGrid{"gaus:8x16", "did you mean 'gauss'"},
                                           BadGrid{"gauss:8", "gauss:64x128"}, BadGrid{"gauss:8x15", "even number"},
                                           BadGrid{"gauss:0x16", "at least 1"}, BadGrid{"", "gauss:64x128"},
                                           BadGrid{"8x", "gauss:64x128"}, BadGrid{"gauss:8x16x4", "gauss:64x128"},
                                           BadGrid{"klems:100", "145, 77, 73 or 41"},
                                           BadGrid{"shirley-chiu:12", "power of two"},
                                           BadGrid{"gauss:99999999999x16", "gauss:64x128"}),
                         [](const auto& test) { return "case" + std::to_string(test.index); });

TEST_P(UnreadableGrid, IsRefusedWithWhatIsExpected) {
  try {
    (void)HemisphereGrid::parse(GetParam().text);
    FAIL() << "no exception";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().complaint));
  }
}

}  // namespace
}  // namespace lobe::test
