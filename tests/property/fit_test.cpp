// Properties of fits: they find what is known to be there, and are no worse than looking everywhere.
#include "lobe/fit/fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "compare/comparison_routes.hpp"
#include "fit/fit_target.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/study/study.hpp"
#include "lobe/table/brdf_function.hpp"
#include "metric/routes.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

// What a search is content with in units of its axes.
constexpr double kSearched = 1e-6;

const Material& metal_to_fit() {
  static const Material kMetal = parse_material("cook_torrance:m=0.3");
  return kMetal;
}

double value_of(const FitResult& result, const std::string& label) {
  const auto found = std::ranges::find(result.values, label, &FittedValue::label);
  EXPECT_NE(found, result.values.end()) << label;
  return found == result.values.end() ? std::numeric_limits<double>::quiet_NaN() : found->value;
}

/// The least of a function over equal steps, and where it is.
struct Scan {
  double least = std::numeric_limits<double>::infinity();
  double at = 0;
};
template <typename Function>
Scan scan(double from, double to, int steps, Function function) {
  Scan result;
  for (int i = 0; i <= steps; ++i) {
    const double x = from + (to - from) * i / steps;
    const double value = function(x);
    if (value < result.least) result = {value, x};
  }
  return result;
}

class Recovered : public ::testing::TestWithParam<std::string> {};

TEST_P(Recovered, IsAMemberOfTheFamily) {
  const auto target = parse_material("lambert:scale=0.3+ward:m=0.17,scale=0.4");
  FitOptions options;
  options.lighting = parse_lighting(GetParam());

  const auto result = fit(device(), target, parse_family("lambert+ward"), options);

  EXPECT_NEAR(value_of(result, "m"), 0.17, kSearched);
  EXPECT_NEAR(value_of(result, "1.scale"), 0.3, kSearched);
  EXPECT_NEAR(value_of(result, "2.scale"), 0.4, kSearched);
  EXPECT_LE(result.relative_residual.value, kSearched);
  EXPECT_TRUE(result.converged);
  for (const auto& value : result.values) EXPECT_EQ(value.channel, std::nullopt) << value.label;  // there is one only
}

INSTANTIATE_TEST_SUITE_P(Fit, Recovered, ::testing::Values("point", "daylight"),
                         [](const auto& instance) { return instance.param; });

TEST(Fit, TellsTwoLobesOfOneModelApart) {
  const auto target = parse_material("ward:m=0.05,scale=0.3+ward:m=0.4,scale=0.4+lambert:scale=0.1");

  const auto result = fit(device(), target, parse_family("lambert+ward+ward"));

  EXPECT_NEAR(std::min(value_of(result, "2.m"), value_of(result, "3.m")), 0.05, kSearched);
  EXPECT_NEAR(std::max(value_of(result, "2.m"), value_of(result, "3.m")), 0.4, kSearched);
}

TEST(Fit, FindsScalesPerChannelAndOneShape) {
  const auto target = parse_material("lambert:scale=0.3/0.2/0.1+ward:m=0.07,scale=0.4/0.5/0");

  const auto result = fit(device(), target, parse_family("lambert+ward"));

  ASSERT_THAT(result.values, SizeIs(7));
  EXPECT_NEAR(result.values[1].value, 0.2, kSearched);
  EXPECT_EQ(result.values[1].channel, 1U);
  EXPECT_EQ(result.values[5].value, 0);
  EXPECT_TRUE(result.values[5].at_bound);
  EXPECT_NEAR(value_of(result, "m"), 0.07, kSearched);
}

TEST(Fit, OfASpecificationIsReadBackToTheLastBit) {
  FitOptions options;
  options.starts = {{{"alpha", 0.3}}};

  const auto result = fit(device(), metal_to_fit(), parse_family("lambert+ggx*lacquer:s=0.01"), options);

  const auto again = parse_material(result.material.name);

  EXPECT_EQ(distance(device(), again, result.material, Lighting::point()).value, 0);
  EXPECT_EQ(distance(device(), again, metal_to_fit(), Lighting::point()).value, result.residual.value);
}

