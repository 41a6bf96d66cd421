// Products of functions under patch lights: against (5.23) taken literally, against those of formulas, and in closed
// form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "metric/routes.hpp"
#include "reference/lit_product.hpp"
#include "support/device.hpp"
#include "support/functions.hpp"
#include "support/measured_data.hpp"
#include "table/as_function.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

// What the reference may miss of products, relative to norms: five times the largest change seen when it was refined.
constexpr double kReference = 2e-3;

reference::PairValues values_of(const BrdfFunction& function) {
  return [function](std::span<const Directions> pairs) {
    const BrdfValues values = function.at(pairs);
    std::vector<double> first(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) first[k] = values.value(static_cast<Eigen::Index>(k), 0);
    return first;
  };
}

/// \param largest error of products relative to norms, squared
void expect_literal(const BrdfFunction& f, const BrdfFunction& g, double radius, double largest,
                    const reference::LitRule& rule, double lobe_width) {
  const std::vector<BrdfFunction> both{f, g};
  const Metric found = measure_functions(both, Lighting::patch(radius), {.lobe_width = lobe_width}).combined;
  const auto expected = reference::lit_products(values_of(f), values_of(g), radius, rule);
  for (const auto& [i, j, at] : {std::tuple(0, 0, 0), std::tuple(0, 1, 1), std::tuple(1, 1, 2)}) {
    const double size = found.norm(i) * found.norm(j);
    EXPECT_NEAR(found.gram(i, j), expected[static_cast<std::size_t>(at)], found.gram_error(i, j) + kReference * size)
        << f.name << " " << g.name << " " << radius << " " << i << j;
    EXPECT_LE(found.gram_error(i, j), largest * size) << f.name << " " << g.name << " " << radius << " " << i << j;
  }
}

constexpr std::array kRadii{0.3, 0.8, 1.4};

/// One subject for each radius, because a reference takes half a minute.
std::string subject_of(double radius, const std::array<std::string, kRadii.size()>& subjects) {
  return subjects.at(static_cast<std::size_t>(std::ranges::find(kRadii, radius) - kRadii.begin()));
}

class FunctionPatch : public ::testing::TestWithParam<double> {};

TEST_P(FunctionPatch, ProductsOfAnisotropicFunctionsAreThoseOfTheDefinition) {
  const BrdfFunction lambert = as_function(device(), parse_material("lambert:scale=0.5"));
  const reference::LitRule rule{.incident = 4, .turns = 8, .azimuths = 16, .nodes = 5, .narrowest = 0.1};
  const std::string text =
      subject_of(GetParam(), {"ward_anisotropic:m_x=0.3,m_y=0.6,rotation=0.4",
                              "ggx_anisotropic:alpha_x=0.2,alpha_y=0.4", "ashikhmin_shirley_anisotropic:n_u=5,n_v=30"});
  expect_literal(as_function(device(), parse_material(text)), lambert, GetParam(), 0.02, rule, 0.1);
}

/// Values that are neither reciprocal nor even in the azimuth.
TEST_P(FunctionPatch, ProductsSmoothTheLightAndTakeBothSigns) {
  const BrdfFunction odd = function_of([](const Directions& pair) {
    return std::cos(pair.theta_in) *
           (1 + 0.5 * std::sin(pair.theta_in) * std::sin(pair.theta_out) * std::sin(pair.delta_phi));
  });
  const BrdfFunction even = function_of([](const Directions& pair) { return std::pow(std::cos(pair.theta_out), 2); });
  expect_literal(odd, even, GetParam(), 0.02, {.incident = 6, .azimuths = 24, .nodes = 8, .narrowest = 0.3}, 0.5);
}

TEST_P(FunctionPatch, ProductsOfFormulasAreThoseOfTheirPolynomials) {
  const std::vector<std::string> texts{"lambert:scale=0.5", "phong:n=20", "ggx:alpha=0.1"};
  std::vector<Material> materials;
  std::vector<BrdfFunction> functions;
  for (const auto& text : texts) {
    materials.push_back(parse_material(text));
    functions.push_back(as_function(device(), materials.back()));
  }
  const Lighting lighting = Lighting::patch(GetParam());
  const Metric expected = measure(device(), materials, lighting, {.patch_tolerance = 1e-3}).combined;
  const Metric found = measure_functions(functions, lighting, {.lobe_width = 0.05}).combined;
  for (Eigen::Index i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    for (Eigen::Index j = 0; j < 3; ++j) {
      SCOPED_TRACE(j);
      EXPECT_NEAR(found.gram(i, j), expected.gram(i, j), found.gram_error(i, j) + expected.gram_error(i, j))
          << GetParam() << " " << i << j;
      EXPECT_LE(found.gram_error(i, j), 0.02 * found.norm(i) * found.norm(j)) << GetParam() << " " << i << j;
      EXPECT_NEAR(found.distance(i, j), expected.distance(i, j),
                  found.distance_error(i, j) + expected.distance_error(i, j));
    }
  }
}

