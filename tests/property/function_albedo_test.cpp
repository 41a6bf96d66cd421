// Albedos of reflectances that are functions: against those of formulas, and in closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "energy/albedo.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "support/device.hpp"
#include "support/estimates.hpp"
#include "support/functions.hpp"
#include "table/evaluate.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::Field;

constexpr std::array kIncidences{0.0, 30 * pi / 180, 60 * pi / 180, 80 * pi / 180, 89 * pi / 180};

/// \param largest_error relative, that the quadrature may state
void expect_that_of_the_formula(const std::string& text, double largest_error) {
  const Material material = parse_material(text);
  const auto expected = albedo(device(), material, kIncidences).front();
  const auto found = albedo(as_function(device(), material), kIncidences, 0.02).front();
  for (std::size_t k = 0; k < kIncidences.size(); ++k) {
    EXPECT_NEAR(found[k].value, expected[k].value, found[k].error + expected[k].error) << text << " " << k;
    EXPECT_LE(found[k].error, largest_error * expected[k].value) << text << " " << k;
  }
}

// What the quadrature is after, 2e-5, where the number of points that it may take allows it.
TEST(FunctionAlbedo, IsThatOfTheFormulaWithinItsError) {
  expect_that_of_the_formula("lambert:scale=0.5", 2e-5);
  expect_that_of_the_formula("phong:n=200", 1e-3);
  expect_that_of_the_formula("ggx:alpha=0.05", 1e-3);
  expect_that_of_the_formula("oren_nayar:sigma=0.5", 1e-3);
}

TEST(FunctionAlbedo, SeesBothSignsOfDeltaPhi) {
  const auto found = albedo(function_of([](const Directions& at) { return 1 + std::sin(at.delta_phi); }), kIncidences);
  EXPECT_THAT(found.front(), Each(EstimateCovers(pi, 1e-12)));
}

TEST(FunctionAlbedo, AtNormalIncidenceIsThatOfAllAzimuths) {
  const auto fan = function_of([](const Directions& at) { return 1 + std::cos(2 * at.delta_phi); });
  const std::array<double, 4> angles{0, 1e-12, 1e-8, 1e-6};
  const auto found = albedo(fan, angles).front();
  EXPECT_THAT(found, Each(EstimateCovers(pi, 1e-12)));
}

TEST(FunctionAlbedo, OfABrushedMaterialAtNormalIncidenceIsThatOfTheFormula) {
  expect_that_of_the_formula("ward_anisotropic:m_x=0.2,m_y=0.6", 1e-2);
}

TEST(FunctionAlbedo, HasTheIntegralOfTheFunctionsOwnErrors) {
  const auto found = albedo(function_of([](const Directions&) { return 1.0; }, 0.01), kIncidences);
  // That of the quadrature is added, which may end at a hundredth.
  EXPECT_THAT(found.front(), Each(Field(&Estimate::error, DoubleNear(0.01 * pi * 1.005, 0.01 * pi * 0.0051))));
}

TEST(FunctionAlbedo, SeesTheAzimuthOfTheLight) {
  auto brushed = function_of([](const Directions& at) { return 1 + std::cos(2 * at.phi_in); });
  brushed.is_isotropic = false;
  const std::array<Direction, 3> incident{{{0.5, 0}, {0.5, pi / 4}, {1, pi / 2}}};

  const auto found = albedo(brushed, incident).front();

  const std::array expected{2 * pi, pi, 0.0};
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(found[k].value, expected[k], found[k].error + 1e-12) << k;
}

/// \param largest_error relative, that the quadrature may state
void expect_mean_of_the_formula(const std::string& text, double largest_error) {
  const Material material = parse_material(text);
  const Estimate expected = mean_albedo(device(), material).front();
  const Estimate found = mean_albedo(as_function(device(), material), 0.2).front();
  EXPECT_NEAR(found.value, expected.value, found.error + expected.error) << text;
  EXPECT_LE(found.error, largest_error * expected.value) << text;
}

TEST(FunctionMeanAlbedo, IsThatOfTheFormulaWithinItsError) {
  expect_mean_of_the_formula("lambert:scale=0.5", 2e-4);
  expect_mean_of_the_formula("phong:n=20", 1e-2);
  expect_mean_of_the_formula("ward_anisotropic:m_x=0.3,m_y=0.5", 1e-2);
}

TEST(FunctionMeanAlbedo, HasTheMeanOfTheFunctionsOwnErrors) {
  const Estimate found = mean_albedo(function_of([](const Directions&) { return 1.0; }, 0.01)).front();
  EXPECT_NEAR(found.value, pi, found.error);
  EXPECT_NEAR(found.error, 0.01 * pi, 1e-3);
}

TEST(FunctionAlbedo, RefusesAnglesBelowTheHorizon) {
  const std::array<double, 1> angles{pi / 2};
  EXPECT_THROW((void)albedo(function_of([](const Directions&) { return 1.0; }), angles), ArgumentError);
}

TEST(FunctionAlbedo, RefusesValuesThatAreNoNumbers) {
  EXPECT_THROW((void)albedo(function_of([](const Directions&) { return std::nan(""); }), kIncidences), NumericError);
}

}  // namespace
}  // namespace lobe::test
