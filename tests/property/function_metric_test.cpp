// Products of reflectances that are functions: against those of formulas, and in closed form.
#include "metric/routes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "metric/table_metric.hpp"
#include "support/device.hpp"
#include "support/functions.hpp"
#include "support/tables.hpp"
#include "table/as_function.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

void expect_those_of_formulas(const std::vector<std::string>& texts, const Lighting& lighting, double largest_error) {
  std::vector<Material> materials;
  std::vector<BrdfFunction> functions;
  for (const auto& text : texts) {
    materials.push_back(parse_material(text));
    functions.push_back(as_function(device(), materials.back()));
  }
  const Metric expected = measure(device(), materials, lighting).combined;
  const Metric found = measure_functions(functions, lighting, {.lobe_width = 0.05}).combined;
  for (Eigen::Index i = 0; i < found.gram.rows(); ++i) {
    for (Eigen::Index j = 0; j < found.gram.cols(); ++j) {
      const double gram_error = found.gram_error(i, j) + expected.gram_error(i, j);
      EXPECT_LE(std::abs(found.gram(i, j) - expected.gram(i, j)), gram_error) << i << " " << j;
      EXPECT_LE(std::abs(found.distance(i, j) - expected.distance(i, j)),
                found.distance_error(i, j) + expected.distance_error(i, j))
          << i << " " << j;
      EXPECT_LE(found.gram_error(i, j), largest_error * found.norm(i) * found.norm(j)) << i << " " << j;
    }
  }
}

// How far the coarser of two levels is off, measured: 1e-4 of the product of norms under point light, 1e-4 of albedos.
TEST(FunctionMetric, OfFormulasIsThatOfMaterialsUnderPointLight) {
  expect_those_of_formulas({"lambert:scale=0.5", "ward_anisotropic:m_x=0.2,m_y=0.4", "ggx:alpha=0.1"},
                           Lighting::point(), 1e-3);
}

TEST(FunctionMetric, OfFormulasIsThatOfMaterialsUnderDaylight) {
  expect_those_of_formulas({"lambert:scale=0.5", "phong:n=20", "ggx:alpha=0.1"}, Lighting::daylight(), 1e-3);
}

TEST(FunctionMetric, OfFormulasIsThatOfMaterialsByMeanAlbedos) {
  expect_those_of_formulas({"lambert:scale=0.5", "phong:n=20", "ggx:alpha=0.1"}, Lighting::mean_albedo(), 1e-3);
}

TEST(FunctionMetric, TakesBothOrdersOfWhatIsNotReciprocal) {
  const std::vector<BrdfFunction> functions{
      function_of([](const Directions& pair) { return std::cos(pair.theta_in); }),
      function_of([](const Directions& pair) { return std::cos(pair.theta_out); }),
      function_of([](const Directions& pair) { return std::sin(pair.delta_phi); })};
  const Metric point = measure_functions(functions, Lighting::point()).combined;
  // Integral of cos^2 dmu over one direction is pi/2, of cos dmu 2 pi/3, of dmu pi.
  EXPECT_NEAR(point.gram(0, 0), pi * pi / 2, 1e-6);
  EXPECT_NEAR(point.gram(1, 1), pi * pi / 2, 1e-6);
  EXPECT_NEAR(point.gram(0, 1), 4 * pi * pi / 9, 1e-6);
  // Azimuths jump where a direction passes the normal.
  EXPECT_NEAR(point.gram(2, 2), pi * pi / 2, point.gram_error(2, 2));
  EXPECT_LT(point.gram_error(2, 2), 1e-2);
  EXPECT_NEAR(point.gram(0, 2), 0, 1e-6);
  // Albedos by V, integrals over L: 2 pi/3, and pi cos(theta_out).
  const Metric daylight = measure_functions(functions, Lighting::daylight()).combined;
  EXPECT_NEAR(daylight.gram(0, 0), 4 * pi * pi * pi / 9, 1e-6);
  EXPECT_NEAR(daylight.gram(1, 1), pi * pi * pi / 2, 1e-6);
  EXPECT_NEAR(daylight.gram(2, 2), 0, 1e-12);
}