TEST(Fit, IsTheLeastDistanceThatAScanFinds) {
  constexpr int kSteps = 60;
  std::vector<Material> members;
  const auto distance_at = [&](double m) {
    const auto shape = make_material("ward", {{"m", m}});
    const auto gram = measure(device(), std::vector{metal_to_fit(), shape}, Lighting::point()).combined.gram;
    return std::sqrt(gram(0, 0) - gram(0, 1) * gram(0, 1) / gram(1, 1));
  };
  const Scan least = scan(0.25, 0.4, kSteps, distance_at);

  const auto result = fit(device(), metal_to_fit(), parse_family("ward"));

  EXPECT_LE(result.residual.value, least.least + result.residual.error);
  EXPECT_NEAR(value_of(result, "m"), least.at, 0.15 / kSteps);
  EXPECT_NEAR(distance_at(value_of(result, "m")), result.residual.value, 1e-5 * result.residual.value);
}

TEST(Fit, ByALogarithmIsTheLeastThatAScanFinds) {
  constexpr int kSteps = 15;
  const LiteratureMetric comparison = LiteratureMetric::bieron_log;
  const auto distance_at = [&](double m) {
    const auto member = make_material("ward", {{"m", m}});
    return compare(device(), std::vector{metal_to_fit(), member}, comparison).combined.distance(0, 1);
  };
  const Scan least = scan(0.15, 0.45, kSteps, distance_at);
  FitOptions options;
  options.objective = FitObjective::log;
  options.metric = comparison;
  options.searches = 1;

  const auto result = fit(device(), metal_to_fit(), parse_family("ward:scale=1"), options);

  EXPECT_LE(result.residual.value, least.least + result.residual.error);
  EXPECT_NEAR(value_of(result, "m"), least.at, 0.3 / kSteps);
}

TEST(Fit, IsAsNearAsThePublishedOne) {
  const Study study = load_study(LOBE_STUDIES_DIR "/merl-fits.toml");
  const auto published = [&](const std::string& name) {
    return *std::ranges::find(study.materials, name, &StudyMaterial::name)->formula();
  };
  const Material target = published("Cook-Torrance blue-metallic-paint");
  const auto other = distance(device(), target, published("Ward blue-metallic-paint"), Lighting::point());

  const auto result = fit(device(), target, parse_family("lambert+ward"));

  EXPECT_LT(result.residual.value, other.value);
  EXPECT_TRUE(result.converged);
}

TEST(Fit, HasAStandardErrorThatDoublesTheSquaredResidual) {
  // So small a rest that the bowl is a parabola as far as that.
  const auto target = parse_material("ward:m=0.3+lambert:scale=0.02");
  const auto result = fit(device(), target, parse_family("ward"));
  const FittedValue m = result.values.back();

  const auto moved = parse_family("ward:m=" + std::to_string(m.value + m.standard_error));
  const auto further = fit(device(), target, moved);

  const double ratio = further.residual.value / result.residual.value;
  EXPECT_NEAR(ratio * ratio, 2, 0.1);
}

TEST(Fit, SaysWhichParameterIsAtItsBound) {
  FitOptions options;
  options.ranges = {{"m", 0.01, 0.1}};

  const auto result = fit(device(), parse_material("ward:m=0.2"), parse_family("ward"), options);

  EXPECT_TRUE(result.values.back().at_bound);
  EXPECT_EQ(result.values.back().value, 0.1);
}

TEST(Fit, SaysWhatTheTargetDoesNotDetermine) {
  FitOptions options;
  options.lighting = Lighting::mean_albedo();

  const auto result = fit(device(), metal_to_fit(), parse_family("lambert+phong"), options);

  EXPECT_LE(result.relative_residual.value, kSearched);
  EXPECT_TRUE(std::ranges::any_of(
      result.values, [](const FittedValue& value) { return value.at_bound || std::isinf(value.standard_error); }));
}

TEST(Fit, StartsWhereItIsTold) {
  FitOptions options;
  options.starts = {{{"m", 0.2}}};

  const auto result = fit(device(), metal_to_fit(), parse_family("ward"), options);

  EXPECT_EQ(result.starting_points, 1U);
  EXPECT_NEAR(value_of(result, "m"), value_of(fit(device(), metal_to_fit(), parse_family("ward")), "m"), 1e-5);
}

