// Properties of approximations of materials.
#include "lobe/fit/approximation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/brdf_function.hpp"
#include "support/device.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

std::vector<Material> materials(const std::vector<std::string>& texts) {
  std::vector<Material> list;
  for (const auto& text : texts) list.push_back(parse_material(text));
  return list;
}

const std::vector<Material>& basis() {
  static const auto kBasis = materials({"lambert", "phong:n=5", "phong:n=40", "blinn:n=20"});
  return kBasis;
}

const Material& metal() {
  static const Material kMetal = parse_material("ward:m=0.25");
  return kMetal;
}

struct LightingCase {
  std::string name;
};

class Approximated : public ::testing::TestWithParam<LightingCase> {
 protected:
  static Lighting lighting() { return parse_lighting(GetParam().name); }
};

TEST_P(Approximated, LeavesARestAtRightAngles) {
  const auto result = approximate(device(), metal(), basis(), lighting());

  // The same lobes at the same nodes: what does not add up is rounding.
  const auto measured = measure(device(), std::vector{metal(), result.material}, lighting()).combined;
  const double whole = measured.gram(0, 0);
  const double rest = measured.distance(0, 1) * measured.distance(0, 1);
  EXPECT_NEAR(measured.gram(1, 1) + rest, whole, 1e-10 * whole);
  EXPECT_NEAR(result.residual.value, measured.distance(0, 1), 1e-12 * std::sqrt(whole));
  EXPECT_LE(result.fits.at(0).kkt_residual, 1e-10);
}

TEST_P(Approximated, InTheSpanLeavesAllButNothing) {
  const auto target = parse_material("lambert:scale=0.3+phong:n=40,scale=0.25+blinn:n=20,scale=0.1");

  const auto result = approximate(device(), target, basis(), lighting());

  EXPECT_NEAR(result.fits[0].coefficients(0), 0.3, 1e-9);
  EXPECT_NEAR(result.fits[0].coefficients(1), 0, 1e-9);
  EXPECT_NEAR(result.fits[0].coefficients(2), 0.25, 1e-9);
  // The same lobes: the difference is in their weights. From products alone it would be 1e-8.
  EXPECT_LE(result.relative_residual.value, 1e-10);
  // The residual is that of these coefficients, which solve G x = b but for an ulp of each of the terms in a row: they
  // leave sqrt(r' G^-1 r) for r = G x - b.
  const double rounded = static_cast<double>(basis().size()) * std::numeric_limits<double>::epsilon();
  const double solved = rounded * std::sqrt(result.fits[0].condition) * result.target_norm.value;
  EXPECT_LE(result.residual.value, result.residual.error + solved);
}

