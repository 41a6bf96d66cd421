#include "model/draw.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

namespace lobe::test {
namespace {

/// Radii, shares of the directions within them, and values of a table of n radii.
struct Columns {
  std::vector<double> radii, shares, values;
};
Columns columns_of(const NumberTable& table) {
  const auto third = static_cast<std::ptrdiff_t>(table->size() / 3);
  return {{table->begin(), table->begin() + third},
          {table->begin() + third, table->begin() + 2 * third},
          {table->begin() + 2 * third, table->end()}};
}

bool rises(const std::vector<double>& numbers) {
  return std::ranges::adjacent_find(numbers, std::ranges::greater_equal{}) == numbers.end();
}

TEST(MixtureTables, HasRisingRadiiThatCrowdTowardsOne) {
  for (const double scale : {1e-6, 0.01, 0.3, 5.0}) {
    const auto [radii, shares, values] =
        columns_of(draw::mixture_table([](double distance) { return std::exp(-distance); }, scale));
    EXPECT_TRUE(rises(radii)) << scale;
    EXPECT_EQ(radii.front(), 0) << scale;
    EXPECT_EQ(radii.back(), 2) << scale;
    const auto one = std::ranges::find(radii, 1.0);
    ASSERT_NE(one, radii.end()) << scale;
    EXPECT_GT(*(one - 1), 1 - 1e-10) << scale;
    EXPECT_LE(radii[1], 1e-3 * std::min(scale, 1.0) * 1.0001) << scale;
  }
}

TEST(MixtureTables, EndsWhereTheProfileDoes) {
  constexpr double kInner = 0.3;
  constexpr double kRadius = 0.7;
  const auto profile = [](double m) { return std::clamp((kRadius - m) / (kRadius - kInner), 0.0, 1.0); };
  const auto [radii, shares, values] = columns_of(draw::bounded_table(profile, kInner, kRadius));
  EXPECT_TRUE(rises(radii));
  const auto edge = std::ranges::find(radii, kRadius);
  ASSERT_NE(edge, radii.end());
  ASSERT_NE(std::ranges::find(radii, kInner), radii.end());
  const auto at = static_cast<std::size_t>(edge - radii.begin());
  EXPECT_NEAR(shares[at], 1, 1e-14);
  EXPECT_GT(values[at - 1], 0);
  EXPECT_EQ(values[at], 0);
  // Density at the centre of a cone's frustum: 1 over pi (r^2 + r R + R^2) / 3.
  const double volume = std::numbers::pi * (kInner * kInner + kInner * kRadius + kRadius * kRadius) / 3;
  EXPECT_NEAR(values.front(), 1 / volume, 1e-13 / volume);
}

TEST(KnownTables, KeepsTheLastTablesByTheirParameters) {
  draw::KnownTables tables;
  int made = 0;
  const auto ask = [&](double a, double b) {
    const auto make = [&] {
      ++made;
      return std::make_shared<const std::vector<double>>(std::vector{a, b});
    };
    const NumberTable table = tables.table(std::array{a, b}, make);
    EXPECT_EQ(*table, (std::vector{a, b}));
  };
  for (int round = 0; round < 3; ++round) {
    for (double a = 0; a < 3; ++a) {
      ask(a, 1);
      ask(a, 2);
    }
  }
  EXPECT_EQ(made, 6);
  // More than are kept.
  for (int round = 0; round < 2; ++round) {
    for (double a = 0; a < 100; ++a) ask(a, 3);
  }
  EXPECT_EQ(made, 206);
  ask(99, 3);
  EXPECT_EQ(made, 206);
}

TEST(KnownTables, AreNotThoseOfOtherProfiles) {
  const auto twice =
      draw::known_table(std::array{2.0}, [] { return draw::mixture_table([](double) { return 1.0; }, 1); });
  const auto other = draw::known_table(
      std::array{2.0}, [] { return draw::mixture_table([](double distance) { return std::exp(-2 * distance); }, 1); });
  EXPECT_NE(*twice, *other);
}

}  // namespace
}  // namespace lobe::test
