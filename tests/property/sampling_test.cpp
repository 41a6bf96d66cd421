// Directions are drawn with the density that is told, and their weights are unbiased: for every model at normal
// incidence, at 45 and at 89 degrees.
#include "lobe/sampling/sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hemisphere/gauss.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/sampling_cases.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using UnitVector = std::array<double, 3>;

constexpr std::array kAngles{0.0, pi / 4, 89 * pi / 180};

Direction light_at(double theta) {
  return {theta, 0.3};
}

UnitVector vector_of(Direction at) {
  return {std::sin(at.theta) * std::cos(at.phi), std::sin(at.theta) * std::sin(at.phi), std::cos(at.theta)};
}

/// Polar coordinates (radius, turn) in which a lobe is easy to integrate: about an axis, with the angle from it as the
/// radius; or in the base plane about the point that the axis is lifted from.
class Chart {
 public:
  Chart(const SamplingCase& sampled, Direction in) : is_plane_(sampled.is_in_plane), edge_(sampled.edge) {
    const UnitVector light = vector_of(in);
    axis_ = sampled.is_retro || sampled.name == "retro_patch" ? light : UnitVector{-light[0], -light[1], light[2]};
    // `up` is across the axis, in its plane with the normal, and points up.
    const double sine = std::hypot(axis_[0], axis_[1]);
    up_ = sine > 0 ? UnitVector{-axis_[0] / sine * axis_[2], -axis_[1] / sine * axis_[2], sine} : UnitVector{1, 0, 0};
    flat_ = sine > 0 ? UnitVector{-axis_[0] / sine, -axis_[1] / sine, 0} : UnitVector{1, 0, 0};
    side_ = {axis_[1] * up_[2] - axis_[2] * up_[1], axis_[2] * up_[0] - axis_[0] * up_[2],
             axis_[0] * up_[1] - axis_[1] * up_[0]};
    cross_ = {-flat_[1], flat_[0], 0};
  }

  [[nodiscard]] UnitVector at(double radius, double turn) const {
    if (is_plane_) {
      const double x = axis_[0] + radius * (std::cos(turn) * flat_[0] + std::sin(turn) * cross_[0]);
      const double y = axis_[1] + radius * (std::cos(turn) * flat_[1] + std::sin(turn) * cross_[1]);
      return {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
    }
    UnitVector v{};
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = std::cos(radius) * axis_[k] + std::sin(radius) * (std::cos(turn) * up_[k] + std::sin(turn) * side_[k]);
    }
    return v;
  }
  /// Solid angle by radius and turn.
  [[nodiscard]] double measure(double radius, const UnitVector& v) const {
    return is_plane_ ? radius / std::max(v[2], 1e-150) : std::sin(radius);
  }
  /// The radius at the horizon.
  [[nodiscard]] double horizon(double turn) const {
    if (is_plane_) {
      const double sine = std::hypot(axis_[0], axis_[1]);
      const double back = sine * std::cos(turn);  // the centre lies at -sine along flat
      return back + std::sqrt(std::max(0.0, back * back + axis_[2] * axis_[2]));
    }
    // cos(radius) A.N + sin(radius) cos(turn) up.N = 0
    const double radius = std::atan2(axis_[2], -std::cos(turn) * up_[2]);
    return radius > 0 ? radius : radius + pi;
  }
  [[nodiscard]] std::pair<double, double> place(const UnitVector& v) const {
    const auto dot = [&](const UnitVector& a) { return a[0] * v[0] + a[1] * v[1] + a[2] * v[2]; };
    if (is_plane_) {
      const UnitVector from{v[0] - axis_[0], v[1] - axis_[1], 0};
      const double along = from[0] * flat_[0] + from[1] * flat_[1];
      const double across = from[0] * cross_[0] + from[1] * cross_[1];
      return {std::hypot(along, across), std::atan2(across, along)};
    }
    const double along = dot(up_);
    const double across = dot(side_);
    return {std::atan2(std::hypot(along, across), dot(axis_)), std::atan2(across, along)};
  }
  [[nodiscard]] double end() const { return is_plane_ ? 2 : pi; }
  [[nodiscard]] double edge() const { return is_plane_ ? edge_ : 4; }

 private:
  bool is_plane_;
  double edge_;
  UnitVector axis_{}, up_{}, side_{}, flat_{}, cross_{};
};

constexpr int kTurns = 8;

/// Limits of bins along the radius: a few within the lobe, each twice as far as the last.
std::vector<double> radii_of(const SamplingCase& sampled, const Chart& chart) {
  std::vector<double> radii{0};
  for (double radius = sampled.width / 2; radius < chart.end(); radius *= 2) radii.push_back(radius);
  radii.push_back(chart.end());
  return radii;
}

struct Expected {
  std::vector<double> shares;  ///< by bin, [radius][turn]
  double total = 0;
};