TEST(Fit, OfATableRecoversWhatWasTabulated) {
  const auto table =
      tabulate(device(), parse_material("lambert:scale=0.3+ward:m=0.3,scale=0.4"), HemisphereGrid::gauss(16, 32));
  FitOptions options;
  options.searches = 1;

  const auto result = fit(device(), table, parse_family("lambert+ward"), options);

  EXPECT_NEAR(value_of(result, "m"), 0.3, kSearched);
  EXPECT_NEAR(value_of(result, "2.scale"), 0.4, kSearched);
}

TEST(Fit, OfAFunctionRecoversItsFormula) {
  const auto function = as_function(device(), parse_material("lambert:scale=0.3+ward:m=0.3,scale=0.4"));
  FitOptions options;
  options.starts = {{{"m", 0.28}}};

  const auto result = fit(device(), function, parse_family("lambert+ward"), options);

  EXPECT_NEAR(value_of(result, "m"), 0.3, kSearched);
  EXPECT_NEAR(value_of(result, "2.scale"), 0.4, kSearched);
  EXPECT_LE(result.relative_residual.value, result.relative_residual.error);
}

// By the table that a caller would make of it, to the last bit.
TEST(Fit, OfAFunctionTakesATableWhereItNeedsOne) {
  const auto function = as_function(device(), parse_material("phong:n=3,scale=0.7"));
  const auto table = tabulate(function, natural_grid(function));
  FitOptions options;
  options.searches = 1;
  options.tolerance = 0.01;
  options.starts = {{{"n", 3}}};
  EXPECT_EQ(fit(device(), function, parse_family("phong"), options).route, Route::functions);
  options.objective = FitObjective::log;

  const FitResult found = fit(device(), function, parse_family("phong"), options);

  EXPECT_EQ(found.route, Route::tables);
  ASSERT_TRUE(found.grid.has_value());
  EXPECT_EQ(found.grid->name(), "gauss:64x128");
  EXPECT_FALSE(found.is_coarse);
  EXPECT_EQ(found.residual.value, fit(device(), table, parse_family("phong"), options).residual.value);
}

/// Members around a point as searches ask for them: steps of scales and of the shape.
const std::vector<Material>& members_around_a_point() {
  static const std::vector<Material> kMembers{parse_material("lambert:scale=0.3+phong:n=5,scale=0.4"),
                                              parse_material("lambert:scale=0.31+phong:n=5,scale=0.4"),
                                              parse_material("lambert:scale=0.3+phong:n=5,scale=0.39"),
                                              parse_material("lambert:scale=0.3+phong:n=5.01,scale=0.4")};
  return kMembers;
}

/// Searches take products of sums from those of terms: against those of the members themselves.
/// \param rounding relative to the norm of the target
void expect_products_of_members(const FitTarget& target, const Metric& expected, double rounding) {
  const Metric found = target.products(members_around_a_point(), 1e-6).combined;
  const double norm = expected.norm(0);
  EXPECT_LE((found.gram - expected.gram).cwiseAbs().maxCoeff(), rounding * norm * norm);
  for (Eigen::Index i = 0; i < expected.distance.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      // Of a squared distance rounding is relative to the squared norm.
      const double error = rounding * norm * norm / std::max(expected.distance(i, j), std::sqrt(rounding) * norm);
      EXPECT_NEAR(found.distance(i, j), expected.distance(i, j), error) << i << ", " << j;
    }
  }
}

class ProductsOfMembers : public ::testing::TestWithParam<std::pair<std::string, double>> {};

TEST_P(ProductsOfMembers, AreThoseOfTheirTablesBesideATable) {
  const auto& [name, rounding] = GetParam();
  const HemisphereGrid grid = HemisphereGrid::parse(name);
  const BrdfTable table = tabulate(device(), parse_material("lambert:scale=0.2/0.3+phong:n=3,scale=0.5"), grid);
  const FitOptions options;

  std::vector<BrdfTable> all{table};
  for (const Material& member : members_around_a_point()) all.push_back(tabulate(device(), member, grid));
  std::vector<const BrdfTable*> pointers;
  for (const BrdfTable& one : all) pointers.push_back(&one);
  const auto measured = measure_tables(device(), pointers, Lighting::point(), {});

  expect_products_of_members(fit_target(device(), table, options, {}), measured.combined, rounding);
}