TEST_P(Approximated, GrowsWithItsTarget) {
  const auto bright = parse_material("ward:m=0.25,scale=3");

  const auto result = approximate(device(), metal(), basis(), lighting());
  const auto scaled = approximate(device(), bright, basis(), lighting());

  const Eigen::VectorXd difference = scaled.fits[0].coefficients - 3 * result.fits[0].coefficients;
  EXPECT_LE(difference.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(scaled.residual.value, 3 * result.residual.value, 1e-9);
}

TEST_P(Approximated, IsNoBetterWithConstraints) {
  ApproximationOptions options;
  const double free = approximate(device(), metal(), basis(), lighting(), options).residual.value;
  options.form.non_negative = true;
  const double positive = approximate(device(), metal(), basis(), lighting(), options).residual.value;
  options.form.energy = true;
  const double bounded = approximate(device(), metal(), basis(), lighting(), options).residual.value;

  EXPECT_LE(free, positive * (1 + 1e-9));
  EXPECT_LE(positive, bounded * (1 + 1e-9));
}

INSTANTIATE_TEST_SUITE_P(Lighting, Approximated, ::testing::Values(LightingCase{"point"}, LightingCase{"daylight"}),
                         ByName{});

TEST(Approximation, WithinTheEnergyBalanceReflectsNoMoreThanItGets) {
  ApproximationOptions options;
  options.form = {.non_negative = true, .energy = true};
  const auto bright = parse_material("ward:m=0.25,scale=4");

  const auto result = approximate(device(), bright, basis(), Lighting::point(), options);

  EXPECT_TRUE(result.fits[0].at_energy_bound);
  EXPECT_NEAR(result.fits[0].energy, 1, 1e-9);
  std::vector<double> angles;
  for (int degree = 0; degree < 90; degree += 3) angles.push_back(degree * kDegree);
  const auto albedos = albedo(device(), result.material, angles);
  for (const auto& [value, error] : albedos[0]) EXPECT_LE(value, 1 + error);
}

TEST(Approximation, OfSeveralTargetsIsThatOfEach) {
  const auto targets = materials({"ward:m=0.25", "cook_torrance:m=0.3"});

  const auto both = approximate(device(), targets, basis(), Lighting::point());

  ASSERT_EQ(both.size(), 2U);
  const auto second = approximate(device(), targets[1], basis(), Lighting::point());
  // Other nodes, as other lobes are there.
  EXPECT_NEAR(both[1].residual.value, second.residual.value, both[1].residual.error + second.residual.error);
  EXPECT_EQ(both[1].material.name, "approximation of cook_torrance:m=0.3");
}

/// In the span of those that follow, and not.
const std::vector<Material>& targets_to_measure() {
  static const auto kTargets = materials({"lambert:scale=0.3+phong:n=40,scale=0.25", "ward:m=0.25"});
  return kTargets;
}

const std::vector<Material>& small_basis() {
  static const auto kBasis = materials({"lambert", "phong:n=40"});
  return kBasis;
}

/// \param largest_error that coefficients may state
void expect_what_formulas_give(const Approximation& found, const Material& target, const Lighting& lighting,
                               double largest_error) {
  const auto expected = approximate(device(), target, small_basis(), lighting);
  for (Eigen::Index i = 0; i < found.fits[0].coefficients.size(); ++i) {
    const double error = found.fits[0].coefficients_error(i) + expected.fits[0].coefficients_error(i);
    EXPECT_NEAR(found.fits[0].coefficients(i), expected.fits[0].coefficients(i), error) << i;
    EXPECT_LE(error, largest_error) << i;
  }
  const auto measured = measure(device(), std::vector{target, found.material}, lighting).combined;
  EXPECT_NEAR(found.target_norm.value, measured.norm(0), found.target_norm.error + measured.norm_error(0));
  EXPECT_NEAR(found.residual.value, measured.distance(0, 1), found.residual.error + measured.distance_error(0, 1));
}

TEST_P(Approximated, AsAFunctionIsWhatItsFormulaIs) {
  for (const auto& target : targets_to_measure()) {
    SCOPED_TRACE(target.name);
    const auto found = approximate(device(), as_function(device(), target), small_basis(), lighting());

    expect_what_formulas_give(found, target, lighting(), 0.01);
  }
}

TEST_P(Approximated, AsATableIsWhatItsFormulaIs) {
  const auto grid = HemisphereGrid::gauss(48, 96);
  for (const auto& target : targets_to_measure()) {
    SCOPED_TRACE(target.name);
    const auto found = approximate(device(), tabulate(device(), target, grid), small_basis(), lighting());

    expect_what_formulas_give(found, target, lighting(), 0.1);
  }
}

TEST_P(Approximated, AsATableIsTheTabulatedFormulaItself) {
  const auto table = tabulate(device(), metal(), HemisphereGrid::gauss(32, 64));
  const auto alone = approximate(device(), table, std::vector{metal()}, lighting());

  // The same numbers: what is left is rounding.
  EXPECT_NEAR(alone.fits[0].coefficients(0), 1, 1e-12);
  EXPECT_LE(alone.relative_residual.value, 1e-10);
}

/// \param basis what stands for the small basis
void expect_what_formulas_of_the_basis_give(const ReflectanceList& basis, const Lighting& lighting,
                                            double largest_error) {
  for (const auto& target : targets_to_measure()) {
    SCOPED_TRACE(target.name);
    const auto found = approximate(device(), target, basis, lighting);
    const auto expected = approximate(device(), target, small_basis(), lighting);

    for (Eigen::Index i = 0; i < found.fits[0].coefficients.size(); ++i) {
      const double error = found.fits[0].coefficients_error(i) + expected.fits[0].coefficients_error(i);
      EXPECT_NEAR(found.fits[0].coefficients(i), expected.fits[0].coefficients(i), error) << i;
      EXPECT_LE(error, largest_error) << i;
    }
    EXPECT_NEAR(found.residual.value, expected.residual.value, found.residual.error + expected.residual.error);
    EXPECT_EQ(found.combination.formula(), nullptr);
    EXPECT_TRUE(found.material.terms.empty());
  }
}

TEST_P(Approximated, ByAFunctionIsWhatItsFormulaGives) {
  const ReflectanceList mixed{small_basis()[0], as_function(device(), small_basis()[1])};

  // Products within the basis are of functions, too: 2e-4 in them become a hundred times that in coefficients.
  expect_what_formulas_of_the_basis_give(mixed, lighting(), 0.03);
}

TEST_P(Approximated, ByATableIsWhatItsFormulaGives) {
  const ReflectanceList mixed{small_basis()[0], tabulate(device(), small_basis()[1], HemisphereGrid::gauss(48, 96))};

  expect_what_formulas_of_the_basis_give(mixed, lighting(), 0.1);
}

/// Two channels of a table whose combination differs by channel.
TEST(Approximation, ByTablesIsTheirSumChannelByChannel) {
  const auto grid = HemisphereGrid::gauss(16, 32);
  const auto first = tabulate(device(), parse_material("phong:n=5"), grid);
  const auto second = tabulate(device(), parse_material("lambert"), grid);
  const auto target = parse_material("lambert:scale=0.3/0.6+phong:n=5,scale=0.5/0.1");

  const auto found = approximate(device(), target, {first, second}, Lighting::point());

  ASSERT_EQ(found.fits.size(), 2U);
  EXPECT_NEAR(found.fits[0].coefficients(0), 0.5, 1e-9);
  EXPECT_NEAR(found.fits[0].coefficients(1), 0.3, 1e-9);
  EXPECT_NEAR(found.fits[1].coefficients(0), 0.1, 1e-9);
  EXPECT_NEAR(found.fits[1].coefficients(1), 0.6, 1e-9);
  ASSERT_NE(found.combination.table(), nullptr);
  const BrdfTable& sum = *found.combination.table();
  ASSERT_EQ(sum.channels, 2U);
  const auto expected = tabulate(device(), target, grid);
  for (std::size_t at = 0; at < sum.values.size(); at += 97) {
    EXPECT_NEAR(sum.values[at], expected.values[at], 1e-9) << at;
  }
}

/// What is stated is the distance to the function that it returns.
TEST(Approximation, ByFunctionsIsAsFarAsItsCombination) {
  const ReflectanceList mixed{as_function(device(), parse_material("phong:n=5")),
                              as_function(device(), parse_material("ward:m=0.4"))};
  const auto target = parse_material("lambert:scale=0.2/0.5+cook_torrance:m=0.4,scale=0.6/0.2");

  const auto found = approximate(device(), target, mixed, Lighting::point());

  const auto measured = measure(device(), {target, found.combination}, Lighting::point()).combined;
  EXPECT_NEAR(found.residual.value, measured.distance(0, 1), found.residual.error + measured.distance_error(0, 1));
  EXPECT_GT(found.residual.value, 10 * found.residual.error);
}

/// A reflectance whose formulas have to be prepared, against the same one prepared.
TEST(Approximation, ByAPumpedFormulaIsThatOfItsPumpedValues) {
  const auto pumped = parse_material("phong:n=10@pump:times=2");
  const ReflectanceList prepared{*adjusted(device(), pumped).formula()};

  const auto found = approximate(device(), metal(), {pumped}, Lighting::point());
  const auto expected = approximate(device(), metal(), prepared, Lighting::point());

  EXPECT_EQ(found.fits[0].coefficients(0), expected.fits[0].coefficients(0));
  EXPECT_NEAR(found.relative_residual.value, expected.relative_residual.value, 1e-12);
  const double norm = measure(device(), {metal()}, Lighting::point()).combined.norm(0);
  EXPECT_LT(found.residual.value, norm);
}

TEST(GreedyBasis, ChoosesTheTableThatTheTargetIs) {
  const auto table = tabulate(device(), metal(), HemisphereGrid::gauss(32, 64));

  const auto found = greedy_basis(device(), metal(), {parse_material("lambert"), table}, 1, Lighting::point());

  ASSERT_EQ(found.steps.size(), 1U);
  EXPECT_EQ(found.steps[0].chosen, 1U);
  EXPECT_NEAR(found.approximation.fits[0].coefficients(0), 1, 1e-9);
}

TEST(Approximation, OfAFunctionWithChannelsIsThatOfEachChannel) {
  const auto target = parse_material("lambert:scale=0.3/0.6+phong:n=40,scale=0.5/0");
  ApproximationOptions options;
  options.form.non_negative = true;

  const auto found = approximate(device(), as_function(device(), target), basis(), Lighting::daylight(), options);
  const auto greedy = greedy_basis(device(), as_function(device(), target), basis(), 2, Lighting::point(), options);

  ASSERT_EQ(found.fits.size(), 2U);
  EXPECT_NEAR(found.fits[1].coefficients(0), 0.6, found.fits[1].coefficients_error(0));
  EXPECT_LE(found.relative_residual.value, found.relative_residual.error);
  ASSERT_EQ(greedy.steps.size(), 2U);
  EXPECT_EQ(greedy.steps[0].chosen, 2U);
  EXPECT_EQ(greedy.steps[1].chosen, 0U);
}

/// A paint in two channels, of which the second has no highlight.
Material paint() {
  return {"paint", "paints", {{"lambert", {}, {0.3, 0.6}}, {"phong", {40}, {0.5, 0}}}};
}

TEST(ApproximationOfChannels, HasCoefficientsOfItsOwnInEachByDefault) {
  const auto result = approximate(device(), paint(), basis(), Lighting::point());

  ASSERT_EQ(result.fits.size(), 2U);
  EXPECT_NEAR(result.fits[0].coefficients(2), 0.5, 1e-9);
  EXPECT_NEAR(result.fits[1].coefficients(0), 0.6, 1e-9);
  EXPECT_EQ(result.material.channels(), 2U);
  EXPECT_LE(result.relative_residual.value, 1e-10);
}

TEST(ApproximationOfChannels, CanHaveTheSameInAll) {
  ApproximationOptions options;
  options.channels = ChannelCoefficients::common;

  const auto result = approximate(device(), paint(), basis(), Lighting::point(), options);

  ASSERT_EQ(result.fits.size(), 1U);
  // The mean of the channels is the best that one grey combination can be.
  EXPECT_NEAR(result.fits[0].coefficients(0), 0.45, 1e-9);
  EXPECT_NEAR(result.fits[0].coefficients(2), 0.25, 1e-9);
  EXPECT_EQ(result.material.channels(), 1U);
}

TEST(ApproximationOfChannels, WeighsThemAsAsked) {
  ApproximationOptions options;
  options.channels = ChannelCoefficients::common;
  options.metric.channel_weights = {0.75, 0.25};

  const auto result = approximate(device(), paint(), basis(), Lighting::point(), options);

  EXPECT_NEAR(result.fits[0].coefficients(0), 0.75 * 0.3 + 0.25 * 0.6, 1e-9);
}

TEST(ApproximationOfChannels, MayMeetABlackOne) {
  const Material red{"red", "paints", {{"lambert", {}, {0.5, 0}}}};

  const auto result = approximate(device(), red, basis(), Lighting::point());

  ASSERT_EQ(result.fits.size(), 2U);
  EXPECT_EQ(result.fits[1].coefficients, Eigen::VectorXd(Eigen::VectorXd::Zero(4)));
  EXPECT_EQ(result.fits[1].relative_residual.value, 0);
  EXPECT_LE(result.relative_residual.value, 1e-10);
}

TEST(Approximation, RefusesABlackTarget) {
  EXPECT_THROW((void)approximate(device(), parse_material("lambert:scale=0"), basis(), Lighting::point()),
               NumericError);
}

TEST(ApproximationByDependentMaterials, NamesThem) {
  auto twice = basis();
  twice.push_back(parse_material("phong:n=5,scale=0.5"));

  try {
    (void)approximate(device(), metal(), twice, Lighting::point());
    FAIL() << "no error";
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'phong:n=5,scale=0.5' depends on the others"));
  }
}

TEST(ApproximationByDependentMaterials, IsAsGoodAsWithoutThem) {
  auto twice = basis();
  twice.push_back(parse_material("phong:n=5,scale=0.5"));
  ApproximationOptions options;
  options.form.allow_dependent = true;

  const auto result = approximate(device(), metal(), twice, Lighting::point(), options);

  EXPECT_NEAR(result.residual.value, approximate(device(), metal(), basis(), Lighting::point()).residual.value, 1e-9);
  EXPECT_EQ(result.fits[0].rank, 4);
}

TEST(GreedyBasis, FindsTheMaterialsThatATargetIsMadeOf) {
  const auto candidates = materials({"phong:n=5", "phong:n=10", "phong:n=20", "lambert", "ward:m=0.1", "blinn:n=50"});
  const auto target = parse_material("ward:m=0.1,scale=0.5+lambert:scale=0.4");

  const auto greedy = greedy_basis(device(), target, candidates, 4, Lighting::point());

  ASSERT_EQ(greedy.steps.size(), 2U);
  EXPECT_EQ(greedy.steps[0].chosen, 4U);
  EXPECT_EQ(greedy.steps[1].chosen, 3U);
  EXPECT_LE(greedy.approximation.relative_residual.value, 1e-10);
  EXPECT_GT(greedy.steps[0].relative_residual.value, 0.01);
}

TEST(LinearCombination, LeavesOutWhatHasNoShare) {
  const std::vector<Eigen::VectorXd> coefficients{Eigen::VectorXd{{0.5, 0, 0, 2}}};

  const auto sum = linear_combination(basis(), coefficients, "sum");

  ASSERT_EQ(sum.terms.size(), 2U);
  EXPECT_EQ(sum.terms[0].model, "lambert");
  EXPECT_EQ(sum.terms[1].weight, std::vector{2.0});
}

TEST(LinearCombination, IsBlackRatherThanEmpty) {
  const std::vector<Eigen::VectorXd> coefficients{Eigen::VectorXd::Zero(4)};

  const auto sum = linear_combination(basis(), coefficients, "black");

  ASSERT_FALSE(sum.terms.empty());
  EXPECT_THAT(sum.terms, ::testing::Each(::testing::Field(&Term::weight, ::testing::ElementsAre(0.0))));
}

TEST(LinearCombination, RefusesNumbersThatDoNotFit) {
  const std::vector<Eigen::VectorXd> few{Eigen::VectorXd::Zero(3)};
  EXPECT_THROW((void)linear_combination(basis(), few, ""), ArgumentError);
  EXPECT_THROW((void)linear_combination(basis(), {}, ""), ArgumentError);
  const std::vector<Eigen::VectorXd> three(3, Eigen::VectorXd::Ones(1));
  EXPECT_THROW((void)linear_combination(std::vector{paint()}, three, ""), ArgumentError);
}

TEST(Approximation, RefusesAnEmptyBasis) {
  EXPECT_THROW((void)approximate(device(), metal(), std::vector<Material>{}, Lighting::point()), ArgumentError);
  EXPECT_THROW((void)approximate(device(), std::vector<Material>{}, basis(), Lighting::point()), ArgumentError);
}

TEST(LargestAlbedo, OfLambertIsOneEverywhere) {
  const auto peak = largest_albedo(device(), parse_material("lambert:scale=0.5")).at(0);

  EXPECT_NEAR(peak.albedo.value, 0.5, peak.albedo.error + 1e-12);
}

TEST(LargestAlbedo, OfMetalPhongIsAboveOneWhereTheLiteratureSaysSo) {
  // Overshoot 2.886e-4 at 12.91 degrees for n = 1 (reference/errata.md, 3.6-3.11).
  const auto peak = largest_albedo(device(), parse_material("metal_phong:n=1")).at(0);

  EXPECT_NEAR(peak.albedo.value, 1.0002886, 1e-6);
  EXPECT_NEAR(peak.theta / kDegree, 12.91, 0.5);
}

TEST(LargestAlbedo, IsFoundInEveryChannel) {
  const auto peaks = largest_albedo(device(), paint());

  ASSERT_EQ(peaks.size(), 2U);
  EXPECT_NEAR(peaks[0].albedo.value, 0.8, 1e-5);
  EXPECT_NEAR(peaks[1].albedo.value, 0.6, 1e-6);
}

TEST(LargestAlbedo, RefusesAnglesBelowTheHorizon) {
  EXPECT_THROW((void)largest_albedo(device(), metal(), 2), ArgumentError);
  EXPECT_THROW((void)largest_albedo(device(), metal(), 0), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
