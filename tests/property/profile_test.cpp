// Patch-based BRDFs whose profile or mixture is a curve (Neumann 2001, eq. 4.20, 4.39 to 4.42).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/model/profile.hpp"
#include "model/evaluate.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

Material of(std::vector<Term> terms) {
  return {"curve", "curve", std::move(terms)};
}

/// Pairs whose base-plane distance is m, V opposite L.
std::vector<Directions> pairs_at(const std::vector<double>& distances) {
  std::vector<Directions> pairs;
  for (const double m : distances) pairs.push_back({std::asin(m / 2), std::asin(m / 2), 0, 0});
  return pairs;
}

TEST(Profile, IsTheCurveThroughItsPoints) {
  const std::vector<CurvePoint> points{{0, 3}, {0.1, 1}, {0.3, 1}, {0.5, 1.5}, {0.8, 0.25}, {1.5, 0.1}};
  const auto values =
      evaluate(device(), of(make_profile(points)), pairs_at({0, 0.05, 0.1, 0.2, 0.4, 0.5, 1, 1.4, 1.6}));
  const std::vector<double> expected{3, 2, 1, 1, 1.25, 1.5, 0.25 - 0.15 * 2 / 7, 0.1 + 0.15 / 7, 0};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(values(static_cast<Eigen::Index>(k), 0), expected[k], 1e-13) << k;
  }
}

TEST(Profile, MayJump) {
  const std::vector<CurvePoint> points{{0, 2}, {0.2, 2}, {0.2, 0.5}, {2, 0.5}};
  const auto values = evaluate(device(), of(make_profile(points)), pairs_at({0.1, 0.19999, 0.20001, 1.99}));
  EXPECT_NEAR(values(0, 0), 2, 1e-14);
  EXPECT_NEAR(values(1, 0), 2, 1e-14);
  EXPECT_NEAR(values(2, 0), 0.5, 1e-14);
  EXPECT_NEAR(values(3, 0), 0.5, 1e-14);
}

TEST(Profile, HasTheAlbedoOfItsAreaAtTheNormal) {
  // Integral of xi(m) 2 pi m over m, of a cone and of what is left of a plateau.
  const std::vector<CurvePoint> points{{0, 1}, {0.2, 0.25}, {0.6, 0}};
  const auto found = albedo(device(), of(make_profile(points)), std::vector<double>{0}).front().front();
  const auto frustum = [](double inner, double outer) {
    return pi / 3 * (inner * inner + inner * outer + outer * outer);
  };
  EXPECT_NEAR(found.value, 0.75 * frustum(0, 0.2) + 0.25 * frustum(0.2, 0.6), found.error + 1e-12);
}

TEST(Profile, RefusesOtherPoints) {
  const auto refused = [](const std::vector<CurvePoint>& points) {
    EXPECT_THROW((void)make_profile(points), ArgumentError);
  };
  refused({});
  refused({{0, 1}});
  refused({{0.1, 1}, {0.2, 0}});
  refused({{0, 1}, {0.2, 1}, {0.1, 0}});
  refused({{0, 1}, {2.5, 0}});
  refused({{0, 1}, {0.2, -1}});
  refused({{0, 1}, {0.5, 1}, {0.5001, 0}});
  refused({{0, 0}, {0.5, 0}});
  refused({{0, 1}, {0, 0}});
  refused({{0, std::nan("")}, {1, 0}});
  refused({{0, HUGE_VAL}, {1, 0}});
  refused({{0, 1}, {1e-6, 0}});
}

TEST(Mixture, IsThatOfBasicPatches) {
  const std::vector<CurvePoint> points{{0.1, 0}, {0.3, 2}, {0.8, 0.5}, {1.4, 0.2}};
  const auto density = [&](reference::Real t) -> reference::Real {
    for (std::size_t k = 1; k < points.size(); ++k) {
      if (t > points[k].at) continue;
      const double width = points[k].at - points[k - 1].at;
      return (points[k - 1].value * (points[k].at - t) + points[k].value * (t - points[k - 1].at)) / width;
    }
    return 0;
  };
  const std::vector<double> distances{0, 0.05, 0.2, 0.5, 0.9, 1.2, 1.39, 1.5};
  const auto values = evaluate(device(), of(make_mixture(points)), pairs_at(distances));
  for (std::size_t k = 0; k < distances.size(); ++k) {
    double expected = 0;
    std::vector<double> ends{0.1, 0.3, 0.8, 1, 1.4};
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double from = std::max(ends[i - 1], distances[k]);
      if (from >= ends[i]) continue;
      expected += static_cast<double>(reference::smooth_integral(
          [&](reference::Real t) { return density(t) / std::numbers::pi_v<reference::Real> / std::min(1.0L, t * t); },
          from, ends[i]));
    }
    EXPECT_NEAR(values(static_cast<Eigen::Index>(k), 0), expected, 1e-13 * (1 + expected)) << distances[k];
  }
}

TEST(Mixture, ReflectsTheIntegralOfItsDensityAtTheNormal) {
  const std::vector<CurvePoint> points{{0.1, 0}, {0.3, 2}, {0.8, 0.5}};
  const auto found = albedo(device(), of(make_mixture(points)), std::vector<double>{0}).front().front();
  EXPECT_NEAR(found.value, 0.2 + 0.625, found.error + 1e-12);
}

TEST(Mixture, RefusesOtherPoints) {
  const auto refused = [](const std::vector<CurvePoint>& points) {
    EXPECT_THROW((void)make_mixture(points), ArgumentError);
  };
  refused({{0.1, 1}});
  refused({{0, 1}, {0.5, 1}});
  refused({{0.1, 1}, {0.05, 1}});
  refused({{0.1, 1}, {0.1, 1}});
  refused({{0.1, 1}, {0.2, -1}});
  refused({{1e-4, 1}, {0.2, 1}});
  refused({{0.1, 0}, {0.2, 0}});
}

}  // namespace
}  // namespace lobe::test