// Averages over cells of members and of their terms are refined one without the other, to 1e-5.
INSTANTIATE_TEST_SUITE_P(Fit, ProductsOfMembers,
                         ::testing::Values(std::pair("gauss:16x32", 1e-12), std::pair("klems:145", 1e-5)),
                         [](const auto& test) { return test.param.first.substr(0, 5); });

class ProductsBesideAFunction : public ::testing::TestWithParam<std::string> {};

TEST_P(ProductsBesideAFunction, AreThoseOfTheMembers) {
  const BrdfFunction function = as_function(device(), parse_material(GetParam()));
  FitOptions options;
  options.theta_max = 80 * kDegree;
  options.channel_weights.assign(function.channels.size(), 4);
  std::vector<BrdfFunction> all{function};
  for (const Material& member : members_around_a_point()) all.push_back(as_function(device(), member));

  const auto measured =
      measure_functions(all, Lighting::point(),
                        {.tolerance = 0.1, .channel_weights = options.channel_weights, .theta_max = options.theta_max});

  expect_products_of_members(fit_target(device(), function, options, {}), measured.combined, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Fit, ProductsBesideAFunction,
                         ::testing::Values("phong:n=3,scale=0.5", "phong:n=3,scale=0.5/0.4/0.1"),
                         [](const auto& test) { return test.index == 0 ? "OneChannel" : "ThreeChannels"; });

TEST(Fit, ComparesMembersBesideATable) {
  const HemisphereGrid grid = HemisphereGrid::gauss(16, 32);
  const BrdfTable table = tabulate(device(), parse_material("lambert:scale=0.2+phong:n=3,scale=0.5"), grid);
  FitOptions options;
  options.objective = FitObjective::log;
  std::vector<Material> members = members_around_a_point();
  members.push_back(parse_material("lambert:scale=0+phong:n=3,scale=0"));
  std::vector<BrdfTable> all{table};
  for (const Material& member : members) all.push_back(tabulate(device(), member, grid));
  std::vector<const BrdfTable*> pointers;
  for (const BrdfTable& one : all) pointers.push_back(&one);
  const auto expected = compare_tables(pointers, options.metric, {.tolerance = 1e-3}).combined;

  const auto found = fit_target(device(), table, options, {}).compared(members, 1e-3);

  EXPECT_LE((found.distance - expected.distance).cwiseAbs().maxCoeff(), 1e-12 * found.target_norm.value);
}

TEST(Fit, SaysWhichGridWouldResolveTheFamily) {
  const auto table = tabulate(device(), parse_material("phong:n=3"), HemisphereGrid::gauss(16, 32));
  FitOptions options;
  options.ranges = {{"n", 1e5, 1e6}};
  try {
    (void)fit(device(), table, parse_family("phong"), options);
    FAIL() << "fitted";
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("it needs "));
  }
}

// Sums over nodes take one order of directions for functions that are reciprocal.
TEST(AsFunction, SaysWhetherAFormulaIsReciprocal) {
  EXPECT_TRUE(as_function(device(), parse_material("ward:m=0.3")).is_reciprocal);
  const Material sheen = parse_material("zeltner_sheen:alpha=0.5");
  const std::vector<BrdfFunction> pair{as_function(device(), sheen), as_function(device(), parse_material("lambert"))};
  EXPECT_FALSE(pair.front().is_reciprocal);

  const Metric found = measure_functions(pair, Lighting::point(), {.tolerance = 1e-3}).combined;

  const Metric expected =
      measure_formulas(device(), std::vector{sheen, parse_material("lambert")}, Lighting::point(), {}).combined;
  EXPECT_NEAR(found.gram(0, 0), expected.gram(0, 0), found.gram_error(0, 0) + expected.gram_error(0, 0));
  EXPECT_NEAR(found.distance(0, 1), expected.distance(0, 1),
              found.distance_error(0, 1) + expected.distance_error(0, 1));
}

