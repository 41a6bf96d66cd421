#include "device/tabulate_patch_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/device.hpp"

namespace lobe::test {
namespace {

struct Disc {
  double x, y, radius;
};

/// The area common to discs, by strips: in each the intervals of y meet.
double common_area(const std::vector<Disc>& discs) {
  constexpr int kStrips = 100'000;
  double left = -2;
  double right = 2;
  for (const Disc& disc : discs) {
    left = std::max(left, disc.x - disc.radius);
    right = std::min(right, disc.x + disc.radius);
  }
  const double width = (right - left) / kStrips;
  double area = 0;
  for (int k = 0; k < kStrips && right > left; ++k) {
    const double x = left + (k + 0.5) * width;
    double low = -10;
    double high = 10;
    for (const Disc& disc : discs) {
      const double half = std::sqrt(std::max(disc.radius * disc.radius - (x - disc.x) * (x - disc.x), 0.0));
      low = std::max(low, disc.y - half);
      high = std::min(high, disc.y + half);
    }
    area += std::max(high - low, 0.0) * width;
  }
  return area;
}

TEST(PatchLight, IsTheAreaCommonToTwoDiscsAndTheUnitDisc) {
  const std::vector<LightDisc> discs{{0.4, 2.5}, {1.3, 0.7}};
  DiscPoints p;
  // More than a pack, not a multiple of one; the centre, the rim, and points in all directions.
  for (int i = 0; i < 11; ++i) p.push(i == 0 ? 0 : 0.1 * i - 0.05, std::numbers::pi * i / 10);
  p.push(1, 0.3);
  DiscPoints q;
  for (const auto& [radius, angle] :
       {std::pair{0.7, 1.0}, {0.0, 0.0}, {0.0, 1.0}, {0.5, 0.2}, {0.95, 2.0}, {1.0, std::numbers::pi}}) {
    q.push(radius, angle);
  }
  PatchLight light(device(), discs);
  light.place(p, q);
  constexpr std::size_t kFirst = 1;
  const std::size_t count = q.size() - kFirst;
  std::vector<double> values(count * light.stride(), -1);
  light.tabulate(kFirst, count, values);

  const auto disc = [](const DiscPoints& points, std::size_t i, double radius) {
    return Disc{points.radius[i] * std::cos(points.angle[i]), points.radius[i] * std::sin(points.angle[i]), radius};
  };
  double largest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      double expected = 0;
      for (const auto& [radius, factor] : discs) {
        expected += factor * common_area({disc(p, i, radius), disc(q, kFirst + k, radius), {0, 0, 1}});
      }
      largest = std::max(largest, expected);
      // That of the strips, whose ends are square roots.
      EXPECT_NEAR(values[k * light.stride() + i], expected, 1e-6) << i << " " << k;
    }
  }
  EXPECT_GT(largest, 1);
}

}  // namespace
}  // namespace lobe::test