TEST(FunctionMetric, OfAnisotropicFunctionsSeesTheAzimuthOfBothDirections) {
  // cos(2 phi_in) and cos(2 phi_out): orthogonal to what is isotropic, and to each other.
  auto of_light = function_of([](const Directions& pair) { return std::cos(2 * pair.phi_in); });
  auto of_viewer = function_of([](const Directions& pair) { return std::cos(2 * (pair.phi_in + pair.delta_phi)); });
  of_light.is_isotropic = of_viewer.is_isotropic = false;
  const std::vector<BrdfFunction> functions{of_light, of_viewer, function_of([](const Directions&) { return 1 / pi; })};
  const Metric point = measure_functions(functions, Lighting::point()).combined;
  EXPECT_NEAR(point.gram(0, 0), pi * pi / 2, 1e-6);
  EXPECT_NEAR(point.gram(1, 1), pi * pi / 2, 1e-6);
  EXPECT_NEAR(point.gram(0, 1), 0, point.gram_error(0, 1));
  EXPECT_LT(point.gram_error(0, 1), 1e-2);
  EXPECT_NEAR(point.gram(0, 2), 0, 1e-6);
  // What depends on V alone has albedos pi cos(2 phi_out), what depends on L alone none.
  const Metric daylight = measure_functions(functions, Lighting::daylight()).combined;
  EXPECT_NEAR(daylight.gram(0, 0), 0, 1e-6);
  EXPECT_NEAR(daylight.gram(1, 1), pi * pi * pi / 2, 1e-6);
}

/// A table's cells as steps, which is what they are in files: without errors of interpolation.
BrdfFunction constant_on_cells(const BrdfTable& table) {
  BrdfFunction brdf = as_function(table);
  brdf.at = [at = brdf.at](std::span<const Directions> pairs) { return BrdfValues{at(pairs).value, {}}; };
  return brdf;
}

/// Steps at the edges of patches, and azimuths: what the rule knows least of. Sums over patches are exact.
TEST(FunctionMetric, OfPatchesIsThatOfTheirTable) {
  const std::vector<BrdfTable> tables{table_of("ward_anisotropic:m_x=0.3,m_y=0.6", "klems:41", TableForm::general),
                                      table_of("lambert", "klems:41", TableForm::general)};
  const std::vector<BrdfFunction> functions{constant_on_cells(tables[0]), constant_on_cells(tables[1])};
  for (const Lighting& lighting : {Lighting::mean_albedo(), Lighting::point()}) {
    const Metric exact = measure(device(), tables, lighting).combined;
    const Metric found = measure_functions(functions, lighting, {.lobe_width = 0.05}).combined;
    for (Eigen::Index i = 0; i < 2; ++i) {
      for (Eigen::Index j = 0; j < 2; ++j) {
        EXPECT_NEAR(found.gram(i, j), exact.gram(i, j), found.gram_error(i, j)) << lighting.name() << i << j;
        EXPECT_LT(found.gram_error(i, j), 0.3 * exact.norm(i) * exact.norm(j)) << lighting.name() << i << j;
      }
    }
  }
}

TEST(FunctionMetric, RefusesDeltaParts) {
  const std::vector<BrdfFunction> functions{as_function(table_of("mirror", "klems:41", TableForm::general))};
  EXPECT_THROW((void)measure_functions(functions, Lighting::daylight()), ArgumentError);
}

TEST(FunctionMetric, CarriesTheErrorsOfValues) {
  const std::vector<BrdfFunction> functions{function_of([](const Directions&) { return 1 / pi; }, 0.01),
                                            function_of([](const Directions&) { return 0.9 / pi; })};
  const Metric point = measure_functions(functions, Lighting::point()).combined;
  // An error of 0.01 everywhere has the norm 0.01 pi.
  EXPECT_NEAR(point.norm(0), 1, 1e-9);
  EXPECT_NEAR(point.norm_error(0), 0.01 * pi, 2e-3);
  EXPECT_NEAR(point.distance(0, 1), 0.1, 1e-9);
  EXPECT_GE(point.distance_error(0, 1), 0.01 * pi);
  EXPECT_LE(point.distance_error(0, 1), 0.05);
}