/// The density integrated over bins with Gauss rules on panels that crowd where the horizon or a lobe over half-vectors
/// changes fast with the turn, and end on the horizon and on edges.
Expected expected_shares(const SamplingCase& sampled, Direction in, const Chart& chart,
                         const std::vector<double>& radii, int nodes) {
  constexpr std::array kBreaks{0.0, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.25, 0.5, 0.785398163397448279};
  std::vector<double> turns;
  for (int eighth = 0; eighth < kTurns; ++eighth) {
    for (std::size_t k = 0; k + 1 < kBreaks.size(); ++k) {
      const bool crowds_at_end = eighth % 2 == 1;
      turns.push_back(pi / 4 * eighth + (crowds_at_end ? pi / 4 - kBreaks[kBreaks.size() - 1 - k] : kBreaks[k]));
    }
  }
  turns.push_back(2 * pi);
  // Where the horizon cuts off an edge.
  for (std::size_t t = 0; t + 1 < turns.size(); ++t) {
    const auto is_cut = [&](double turn) { return chart.horizon(turn) < chart.edge(); };
    if (is_cut(turns[t]) == is_cut(turns[t + 1])) continue;
    double low = turns[t];
    double high = turns[t + 1];
    while (high - low > 1e-13)
      (is_cut(std::midpoint(low, high)) == is_cut(turns[t]) ? low : high) = std::midpoint(low, high);
    turns.insert(turns.begin() + static_cast<std::ptrdiff_t>(t) + 1, high);
    ++t;
  }
  const GaussRule rule = gauss_rule(nodes);
  std::vector<UnitVector> directions;
  std::vector<double> factors;
  std::vector<std::size_t> bins;
  for (std::size_t t = 0; t + 1 < turns.size(); ++t) {
    const auto eighth = static_cast<std::size_t>(std::midpoint(turns[t], turns[t + 1]) / (2 * pi) * kTurns);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double turn = std::lerp(turns[t], turns[t + 1], rule.nodes[i]);
      const double turn_weight = rule.weights[i] * (turns[t + 1] - turns[t]);
      const double horizon = std::min(chart.horizon(turn), chart.end());
      std::vector<double> limits = radii;
      for (double fine = sampled.width / 4; fine > sampled.width / 100; fine /= 2) limits.push_back(fine);
      for (const double limit : {horizon, horizon * 0.99, horizon * 0.9, horizon * 0.5, chart.edge()}) {
        limits.push_back(limit);
      }
      std::ranges::sort(limits);
      for (std::size_t r = 0; r + 1 < limits.size() && limits[r] < horizon; ++r) {
        const double middle = std::midpoint(limits[r], limits[r + 1]);
        const auto band = std::ranges::upper_bound(radii, middle) - radii.begin() - 1;
        for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
          // A square root at the horizon of the base plane is none in s, radius = end - (end - begin) s^2.
          const double s = rule.nodes[j];
          const double length = limits[r + 1] - limits[r];
          const double radius = limits[r + 1] - length * s * s;
          const UnitVector v = chart.at(radius, turn);
          directions.push_back(v);
          factors.push_back(turn_weight * rule.weights[j] * 2 * s * length * chart.measure(radius, v));
          bins.push_back(static_cast<std::size_t>(band) * kTurns + eighth);
        }
      }
    }
  }
  const Eigen::VectorXd densities = sampling_density(device(), sampled.material, in, directions);
  Expected expected{std::vector<double>((radii.size() - 1) * kTurns), 0};
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const double share = factors[k] * densities(static_cast<Eigen::Index>(k));
    expected.shares[bins[k]] += share;
    expected.total += share;
  }
  return expected;
}

/// Upper tail of the chi-squared distribution by Wilson and Hilferty (1931), to a few percent of the tail.
double chi_squared_tail(double statistic, double freedom) {
  const double spread = 2 / (9 * freedom);
  return std::erfc((std::cbrt(statistic / freedom) - (1 - spread)) / std::sqrt(2 * spread)) / 2;
}

class DrawnDirections : public ::testing::TestWithParam<SamplingCase> {};

