#include "hemisphere/inner_rule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>

#include "support/names.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

struct Case {
  std::string name;
  HemisphereGrid grid;
  LobeExtent f, g;
  std::size_t level;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

/// Integral of g(elevation, azimuth) dmu(X).
double integral(const Case& c, const std::function<double(double elevation, double azimuth)>& g) {
  const InnerRule rule(c.grid, c.f, c.g, c.level);
  const double step = 2 * pi / static_cast<double>(c.grid.n_phi());
  double sum = 0;
  for (const InnerBand& band : rule.bands()) {
    for (const WeightedPoint& elevation : band.elevations) {
      for (const WeightedPoint& offset : band.offsets) {
        for (std::size_t k = 0; k < c.grid.n_phi(); ++k) {
          const double azimuth = step * static_cast<double>(k);
          // The mean of both signs of the offset.
          sum += elevation.weight * offset.weight *
                 (g(elevation.at, azimuth + offset.at) + g(elevation.at, azimuth - offset.at)) / 2;
        }
      }
    }
  }
  return sum;
}

class InnerRuleOf : public ::testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(property, InnerRuleOf,
                         ::testing::Values(Case{"wide", HemisphereGrid::gauss(16, 32), {}, {0.3, {}, 1, {}}, 2},
                                           Case{"sharp", HemisphereGrid::gauss(64, 128), {0.01, {}, 1, {}}, {}, 2},
                                           Case{"retro", HemisphereGrid::uniform(9, 20), {}, {1, {}, 0.02, {}}, 3},
                                           Case{"single_ring", HemisphereGrid::gauss(1, 2), {0.1, {}, 1, {}}, {}, 4}),
                         ByName{});

TEST_P(InnerRuleOf, MeasuresTheProjectedHemisphere) {
  EXPECT_NEAR(integral(GetParam(), [](double, double) { return 1.0; }), pi, 1e-3 * pi);
}

TEST_P(InnerRuleOf, TakesNoLobeForAnother) {
  // cos^2 of the elevation times (1 + cos of the azimuth): the second term vanishes, the first is pi / 2.
  const auto g = [](double elevation, double azimuth) {
    return std::cos(elevation) * std::cos(elevation) * (1 + std::cos(azimuth) / 2);
  };
  EXPECT_NEAR(integral(GetParam(), g), pi / 2, 1e-3 * pi);
}

TEST(InnerRule, ResolvesALobeThatIsNarrowAtGrazingAngles) {
  // exp(-(psi/w)^2) about an azimuth of the grid, w as N.H lobes of width 0.05 have it at the lowest ring.
  const auto grid = HemisphereGrid::gauss(32, 64);
  const LobeExtent sharp{0.05, {}, 1, {}};
  const double lowest = pi / 2 - grid.rings().back().theta;
  const double width = 0.1 * lowest;
  const InnerRule rule(grid, sharp, sharp, 2);
  for (const InnerBand& band : rule.bands()) {
    SCOPED_TRACE(band.elevations.front().at);
    if (band.elevations.front().at > lowest) continue;
    double sum = 0;
    for (const WeightedPoint& offset : band.offsets) sum += offset.weight * std::exp(-std::pow(offset.at / width, 2));
    EXPECT_NEAR(sum, width * std::sqrt(pi), 1e-4 * width);
  }
}

TEST(InnerRule, EndsItsBandsOnTheRings) {
  // max(N.L, N.X) has its kink at L, so one of the factors may jump there in its derivative.
  const auto grid = HemisphereGrid::gauss(12, 24);
  const InnerRule rule(grid, {}, {}, 1);
  for (const Ring& ring : grid.rings()) {
    SCOPED_TRACE(ring.theta);
    double below = 0;  // integral of the elevation's measure below the ring
    for (const InnerBand& band : rule.bands()) {
      for (const WeightedPoint& elevation : band.elevations) {
        if (elevation.at < pi / 2 - ring.theta) below += elevation.weight;
      }
    }
    const double cosine = std::cos(ring.theta);
    EXPECT_NEAR(below, cosine * cosine / 2, 1e-5);
  }
}

TEST(InnerRule, GrowsFromLevelToLevel) {
  const auto grid = HemisphereGrid::gauss(8, 16);
  for (std::size_t level = 1; level < InnerRule::kLevels; ++level) {
    SCOPED_TRACE(level);
    EXPECT_GT(InnerRule(grid, {}, {}, level).size(), InnerRule(grid, {}, {}, level - 1).size());
  }
}

}  // namespace
}  // namespace lobe::test
