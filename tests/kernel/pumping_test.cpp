// Divisors of pumping-up on the device, in every panel of their curves, against the formulas on the host.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <utility>
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
FittedCurve fitted(const Function& albedo, double enough) {
  const auto values_at = [&](std::span<const double> angles) {
    std::vector<double> values;
    for (const double theta : angles) values.push_back(albedo(theta));
    return values;
  };
  return fit_curve(values_at, enough);
}

template <typename Function>
std::vector<double> curve_of(const Function& albedo) {
  return fitted(albedo, 1e-9).curve;
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
  const FittedCurve rough = fitted(kinked, 1);
  EXPECT_EQ(rough.curve.size(), kCurveNumbers);
  const double error = std::abs(curve_value(rough.curve, std::cos(0.9)) - 0.5);
  EXPECT_GT(rough.remainder, error / 10);
  EXPECT_LT(fitted(first_albedo, 1).remainder, 1e-10);
}

/// A root and a kink, as albedos have where maxima of albedos and cosines change sides.
double rooted(double theta) {
  return 0.5 + 0.1 * std::sqrt(std::max(theta - 0.7, 0.0)) + 0.1 * std::abs(std::cos(theta) - 0.1);
}

TEST(AlbedoCurve, HalvesPanelsTowardsKinks) {
  const FittedCurve found = fitted(rooted, 1e-6);
  EXPECT_LE(found.remainder, 1e-6);
  EXPECT_GT(parts_of(found.curve), 20);
  EXPECT_EQ(fault_of_curve(found.curve), "");
  for (int k = 0; k <= 20'000; ++k) {
    const double theta = pi / 2 * k / 20'001;
    ASSERT_NEAR(curve_value(found.curve, std::cos(theta)), rooted(theta), 2e-6) << theta;
  }
  for (const double theta : curve_angles(found.curve)) {
    ASSERT_NEAR(curve_value(found.curve, std::cos(theta)), rooted(theta), 1e-6) << theta;
  }
  EXPECT_EQ(fitted(first_albedo, 1e-6).curve.size(), kCurveNumbers);
}

// Every angle a kink: more parts than a curve may have.
TEST(AlbedoCurve, TellsThatPartsDoNotSuffice) {
  const FittedCurve found = fitted([](double theta) { return 1.5 + std::sin(1e5 * theta); }, 1e-6);
  EXPECT_GT(found.remainder, 1e-2);
  EXPECT_LE(parts_of(found.curve), kMostCurveParts);
}

TEST(AlbedoCurve, PartsThatAreNoneAreFaults) {
  const auto with_part = [](double from, double to) {
    auto curve = curve_of(first_albedo);
    curve.insert(curve.end(), {from, to});
    curve.insert(curve.end(), kCurveTerms, 0.5);
    return curve;
  };
  EXPECT_EQ(fault_of_curve(with_part(2, 3)), "");
  EXPECT_EQ(fault_of_curve(with_part(54.5, 55)), "");
  for (const auto& [from, to] : std::vector<std::pair<double, double>>{
           {-1, -0.5}, {0.5, 0.5}, {0.5, 0.25}, {0.5, 1.5}, {1.2, 1.4}, {56, 57}, {0, std::nan("")}}) {
    EXPECT_NE(fault_of_curve(with_part(from, to)), "") << from << " " << to;
  }
  auto twice = with_part(2, 2.5);
  const auto again = with_part(2.25, 3);
  twice.insert(twice.end(), again.end() - kPartNumbers, again.end());
  EXPECT_EQ(fault_of_curve(twice), "has a part 2 from 2.25 to 3; expected parts of one panel each, in rising order");
  EXPECT_EQ(fault_of_curve(std::vector<double>(kCurveNumbers + 1, 0.5)),
            "has 337 numbers; expected 336, or 14 more for each of at most 128 parts of panels");
}

/// Another place to have a root.
double dented(double theta) {
  return 0.7 - 0.2 * std::sqrt(std::abs(theta - 1.1));
}

using Albedo = double (*)(double);

double divisor(Correction correction, const std::vector<Albedo>& albedos, double theta_in, double theta_out) {
  double product = 1;
  for (const Albedo albedo : albedos) {
    const double larger = std::max(albedo(theta_in), albedo(theta_out));
    const double cosine = std::max(std::cos(theta_in), std::cos(theta_out));
    if (correction == Correction::g1) product *= larger;
    if (correction == Correction::g2) product *= std::max(larger, cosine);
    if (correction == Correction::controlled) product = std::max(product * larger, cosine);
    if (correction == Correction::complement) product /= (1 - albedo(theta_in)) * (1 - albedo(theta_out));
    if (correction == Correction::viewer) product *= albedo(theta_out);
  }
  return product;
}