/// The largest relative errors, from values and albedos alone.
struct Largest {
  double radiance = 0;
  double albedo = 0;
  std::vector<double> all;
};
Largest errors_between(const Material& f, const Material& g, double floor) {
  Largest largest;
  const auto directions = perceptual_directions(true);
  const Eigen::VectorXd values_f = evaluate(device(), f, directions);
  const Eigen::VectorXd values_g = evaluate(device(), g, directions);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double cosine = std::cos(directions[i].theta_in);
    const double error = std::abs(values_g(at) - values_f(at)) * cosine / std::max(values_f(at) * cosine, floor);
    largest.all.push_back(error);
    largest.radiance = std::max(largest.radiance, error);
  }
  const auto albedos_f = albedo(device(), f, perceptual_incidence(true)).front();
  const auto albedos_g = albedo(device(), g, perceptual_incidence(true)).front();
  for (std::size_t i = 0; i < albedos_f.size(); ++i) {
    const double error = std::abs(albedos_g[i].value - albedos_f[i].value) / std::max(albedos_f[i].value, floor);
    largest.all.push_back(error);
    largest.albedo = std::max(largest.albedo, error);
  }
  return largest;
}

FitOptions perceptual() {
  FitOptions options;
  options.objective = FitObjective::perceptual;
  return options;
}

// Albedos are known to 1e-4 while searching.
constexpr double kAlbedoNoise = 2e-4;

TEST(PerceptualFit, IsTheLeastLargestErrorThatAScanFinds) {
  constexpr int kSteps = 60;
  const FitOptions options = perceptual();
  const auto worst_at = [&](double m) {
    const Largest errors = errors_between(metal_to_fit(), make_material("ward", {{"m", m}}), options.radiance_floor);
    return std::max(errors.radiance, errors.albedo);
  };
  const Scan least = scan(0.15, 0.6, kSteps, worst_at);

  const auto result = fit(device(), metal_to_fit(), parse_family("ward:scale=1"), options);

  ASSERT_TRUE(result.errors.has_value());
  const double worst = std::max(result.errors->radiance.value.value, result.errors->albedo.value.value);
  EXPECT_LE(worst, least.least + kAlbedoNoise);
  EXPECT_NEAR(value_of(result, "m"), least.at, 0.45 / kSteps);
}

TEST(PerceptualFit, StatesTheErrorsThatEvaluationGives) {
  const FitOptions options = perceptual();

  const auto result = fit(device(), metal_to_fit(), parse_family("ggx"), options);

  const Largest errors = errors_between(metal_to_fit(), result.material, options.radiance_floor);
  ASSERT_TRUE(result.errors.has_value());
  const auto& [radiance, albedos] = *result.errors;
  EXPECT_DOUBLE_EQ(radiance.value.value, errors.radiance);
  EXPECT_NEAR(albedos.value.value, errors.albedo, albedos.value.error);
  const Eigen::VectorXd f = evaluate(device(), metal_to_fit(), std::vector{radiance.directions});
  const Eigen::VectorXd g = evaluate(device(), result.material, std::vector{radiance.directions});
  const double cosine = std::cos(radiance.directions.theta_in);
  const double size = std::max(f(0) * cosine, options.radiance_floor);
  EXPECT_NEAR(std::abs(g(0) - f(0)) * cosine / size, radiance.value.value, 1e-12);
  // The place of an albedo is an angle of incidence alone.
  const Directions& at = albedos.directions;
  EXPECT_EQ(at.theta_out, 0);
  EXPECT_EQ(at.delta_phi, 0);
  const std::vector<double> theta{at.theta_in};
  const Estimate target = albedo(device(), metal_to_fit(), theta).front().front();
  const Estimate found = albedo(device(), result.material, theta).front().front();
  EXPECT_NEAR(std::abs(found.value - target.value) / target.value, albedos.value.value, albedos.value.error);
}

TEST(PerceptualFit, IsWorseAfterAnySmallStep) {
  const auto target = parse_material("lambert:scale=0.3+ward:m=0.17,scale=0.4");
  FitOptions options = perceptual();
  options.starts = {{{"alpha", 0.15}}};
  const auto worst_of = [&](const Material& member) {
    const Largest errors = errors_between(target, member, options.radiance_floor);
    return std::max(errors.radiance, errors.albedo);
  };

  const Material found = fit(device(), target, parse_family("lambert+ggx"), options).material;

  const double least = worst_of(found);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  double best_step = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 40; ++i) {
    Material moved = found;
    constexpr double kStep = 0.02;
    moved.terms[0].weight[0] *= std::exp(kStep * normal(random));
    moved.terms[1].weight[0] *= std::exp(kStep * normal(random));
    moved.terms[1].values[0] *= std::exp(kStep * normal(random));
    best_step = std::min(best_step, worst_of(moved));
  }
  EXPECT_GE(best_step, least - kAlbedoNoise);
}

