// Errors of formulas with jumps that no limit of a panel follows, more than eight of them or in azimuths about the
// normal: against closed forms over random thresholds and steps. The constants of these errors were chosen by 36 such
// formulas, and hold for others: LOBE_ATTACK_CASES and LOBE_ATTACK_SEED make it a longer or another attack.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "core/numbers.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/material.hpp"
#include "reference/quadrature.hpp"
#include "support/attack.hpp"
#include "support/device.hpp"
#include "support/random_materials.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

// Directions are points of the unit disc below, on which projected solid angles are areas.

/// The area of the unit disc with x > s.
double segment(double s) {
  if (s >= 1) return 0;
  if (s <= -1) return pi;
  return std::acos(s) - s * std::sqrt(1 - s * s);
}

/// The share of pairs of points of the disc that are nearer than r (Solomon 1978, Geometric probability).
double share_nearer(double r) {
  if (r >= 2) return 1;
  return 1 + 2 / pi * (r * r - 1) * std::acos(r / 2) - r / pi * (1 + r * r / 2) * std::sqrt(1 - r * r / 4);
}

/// The integral of g(x) over the disc, which jumps or has corners where x is one of `at`.
double over_disc(const std::function<double(double x)>& g, std::vector<double> at) {
  at.insert(at.end(), {-1, 1});
  std::erase_if(at, [](double x) { return x < -1 || x > 1; });
  std::ranges::sort(at);
  const auto in_angles = [&](double t) { return 2 * std::pow(std::cos(t), 2) * g(std::sin(t)); };
  double sum = 0;
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    const double from = std::asin(at[k]);
    const double to = std::asin(at[k + 1]);
    sum += static_cast<double>(
        reference::smooth_integral([&](reference::Real t) { return in_angles(static_cast<double>(t)); }, from, to));
  }
  return sum;
}

/// What is known of a formula f: integrals over one direction and over both.
struct Known {
  std::string text;
  double square = 0;          ///< of f^2 over both directions
  double square_of_mean = 0;  ///< of the square of the albedo over one direction
  double sum = 0;             ///< of f over both directions
};

/// The mean of a function with steps, and that of its square.
struct Steps {
  double mean = 0;
  double square = 0;
};

/// floor(n z) / n + base, z at least 0.
/// \param above the probability of z >= t
Steps steps_of(std::size_t n, double base, std::size_t most, const std::function<double(double)>& above) {
  Steps found{base, base * base};
  for (std::size_t k = 1; k <= most; ++k) {
    const double low = base + static_cast<double>(k - 1) / static_cast<double>(n);
    const double high = base + static_cast<double>(k) / static_cast<double>(n);
    const double p = above(static_cast<double>(k) / static_cast<double>(n));
    found.mean += (high - low) * p;
    found.square += (high * high - low * low) * p;
  }
  return found;
}

/// The product over both directions of p beyond a line, which is s from the middle and turned, and q before it.
Known half_planes(double turn, double s, double p, double q) {
  const auto one = [&](const char* side) {
    return fmt::format("where({0} * {2}_x + {1} * {2}_y > {3}, {4}, {5})", std::cos(turn), std::sin(turn), side, s, p,
                       q);
  };
  const double area = segment(s);
  const double mean = p * area + q * (pi - area);
  const double square = p * p * area + q * q * (pi - area);
  return {one("in") + " * " + one("out"), square * square, mean * mean * square, mean * mean};
}

/// p where the sum of both directions lies beyond a line, else q.
Known half_planes_of_sums(double turn, double s, double p, double q) {
  const std::vector<double> ends{s - 1, s + 1};
  const double both = over_disc([&](double x) { return segment(s - x); }, ends);
  Known known;
  known.text = fmt::format("where({0} * (in_x + out_x) + {1} * (in_y + out_y) > {2}, {3}, {4})", std::cos(turn),
                           std::sin(turn), s, p, q);
  known.square = p * p * both + q * q * (pi * pi - both);
  known.sum = p * both + q * (pi * pi - both);
  known.square_of_mean =
      over_disc([&](double x) { return std::pow(p * segment(s - x) + q * (pi - segment(s - x)), 2); }, ends);
  return known;
}

Known steps_of_distances(std::size_t n, double base) {
  const Steps steps = steps_of(n, base, 2 * n, [](double r) { return 1 - share_nearer(r); });
  return {fmt::format("floor({} * distance_p) / {} + {}", n, n, base), pi * pi * steps.square, kUnknown,
          pi * pi * steps.mean};
}

Known steps_of_cosines(std::size_t n, double base) {
  // Squares of cosines are uniform.
  const Steps steps = steps_of(n, base, n, [](double c) { return 1 - c * c + c * c * std::log(c * c); });
  Known known{fmt::format("floor({} * cos_i * cos_o) / {} + {}", n, n, base), pi * pi * steps.square, 0,
              pi * pi * steps.mean};
  const auto mean_at = [&](double v) {
    return steps_of(n, base, n, [&](double c) { return std::max(0.0, 1 - c * c / v); }).mean;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const auto square = [&](std::size_t i) { return std::pow(static_cast<double>(i) / static_cast<double>(n), 2); };
    known.square_of_mean +=
        pi * pi * pi *
        static_cast<double>(reference::smooth_integral(
            [&](reference::Real v) { return std::pow(mean_at(static_cast<double>(v)), 2); }, square(k), square(k + 1)));
  }
  return known;
}