TEST(FunctionMetric, CarriesTheErrorsOfValuesIntoAlbedos) {
  const std::vector<BrdfFunction> functions{function_of([](const Directions&) { return 1 / pi; }, 0.01),
                                            function_of([](const Directions&) { return 0.9 / pi; })};
  // Albedos of 1 and 0.9, of which the first is off by 0.01 pi.
  const Metric daylight = measure_functions(functions, Lighting::daylight()).combined;
  EXPECT_NEAR(daylight.norm(0), std::sqrt(pi), 1e-9);
  EXPECT_NEAR(daylight.norm_error(0), 0.01 * pi * std::sqrt(pi), 5e-3);
  EXPECT_NEAR(daylight.distance(0, 1), 0.1 * std::sqrt(pi), 1e-9);
  EXPECT_GE(daylight.distance_error(0, 1), 0.01 * pi * std::sqrt(pi));
  const Metric mean = measure_functions(functions, Lighting::mean_albedo()).combined;
  EXPECT_NEAR(mean.norm(0), pi, 1e-9);
  EXPECT_NEAR(mean.norm_error(0), 0.01 * pi * pi, 1e-2);
  EXPECT_NEAR(mean.gram(0, 1), 0.9 * pi * pi, 1e-8);
  EXPECT_GE(mean.gram_error(0, 1), 0.01 * pi * 0.9 * pi * pi);
}

/// The same jump, by a part in 1e6 higher: what its place does to both cancels in their difference.
TEST(FunctionMetric, OfNearlyTheSameFunctionsHasTheErrorsOfTheirDifference) {
  const auto step = [](double height) {
    return function_of([height](const Directions& pair) { return std::cos(pair.theta_in) > 0.37 ? height : 0.1; });
  };
  const std::vector<BrdfFunction> functions{step(0.3), step(0.3 + 1e-6)};
  // Albedos differ by 1e-6 times the integral of dmu above.
  const double difference = 1e-6 * pi * (1 - 0.37 * 0.37);
  for (const auto& [lighting, scale] :
       {std::pair{Lighting::daylight(), std::sqrt(pi)}, {Lighting::mean_albedo(), pi}}) {
    const Metric found = measure_functions(functions, lighting).combined;
    EXPECT_NEAR(found.distance(0, 1), scale * difference, found.distance_error(0, 1)) << lighting.name();
    EXPECT_LE(found.distance_error(0, 1), 0.05 * scale * difference) << lighting.name();
  }
}

/// More pairs than differences are integrated of: their errors are those of both functions.
TEST(FunctionMetric, OfManyFunctionsHasDistancesToo) {
  constexpr int kFunctions = 95;
  std::vector<BrdfFunction> functions;
  std::vector<double> albedos;
  for (int k = 0; k < kFunctions; ++k) {
    const double slope = 0.01 * k;
    functions.push_back(function_of([slope](const Directions& pair) { return 0.1 + slope * std::cos(pair.theta_in); }));
    albedos.push_back(0.1 * pi + slope * 2 * pi / 3);
  }
  for (const auto& [lighting, scale] :
       {std::pair{Lighting::daylight(), std::sqrt(pi)}, {Lighting::mean_albedo(), pi}}) {
    const Metric found = measure_functions(functions, lighting).combined;
    for (Eigen::Index i = 0; i < kFunctions; i += 13) {
      for (Eigen::Index j = 0; j < i; j += 7) {
        const double a = albedos[static_cast<std::size_t>(i)];
        const double b = albedos[static_cast<std::size_t>(j)];
        EXPECT_NEAR(found.gram(i, j), scale * scale * a * b, found.gram_error(i, j)) << i << " " << j;
        EXPECT_NEAR(found.distance(i, j), scale * std::abs(a - b), found.distance_error(i, j)) << i << " " << j;
        EXPECT_LE(found.distance_error(i, j), 2e-3 * (found.norm(i) + found.norm(j))) << i << " " << j;
      }
    }
  }
}

TEST(FunctionMetric, RefusesWhatItCannotMeasure) {
  std::vector<BrdfFunction> functions{function_of([](const Directions&) { return std::nan(""); })};
  EXPECT_THROW((void)measure_functions(functions, Lighting::point()), NumericError);
  EXPECT_THROW((void)measure_functions(std::span<const BrdfFunction>(), Lighting::point()), ArgumentError);
  EXPECT_THROW((void)measure_functions(functions, Lighting::patch(0.5)), NumericError);
  const Lighting tabulated = Lighting::table(table_of("lambert", "gauss:4x8", TableForm::isotropic), "w.h5");
  EXPECT_THROW((void)measure_functions(functions, tabulated), ArgumentError);
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW((void)measure_functions(functions, Lighting::daylight(), {.progress = stop}), Cancelled);
}

}  // namespace
}  // namespace lobe::test
