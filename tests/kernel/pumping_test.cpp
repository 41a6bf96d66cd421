// Divisors of pumping-up on the device, in every panel of their curves, against the formulas on the host.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "device/lobe_batch.hpp"
#include "hemisphere/albedo_curve.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/table.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/error_budget.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

/// Albedos that are no series of the curves themselves; the second one falls, the first one does not.
double first_albedo(double theta) {
  return 0.5 + 0.3 * std::sin(2 * theta);
}
double second_albedo(double theta) {
  return 0.4 + 0.5 * std::cos(theta) / (1 + theta);
}

template <typename Function>
std::vector<double> curve_of(const Function& albedo) {
  std::vector<double> values;
  for (const double theta : curve_angles()) values.push_back(albedo(theta));
  return curve_through(values);
}

TEST(AlbedoCurve, IsTheFunctionAtEveryAngle) {
  const auto curve = curve_of(second_albedo);
  EXPECT_EQ(curve.size(), kCurveNumbers);
  for (const double degrees : {0.0, 1e-3, 0.1, 0.2, 0.3, 1.0, 7.0, 30.0, 59.9, 60.0, 60.1, 80.0, 89.0, 89.9, 89.9999}) {
    const double theta = degrees * pi / 180;
    EXPECT_NEAR(curve_value(curve, std::cos(theta)), second_albedo(theta), 1e-10) << degrees;
  }
  EXPECT_NEAR(curve_value(curve, 1e-9), second_albedo(pi / 2), 1e-6);  // constant beyond the last panel
}

TEST(AlbedoCurve, TellsWhatItLeavesOut) {
  const auto kinked = [](double theta) { return 0.5 + 0.1 * std::abs(theta - 0.9); };
  std::vector<double> values;
  for (const double theta : curve_angles()) values.push_back(kinked(theta));
  const auto curve = curve_through(values);
  const double error = std::abs(curve_value(curve, std::cos(0.9)) - 0.5);
  EXPECT_GT(curve_remainder(curve, values), error / 10);
  EXPECT_LT(curve_remainder(curve_of(first_albedo), values), 1e-10);
}

double divisor(Correction correction, double theta_in, double theta_out) {
  double product = 1;
  for (const auto albedo : {first_albedo, second_albedo}) {
    const double larger = std::max(albedo(theta_in), albedo(theta_out));
    const double cosine = std::max(std::cos(theta_in), std::cos(theta_out));
    if (correction == Correction::g1) product *= larger;
    if (correction == Correction::g2) product *= std::max(larger, cosine);
    if (correction == Correction::controlled) product = std::max(product * larger, cosine);
  }
  return product;
}

class Divisor : public ::testing::TestWithParam<Correction> {};

TEST_P(Divisor, IsThatOfTheFormulas) {
  Material material = make_material("lambert");
  material.terms[0].pumping = Pumping{GetParam(), {curve_of(first_albedo), curve_of(second_albedo)}};
  std::vector<Directions> pairs;
  for (const double in : {0.0, 1e-4, 0.003, 0.1, 0.7, 1.2, 1.5, 1.57}) {
    for (const double out : {0.0, 0.01, 0.4, 0.9, 1.3, 1.55, 1.5707}) pairs.push_back({in, out, 1});
  }
  for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
    const bool is_double = precision == Precision::double_precision;
    // Curves are good to 1e-10; a cosine in single precision tells angles near the normal to the root of its eps.
    const double tolerance = is_double ? 1e-9 : 2 * std::sqrt(kSingleEps);
    const auto values = evaluate(device(), material, pairs, precision);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double expected = 1 / pi / divisor(GetParam(), pairs[i].theta_in, pairs[i].theta_out);
      EXPECT_NEAR(values(static_cast<Eigen::Index>(i), 0), expected, tolerance * expected)
          << pairs[i].theta_in << ", " << pairs[i].theta_out;
    }
  }
}

TEST_P(Divisor, IsTheSameInTables) {
  Material material = make_material("phong", {{"n", 3}});
  material.terms[0].pumping = Pumping{GetParam(), {curve_of(first_albedo), curve_of(second_albedo)}};
  const auto grid = HemisphereGrid::gauss(4, 8);
  TabulateOptions options;
  options.allow_unresolved = true;
  const BrdfTable general = to_general(tabulate(device(), material, grid, options));
  const auto directions = grid.directions();
  for (std::size_t row = 0; row < directions.size(); ++row) {
    for (std::size_t column = 0; column < directions.size(); ++column) {
      const Direction& in = directions[row];
      const Direction& out = directions[column];
      const Directions pair{in.theta, out.theta, out.phi - in.phi};
      const double expected = evaluate(device(), material, {&pair, 1})(0, 0);
      EXPECT_NEAR(general.channel(0)[row * directions.size() + column], expected, 1e-12 * expected + 1e-15);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(pumping, Divisor, ::testing::Values(Correction::g1, Correction::g2, Correction::controlled),
                         [](const auto& instance) { return std::string(to_string(instance.param)); });

}  // namespace
}  // namespace lobe::test