Known steps_of_slopes(std::size_t n, double turn, double base) {
  const auto one = [&](const char* side) {
    return fmt::format("(floor({3} * (1 + {0} * {2}_x + {1} * {2}_y)) / {3} + {4})", std::cos(turn), std::sin(turn),
                       side, n, base);
  };
  const Steps steps = steps_of(n, base, 2 * n, [](double z) { return segment(z - 1) / pi; });
  const double square = pi * steps.square;
  const double mean = pi * steps.mean;
  return {one("in") + " * " + one("out"), square * square, mean * mean * square, mean * mean};
}

Known draw(Dice& dice) {
  const std::size_t kind = dice.below(5);
  const double turn = dice.uniform(0, 2 * pi);
  const double p = dice.uniform(0.1, 1);
  const double q = dice.uniform(0, 1);
  if (kind == 0) return half_planes(turn, dice.uniform(-0.8, 0.8), p, q);
  if (kind == 1) return half_planes_of_sums(turn, dice.uniform(-1.2, 1.2), p, q);
  if (kind == 2) return steps_of_distances(5 + dice.below(30), q);
  if (kind == 3) return steps_of_cosines(9 + dice.below(60), q);
  return steps_of_slopes(5 + dice.below(20), turn, q);
}

Reflectance material_of(const Known& known) {
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
  term.formula = Formula{.text = known.text, .parameters = {}};
  return Material{known.text, "", {term}};
}

Estimate square(const Known& known, const Lighting& lighting) {
  const Metric metric = measure(device(), {material_of(known)}, lighting).combined;
  return {metric.gram(0, 0), metric.gram_error(0, 0)};
}

Estimate stated_mean_albedo(const Known& known) {
  return mean_albedo(device(), material_of(known)).at(0);
}

double share_of_stated(const Estimate& found, double expected) {
  return std::abs(found.value - expected) / found.error;
}

TEST(HiddenJumps, AreWithinTheStatedErrors) {
  Dice dice(number_from("LOBE_ATTACK_SEED", 2));
  const std::size_t cases = number_from("LOBE_ATTACK_CASES", swept(36, 1));
  std::size_t count = 0;
  std::size_t above = 0;
  double worst = 0;
  const auto grade = [&](const Estimate& found, double expected, const std::string& what) {
    if (std::isnan(expected)) return;
    const double share = share_of_stated(found, expected);
    ++count;
    if (share > 1) ++above;
    worst = std::max(worst, share);
    if (share > 0.5) std::cout << share << " of " << found.error / expected << ": " << what << "\n";
    EXPECT_LE(share, 2) << what;
  };
  for (std::size_t k = 0; k < cases; ++k) {
    const Known known = draw(dice);
    grade(square(known, Lighting::point()), known.square, "point " + known.text);
    grade(square(known, Lighting::daylight()), known.square_of_mean, "daylight " + known.text);
    grade(square(known, Lighting::mean_albedo()), known.sum * known.sum, "mean-albedo " + known.text);
    grade(stated_mean_albedo(known), known.sum / pi, "mean albedo " + known.text);
  }
  std::cout << count << " numbers, " << above << " off by more than stated, the worst by " << worst << "\n";
  EXPECT_LE(100 * above, std::max<std::size_t>(count, 100));
}

// Of all that were tried, those that take the most of what is stated.

TEST(HiddenJumps, NeedThreeTimesTheChangeOfLevels) {
  const Known known = half_planes(std::atan2(0.34889793603922786, 0.9371607280651312), -0.4929553431839434,
                                  0.11102626172240185, 0.08457667351109266);
  const double share = share_of_stated(square(known, Lighting::mean_albedo()), known.sum * known.sum);
  EXPECT_LE(share, 1);
  EXPECT_GE(share, 0.65);
}

TEST(HiddenJumps, NeedMoreThanTheChangeOfLevels) {
  const Known known = steps_of_cosines(34, 0.5299373097384713);
  const Estimate found = square(known, Lighting::mean_albedo());
  EXPECT_LE(share_of_stated(found, known.sum * known.sum), 1);
  // Without the thousandth it would not hold.
  EXPECT_GE(std::abs(found.value - known.sum * known.sum), found.error - 1e-3 * found.value);
}

TEST(HiddenJumps, NeedTwoThousandthsOfMeanAlbedos) {
  const Known known = steps_of_slopes(5, std::atan2(-0.2075276155147575, 0.9782291596547095), 0.8921744660706223);
  const double share = share_of_stated(stated_mean_albedo(known), known.sum / pi);
  EXPECT_LE(share, 1);
  EXPECT_GE(share, 0.65);  // with one thousandth it would not hold
}

}  // namespace
}  // namespace lobe::test