TEST(PerceptualFit, RecoversAMemberOfTheFamily) {
  const auto target = parse_material("lambert:scale=0.3+ward:m=0.17,scale=0.4");

  const auto result = fit(device(), target, parse_family("lambert+ward"), perceptual());

  EXPECT_NEAR(value_of(result, "m"), 0.17, 1e-4);
  EXPECT_LE(result.errors->radiance.value.value, kAlbedoNoise);
  EXPECT_EQ(result.covariance.size(), 0);
}

TEST(PerceptualFit, LooksAtDirectionsWithin80Degrees) {
  const auto directions = perceptual_directions(true);

  EXPECT_GT(directions.size(), 300U);
  EXPECT_TRUE(std::ranges::all_of(directions, [](const Directions& pair) {
    return pair.theta_in <= 80 * kDegree && pair.theta_out <= 80 * kDegree;
  }));
  // theta_h = 0: mirror directions.
  EXPECT_TRUE(std::ranges::any_of(directions, [](const Directions& pair) {
    return std::abs(pair.theta_in - 75 * kDegree) < 1e-12 && std::abs(pair.theta_out - 75 * kDegree) < 1e-12 &&
           std::abs(std::abs(pair.delta_phi) - std::numbers::pi) < 1e-12;
  }));
}

TEST(Fit, RefusesABlackTarget) {
  try {
    (void)fit(device(), parse_material("lambert:scale=0"), parse_family("ward"));
    FAIL();
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("norm 0"));
  }
}

TEST(Fit, RefusesADistanceWithoutScalarProduct) {
  FitOptions options;
  options.objective = FitObjective::log;
  options.metric = LiteratureMetric::cube_root;

  EXPECT_THROW((void)fit(device(), metal_to_fit(), parse_family("ward"), options), ArgumentError);
}

TEST(Fit, RefusesAStartThatLeavesAParameterOut) {
  FitOptions options;
  options.starts = {{{"m", 0.2}}};

  try {
    (void)fit(device(), metal_to_fit(), parse_family("cook_torrance:f0=free"), options);
    FAIL();
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no value of 'f0'"));
  }
}

TEST(Fit, StopsWhenProgressSaysSo) {
  FitOptions options;
  int calls = 0;
  options.progress = [&](std::string_view, double) { return ++calls < 20; };

  EXPECT_THROW((void)fit(device(), metal_to_fit(), parse_family("ward"), options), Cancelled);
}

TEST(Fit, SaysHowFarItIs) {
  FitOptions options;
  double last = 0;
  bool rises = true;
  options.progress = [&](std::string_view, double fraction) {
    rises = rises && fraction >= last - 1e-12 && fraction <= 1;
    last = fraction;
    return true;
  };

  (void)fit(device(), metal_to_fit(), parse_family("ward"), options);

  EXPECT_TRUE(rises);
  EXPECT_GT(last, 0.7);
}

TEST(Fit, TellsOfBetterMembersAsItComesToThem) {
  FitOptions options;
  std::vector<double> residuals;
  std::string last;
  options.watch = [&](const Material& member, double residual) {
    residuals.push_back(residual);
    last = member.name;
  };

  const FitResult result = fit(device(), metal_to_fit(), parse_family("ward"), options);

  EXPECT_GT(residuals.size(), 3U);
  for (std::size_t k = 1; k < residuals.size(); ++k) EXPECT_LT(residuals[k], residuals[k - 1]) << k;
  // The search is accurate to a thousandth.
  EXPECT_NEAR(residuals.back(), result.residual.value, 2e-3 * result.residual.value);
  EXPECT_THAT(last, ::testing::StartsWith("ward:m="));
}

}  // namespace
}  // namespace lobe::test