TEST_P(FunctionPatch, ProductsOfMeasuredFilesAreThoseOfTheDefinition) {
  const auto path =
      measured_data(subject_of(GetParam(), {"rgl_bsdf/vch_golden_yellow_rgb.bsdf", "nbrdf/merl/alum-bronze.h5",
                                            "nbrdf/merl/white-diffuse-bball.h5"}));
  if (path.empty()) GTEST_SKIP() << kNoData;
  const BrdfFunction function = *load_reflectance(path, {.theta_max = 80 * kDegree}).function();
  BrdfFunction first = function;
  first.channels.resize(1);
  first.at = [at = function.at](std::span<const Directions> pairs) {
    const BrdfValues values = at(pairs);
    return BrdfValues{values.value.leftCols(1), {}};
  };
  expect_literal(first, as_function(device(), parse_material("phong:n=20")), GetParam(), 0.05,
                 {.incident = 6, .azimuths = 16, .nodes = 3, .narrowest = 0.01}, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Radii, FunctionPatch, ::testing::ValuesIn(kRadii));

/// At R = 2 every disc is the whole hemisphere: f.g = integral of a_f a_g dmu / pi.
TEST(FunctionPatchLimits, TheLargestPatchIsDaylight) {
  std::vector<BrdfFunction> functions;
  for (const std::string text : {"ggx_anisotropic:alpha_x=0.2,alpha_y=0.4", "phong:n=20"}) {
    functions.push_back(as_function(device(), parse_material(text)));
  }
  const Metric lit = measure_functions(functions, Lighting::patch(2), {.lobe_width = 0.1}).combined;
  const Metric daylight = measure_functions(functions, Lighting::daylight(), {.lobe_width = 0.1}).combined;
  for (Eigen::Index i = 0; i < 2; ++i) {
    SCOPED_TRACE(i);
    for (Eigen::Index j = 0; j < 2; ++j) {
      SCOPED_TRACE(j);
      EXPECT_NEAR(lit.gram(i, j), daylight.gram(i, j) / pi, lit.gram_error(i, j) + daylight.gram_error(i, j) / pi);
    }
  }
}

TEST(FunctionPatchLimits, AMixtureIsTheSumOfItsPatches) {
  const std::vector<BrdfFunction> functions{
      as_function(device(), parse_material("ggx_anisotropic:alpha_x=0.2,alpha_y=0.4"))};
  const auto square = [&](const Lighting& lighting) {
    return measure_functions(functions, lighting, {.lobe_width = 0.1}).combined.gram(0, 0);
  };
  const double sum = 0.3 * square(Lighting::patch(0.4)) + 2 * square(Lighting::patch(1.2));
  const Metric mixture =
      measure_functions(functions, Lighting::mixture({{0.4, 0.3}, {1.2, 2}}), {.lobe_width = 0.1}).combined;
  EXPECT_NEAR(mixture.gram(0, 0), sum, mixture.gram_error(0, 0));
}

/// An error of 0.01 everywhere is 0.01 pi times Lambert.
TEST(FunctionPatchLimits, ErrorsOfValuesAreCarried) {
  const std::vector<BrdfFunction> functions{function_of([](const Directions&) { return 1 / pi; }, 0.01)};
  const Metric metric = measure_functions(functions, Lighting::patch(0.5)).combined;
  // |e| / |f| = 0.01 pi: nothing of what W leaves of f is left of e.
  EXPECT_NEAR(metric.norm_error(0), 0.01 * pi * metric.norm(0), 3e-3 * metric.norm(0));
}

/// W is bounded and positive: a norm exists where albedos do not grow as 1/(N.L).
TEST(FunctionPatchLimits, NormsThatDoNotExistAreRefused) {
  const std::vector<BrdfFunction> functions{
      function_of([](const Directions& pair) { return 1 / std::cos(pair.theta_in); })};
  EXPECT_THROW((void)measure_functions(functions, Lighting::patch(0.5)), NumericError);
}

TEST(FunctionPatchLimits, FormulasOfAllKindsHaveARoute) {
  const Lighting lighting = Lighting::patch(0.5);
  const Material isotropic = parse_material("phong:n=20");
  const Material anisotropic = parse_material("ggx_anisotropic:alpha_x=0.2,alpha_y=0.4");
  const Material delta = parse_material("mirror:rho=0.2");
  EXPECT_EQ(choose_route({isotropic, delta}, lighting).route, Route::formulas);
  EXPECT_EQ(choose_route({isotropic, anisotropic}, lighting).route, Route::functions);
  EXPECT_EQ(choose_route({delta, anisotropic}, lighting).route, Route::tables);  // the only one that takes both
  EXPECT_EQ(choose_route({anisotropic}, Lighting::point()).route, Route::formulas);
}

}  // namespace
}  // namespace lobe::test