TEST_P(DrawnDirections, HaveTheDensityThatIsTold) {
  constexpr std::size_t kSamples = 100'000;
  constexpr double kRare = 5;  // expected samples below which bins are pooled
  const double tests = static_cast<double>(kAngles.size() * sampling_cases().size());
  const double level = 1 - std::pow(1 - 0.01, 1 / tests);  // Sidak
  for (const double theta : kAngles) {
    SCOPED_TRACE(theta);
    const Direction in = light_at(theta);
    const Chart chart(GetParam(), in);
    const auto radii = radii_of(GetParam(), chart);
    const Expected expected = expected_shares(GetParam(), in, chart, radii, 8);
    const DirectionSamples samples = sample(device(), GetParam().material, in, kSamples);

    std::vector<double> counts(expected.shares.size());
    double lost = 0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      if (samples.kinds[i] == SampleKind::lost) {
        ++lost;
        continue;
      }
      const auto row = samples.directions.row(static_cast<Eigen::Index>(i));
      const auto [radius, turn] = chart.place({row(0), row(1), row(2)});
      const auto band = std::min<std::ptrdiff_t>(std::ranges::upper_bound(radii, radius) - radii.begin() - 1,
                                                 static_cast<std::ptrdiff_t>(radii.size()) - 2);
      const double positive = turn < 0 ? turn + 2 * pi : turn;
      const auto eighth = std::min(static_cast<std::size_t>(positive / (2 * pi) * kTurns), std::size_t{kTurns - 1});
      ++counts[static_cast<std::size_t>(band) * kTurns + eighth];
    }
    // What is lost is a bin, too: the density adds up to the rest.
    counts.push_back(lost);
    std::vector<double> shares = expected.shares;
    shares.push_back(std::max(0.0, 1 - expected.total));
    double statistic = 0;
    double freedom = -1;
    double pooled_count = 0;
    double pooled_share = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const double mean = kSamples * shares[k];
      if (mean < kRare) {
        pooled_count += counts[k];
        pooled_share += mean;
        continue;
      }
      statistic += (counts[k] - mean) * (counts[k] - mean) / mean;
      ++freedom;
    }
    if (pooled_share >= kRare) {
      statistic += (pooled_count - pooled_share) * (pooled_count - pooled_share) / pooled_share;
      ++freedom;
    } else {
      EXPECT_LE(pooled_count, 40) << "samples where the density is next to nothing, at " << theta * 180 / pi
                                  << " degrees";
    }
    ASSERT_GE(freedom, 3);
    EXPECT_GT(chi_squared_tail(statistic, freedom), level)
        << GetParam().name << " at " << theta * 180 / pi << " degrees: " << statistic << " for " << freedom
        << " degrees of freedom; the density adds up to " << expected.total << ", lost " << lost / kSamples;
    // The rule resolves the density.
    const Expected finer = expected_shares(GetParam(), in, chart, radii, 10);
    EXPECT_NEAR(expected.total, finer.total, 1e-4) << theta * 180 / pi << " degrees";
    // With what is lost it adds up to 1, within four standard errors of a count.
    EXPECT_NEAR(finer.total + lost / kSamples, 1,
                1e-4 + 4 * std::sqrt(finer.total * std::abs(1 - finer.total) / kSamples))
        << theta * 180 / pi << " degrees";
  }
}

TEST_P(DrawnDirections, HaveUnbiasedWeights) {
  constexpr std::size_t kSamples = 200'000;
  if (GetParam().name == "li_sparse") GTEST_SKIP() << "no quadrature reaches its albedo";
  for (const double theta : kAngles) {
    const Direction in = light_at(theta);
    const Estimate exact = albedo(device(), GetParam().material, {&in, 1}, {.tolerance = 1e-4}).at(0).at(0);

    const SampledAlbedo found = sampled_albedo(device(), GetParam().material, in, kSamples);

    EXPECT_NEAR(found.albedo.at(0).value, exact.value, 4 * found.albedo.at(0).error + exact.error)
        << theta * 180 / pi << " degrees";
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryModel, DrawnDirections, ::testing::ValuesIn(sampling_cases()), ByName());

TEST(SampledAlbedos, StateRoundingWhereWeightsDoNotVary) {
  double share = 0;
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    for (std::size_t k = 0; k < 40; ++k) {
      const double rho = 0.013 * static_cast<double>(k + 1);
      for (const bool has_mirror : {false, true}) {
        const std::string text = "lambert:scale=" + std::to_string(rho) + (has_mirror ? "+mirror:rho=0.3" : "");
        SCOPED_TRACE(text);
        const Estimate found =
            sampled_albedo(device(), parse_material(text), {.theta = 0.7}, 100, {.precision = precision})
                .albedo.front();
        const double expected = std::stod(std::to_string(rho)) + (has_mirror ? 0.3 : 0);
        EXPECT_LE(std::abs(found.value - expected), found.error);
        share = std::max(share, std::abs(found.value - expected) / found.error);
      }
    }
  }
  EXPECT_GT(share, 0.5);  // half the error would be too small
}

class SamplingPage : public ::testing::TestWithParam<std::string> {};

TEST_P(SamplingPage, HasARowForTheModel) {
  std::ifstream file(std::filesystem::path(LOBE_DOCS_DIR) / "sampling.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::string row = "\n| `" + GetParam();
  const bool is_there = page.find(row + ":") != std::string::npos || page.find(row + "`") != std::string::npos;
  EXPECT_TRUE(is_there) << "write the page anew: lobe sample --catalogue > docs/sampling.md";
}

std::vector<std::string> models_with_values() {
  std::vector<std::string> names;
  for (const Model& model : catalogue()) {
    if (!model.traits.has_delta) names.emplace_back(model.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(OfEveryModel, SamplingPage, ::testing::ValuesIn(models_with_values()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace lobe::test