Pumping pumping_by(Correction correction, const std::vector<Albedo>& albedos, double enough) {
  Pumping pumping{correction, {}};
  for (const Albedo albedo : albedos) pumping.albedos.push_back(fitted(albedo, enough).curve);
  return pumping;
}

class Divisor : public ::testing::TestWithParam<Correction> {
 protected:
  /// Curves are good to 1e-10, to 2e-6 at roots; a cosine in single precision tells angles near the normal to the root
  /// of its eps.
  static void expect_quotients(const Material& material, const std::function<double(double, double)>& expected,
                               double error) {
    std::vector<Directions> pairs;
    for (const double in : {0.0, 1e-4, 0.003, 0.1, 0.7, 1.2, 1.5, 1.57}) {
      for (const double out : {0.0, 0.01, 0.4, 0.9, 1.3, 1.55, 1.5707}) pairs.push_back({in, out, 1});
    }
    for (const double theta : {0.6999, 0.70001, 0.71, 0.78, 1.0999, 1.10001, 1.12, std::acos(0.1001)}) {
      pairs.push_back({theta, 0.3, 1});
      pairs.push_back({1.4, theta, 1});
    }
    for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
      const bool is_double = precision == Precision::double_precision;
      const double tolerance = is_double ? error : error + 2 * std::sqrt(kSingleEps);
      const auto values = evaluate(device(), material, pairs, precision);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double value = expected(pairs[i].theta_in, pairs[i].theta_out);
        EXPECT_NEAR(values(static_cast<Eigen::Index>(i), 0), value, tolerance * value)
            << pairs[i].theta_in << ", " << pairs[i].theta_out;
      }
    }
  }
};

TEST_P(Divisor, IsThatOfTheFormulas) {
  const std::vector<Albedo> albedos{first_albedo, second_albedo};
  Material material = make_material("lambert");
  material.terms[0].pumping = pumping_by(GetParam(), albedos, 1);
  const auto expected = [&](double in, double out) { return 1 / pi / divisor(GetParam(), albedos, in, out); };
  expect_quotients(material, expected, 1e-9);
}

// Two lobes in one kernel, each with its own parts.
TEST_P(Divisor, IsThatOfTheFormulasAtKinks) {
  const std::vector<Albedo> albedos{rooted, second_albedo};
  const std::vector<Albedo> others{second_albedo, dented};
  Material material = make_material("lambert");
  material.terms.push_back(material.terms.front());
  material.terms[0].pumping = pumping_by(GetParam(), albedos, 1e-6);
  material.terms[1].pumping = pumping_by(GetParam(), others, 1e-6);
  const auto expected = [&](double in, double out) {
    return (1 / divisor(GetParam(), albedos, in, out) + 1 / divisor(GetParam(), others, in, out)) / pi;
  };
  // 1 - a is less well known than a, by a / (1 - a), which is 9 at most here.
  expect_quotients(material, expected, GetParam() == Correction::complement ? 9 * 4e-6 : 4e-6);
}

TEST_P(Divisor, IsTheSameInTables) {
  Material material = make_material("phong", {{"n", 3}});
  const auto grid = HemisphereGrid::gauss(4, 8);
  TabulateOptions options;
  options.allow_unresolved = true;
  for (const Albedo first : {first_albedo, rooted}) {
    material.terms[0].pumping = pumping_by(GetParam(), {first, second_albedo}, 1e-6);
    const BrdfTable general = to_general(tabulate(device(), material, grid, options));
    const auto directions = grid.directions();
    for (std::size_t row = 0; row < directions.size(); ++row) {
      for (std::size_t column = 0; column < directions.size(); ++column) {
        const Direction& in = directions[row];
        const Direction& out = directions[column];
        const Directions pair{in.theta, out.theta, out.phi - in.phi};
        const double expected = evaluate(device(), material, {&pair, 1})(0, 0);
        EXPECT_NEAR(general.channel(0)[row * directions.size() + column], expected, 1e-12 * expected + 1e-15)
            << row << ' ' << column;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(pumping, Divisor,
                         ::testing::Values(Correction::g1, Correction::g2, Correction::controlled,
                                           Correction::complement, Correction::viewer),
                         [](const auto& instance) { return std::string(to_string(instance.param)); });

}  // namespace
}  // namespace lobe::test
