// Formulas that jump: what is stated of their products and albedos, against closed forms, and against sums over
// lattices of points that know nothing of where they jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/material.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

Material jumping(const std::string& text) {
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
  term.formula = Formula{.text = text, .parameters = {}};
  return {text, "", {term}};
}

/// A pair by the names that formulas give its quantities.
struct JumpPair {
  JumpPair(double sin2_i, double sin2_o, double phi_i, double phi_o)
      : cos_i(std::sqrt(1 - sin2_i)),
        cos_o(std::sqrt(1 - sin2_o)),
        in_x(std::sqrt(sin2_i) * std::cos(phi_i)),
        in_y(std::sqrt(sin2_i) * std::sin(phi_i)),
        out_x(std::sqrt(sin2_o) * std::cos(phi_o)),
        out_y(std::sqrt(sin2_o) * std::sin(phi_o)),
        cos_lv(cos_i * cos_o + in_x * out_x + in_y * out_y),
        cos_rv(cos_i * cos_o - in_x * out_x - in_y * out_y),
        cos_d(std::sqrt((1 + cos_lv) / 2)),
        cos_h((cos_i + cos_o) / (2 * cos_d)),
        half_x((in_x + out_x) / (2 * cos_d)),
        half_y((in_y + out_y) / (2 * cos_d)) {}
  double cos_i, cos_o, in_x, in_y, out_x, out_y, cos_lv, cos_rv, cos_d, cos_h, half_x, half_y;
};

struct JumpCase {
  std::string text;
  std::function<double(const JumpPair&)> value;
};

const std::vector<JumpCase>& isotropic_jumps() {
  using P = const JumpPair&;
  static const std::vector<JumpCase> kCases{
      {"where(cos_h > 0.95, 1, 0)", [](P p) { return p.cos_h > 0.95 ? 1.0 : 0.0; }},
      {"where(cos_h > 0.8, where(cos_d > 0.7, 2, 1), 0.1)",
       [](P p) { return p.cos_h > 0.8 ? (p.cos_d > 0.7 ? 2.0 : 1.0) : 0.1; }},
      {"step(0.9, cos_h) * exp(20 * log_rv) + 0.1",
       [](P p) { return (p.cos_h >= 0.9 ? std::pow(std::max(0.0, p.cos_rv), 20) : 0) + 0.1; }},
      {"0.1 + 0.2 * floor(4 * cos_h)", [](P p) { return 0.1 + 0.2 * std::floor(4 * std::min(1.0, p.cos_h)); }},
      {"fabs(cos_h - 0.8) + sqrt(fmax(0, cos_lv - 0.2))",
       [](P p) { return std::abs(p.cos_h - 0.8) + std::sqrt(std::max(0.0, p.cos_lv - 0.2)); }},
      {"where(fabs(cos_lv - 0.1) < 0.3, 1, 0)", [](P p) { return std::abs(p.cos_lv - 0.1) < 0.3 ? 1.0 : 0.0; }},
  };
  return kCases;
}

/// A mean over lattices of points that are moved, and four standard deviations of it.
struct Settled {
  double value = 0;
  double error = 0;
};

/// \param mean by how far points are moved
Settled over_moves(const std::function<double(double move)>& mean) {
  constexpr int kMoves = 6;
  constexpr double kDeviations = 4;
  std::array<double, kMoves> values{};
  Settled all;
  for (int k = 0; k < kMoves; ++k) {
    values.at(static_cast<std::size_t>(k)) = mean(0.1371 * k);
    all.value += values.at(static_cast<std::size_t>(k)) / kMoves;
  }
  double squares = 0;
  for (const double value : values) squares += (value - all.value) * (value - all.value);
  all.error = kDeviations * std::sqrt(squares / (kMoves * (kMoves - 1)));
  return all;
}

double fraction(double x) {
  return x - std::floor(x);
}

/// The mean of a function of f over all pairs by projected solid angles, which are areas of the base plane.
Settled mean_over_pairs(const JumpCase& c, const std::function<double(double)>& of_value) {
  constexpr int kPoints = 1 << 17;
  return over_moves([&](double move) {
    double sum = 0;
    for (int k = 0; k < kPoints; ++k) {
      // An additive recurrence, by powers of the root of x^5 = x + 1.
      const auto at = [&](double step) { return fraction(move + step * (k + 0.5)); };
      sum += of_value(c.value({at(0.8566748838545029), at(0.733891856627126), 2 * pi * at(0.6287067210378087),
                               2 * pi * at(0.5385972572236101)}));
    }
    return sum / kPoints;
  });
}

/// The albedo at an angle of incidence and azimuth 0.
Settled lattice_albedo(const JumpCase& c, double theta) {
  constexpr int kPoints = 1 << 15;
  const double sine2 = std::pow(std::sin(theta), 2);
  return over_moves([&](double move) {
    double sum = 0;
    for (int k = 0; k < kPoints; ++k) {
      const auto at = [&](double step) { return fraction(move + step * (k + 0.5)); };
      sum += c.value({sine2, at(0.7548776662466927), 0, 2 * pi * at(0.5698402909980532)});
    }
    return pi * sum / kPoints;
  });
}

/// The lattice must be good enough to see what levels had agreed on: 1e-2.
void expect_within(const Estimate& found, const Settled& expected, const std::string& what) {
  EXPECT_LE(std::abs(found.value - expected.value), found.error + expected.error) << what;
  EXPECT_LE(expected.error, 1e-2 * std::abs(expected.value)) << what;
}

