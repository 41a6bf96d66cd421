// Albedos of reflectances that are functions: against those of formulas, and in closed form.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "lobe/energy.hpp"
#include "lobe/error.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

constexpr std::array kAngles{0.0, 30 * pi / 180, 60 * pi / 180, 80 * pi / 180, 89 * pi / 180};

BrdfFunction function_of(double (*formula)(const Directions&), double error = 0) {
  BrdfFunction brdf;
  brdf.name = "formula";
  brdf.channels = {"value"};
  brdf.at = [formula, error](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t i = 0; i < pairs.size(); ++i) values.value(static_cast<Eigen::Index>(i), 0) = formula(pairs[i]);
    if (error > 0) values.error = Eigen::MatrixXd::Constant(values.value.rows(), 1, error);
    return values;
  };
  return brdf;
}

/// \param largest_error relative, that the quadrature may state
void expect_that_of_the_formula(const std::string& text, double largest_error) {
  const Material material = parse_material(text);
  const auto expected = albedo(device(), material, kAngles).front();
  const auto found = albedo(as_function(device(), material), kAngles, 0.02).front();
  for (std::size_t k = 0; k < kAngles.size(); ++k) {
    EXPECT_NEAR(found[k].value, expected[k].value, found[k].error + expected[k].error) << text << " " << k;
    EXPECT_LE(found[k].error, largest_error * expected[k].value) << text << " " << k;
  }
}

// How far the coarser of two levels is off, three times, measured.
TEST(FunctionAlbedo, IsThatOfTheFormulaWithinItsError) {
  expect_that_of_the_formula("lambert:scale=0.5", 1e-5);
  expect_that_of_the_formula("phong:n=200", 1e-3);
  expect_that_of_the_formula("ggx:alpha=0.05", 1e-3);
  expect_that_of_the_formula("oren_nayar:sigma=0.5", 1e-3);
}

TEST(FunctionAlbedo, SeesBothSignsOfDeltaPhi) {
  const auto found = albedo(function_of([](const Directions& at) { return 1 + std::sin(at.delta_phi); }), kAngles);
  for (const Estimate& value : found.front()) EXPECT_NEAR(value.value, pi, value.error + 1e-12);
}

TEST(FunctionAlbedo, HasTheIntegralOfTheFunctionsOwnErrors) {
  const auto found = albedo(function_of([](const Directions&) { return 1.0; }, 0.01), kAngles);
  for (const Estimate& value : found.front()) EXPECT_NEAR(value.error, 0.01 * pi, 1e-5);
}

TEST(FunctionAlbedo, RefusesAnglesBelowTheHorizon) {
  const std::array angles{pi / 2};
  EXPECT_THROW((void)albedo(function_of([](const Directions&) { return 1.0; }), angles), ArgumentError);
}

TEST(FunctionAlbedo, RefusesValuesThatAreNoNumbers) {
  EXPECT_THROW((void)albedo(function_of([](const Directions&) { return std::nan(""); }), kAngles), NumericError);
}

}  // namespace
}  // namespace lobe::test