void expect_stated_norm(const JumpCase& c, double largest_error) {
  const Metric point = measure(device(), {Reflectance(jumping(c.text))}, Lighting::point()).combined;
  const Settled squares = mean_over_pairs(c, [](double f) { return f * f; });
  expect_within({point.gram(0, 0), point.gram_error(0, 0)}, {pi * pi * squares.value, pi * pi * squares.error},
                c.text + " point");
  EXPECT_LE(point.gram_error(0, 0), largest_error * point.gram(0, 0)) << c.text;
}

void expect_stated_albedos(const JumpCase& c) {
  const Reflectance material = jumping(c.text);
  const Estimate mean = mean_albedo(device(), material).at(0);
  const Settled values = mean_over_pairs(c, [](double f) { return f; });
  expect_within(mean, {pi * values.value, pi * values.error}, c.text + " mean albedo");
  const std::vector<double> angles{0.7};
  expect_within(albedo(device(), material, angles).at(0).at(0), lattice_albedo(c, angles.front()), c.text + " albedo");
}

// What lobe stated before it knew where formulas jump: 1e-8 where 1e-2 was missing.
TEST(FormulaJump, IsWithinTheStatedErrorsOfIsotropicFormulas) {
  for (const JumpCase& c : isotropic_jumps()) {
    expect_stated_norm(c, 1e-6);
    expect_stated_albedos(c);
  }
}

// Twenty steps have no limits of their own.
TEST(FormulaJump, IsWithinTheStatedErrorsOfManySteps) {
  const JumpCase steps{"floor(20 * cos_h) / 20",
                       [](const JumpPair& p) { return std::floor(20 * std::min(1.0, p.cos_h)) / 20; }};
  expect_stated_norm(steps, 0.02);
}

// Azimuths about the normal have steps of their own, whatever jumps between them.
TEST(FormulaJump, IsWithinTheStatedErrorsOfAnisotropicFormulas) {
  const JumpCase turned{"where(in_x > 0.2, 1, 0.5) * where(out_x > 0.2, 1, 0.5)",
                        [](const JumpPair& p) { return (p.in_x > 0.2 ? 1.0 : 0.5) * (p.out_x > 0.2 ? 1.0 : 0.5); }};
  expect_stated_norm(turned, 0.1);
}

// Projected solid angles are areas of the unit disc.
TEST(FormulaJump, OfCosinesHasItsClosedFormsUnderAllLightings) {
  const double area = pi * (1 - 0.36);
  const Reflectance material = jumping("where(cos_i > 0.6 && cos_o > 0.6, 1, 0)");

  const auto square = [&](const Lighting& lighting) {
    const Metric metric = measure(device(), {material}, lighting).combined;
    return Estimate{metric.gram(0, 0), metric.gram_error(0, 0)};
  };

  const Estimate point = square(Lighting::point());
  const Estimate daylight = square(Lighting::daylight());
  const Estimate mean = square(Lighting::mean_albedo());
  EXPECT_NEAR(point.value, area * area, point.error);
  EXPECT_NEAR(daylight.value, area * area * area, daylight.error);
  EXPECT_NEAR(mean.value, area * area * area * area, mean.error);
  // As exact as of what is smooth: limits of panels lie on the jumps.
  for (const Estimate& one : {point, daylight, mean}) EXPECT_LE(one.error, 1e-6 * one.value) << one.value;
}

// Distances of points of the unit disc are below R with the probability
// 1 + (2/pi) (R^2 - 1) acos(R/2) - (R/pi) (1 + R^2/2) sqrt(1 - R^2/4) (Solomon 1978, Geometric probability).
TEST(FormulaJump, OfDistancesInTheBasePlaneHasItsClosedForm) {
  for (const double r : {0.2, 0.7, 1.3}) {
    const double share =
        1 + 2 / pi * (r * r - 1) * std::acos(r / 2) - r / pi * (1 + r * r / 2) * std::sqrt(1 - r * r / 4);
    const Reflectance material = jumping("where(distance_p < " + std::to_string(r) + ", 1, 0)");

    const Metric point = measure(device(), {material}, Lighting::point()).combined;

    EXPECT_NEAR(point.gram(0, 0), pi * pi * share, point.gram_error(0, 0)) << r;
    EXPECT_LE(point.gram_error(0, 0), 1e-6 * point.gram(0, 0)) << r;
  }
}

TEST(FormulaJump, HasDistancesWithinTheirErrors) {
  // |f - g|^2 is what lies between both thresholds.
  const Reflectance f = jumping("where(cos_i * cos_o > 0.4, 1, 0)");
  const Reflectance g = jumping("where(cos_i * cos_o > 0.5, 1, 0)");
  // With u = cos^2, uniform, the share of u v > c^2 is 1 - c^2 + c^2 ln c^2.
  const auto share = [](double c2) { return 1 - c2 + c2 * std::log(c2); };

  const Estimate found = distance(device(), f, g, Lighting::point());

  EXPECT_NEAR(found.value, pi * std::sqrt(share(0.16) - share(0.25)), found.error);
  EXPECT_LE(found.error, 1e-5 * found.value);
}

}  // namespace
}  // namespace lobe::test
