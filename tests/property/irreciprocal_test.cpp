// Formulas that are not the same with L and V exchanged: products, compositions and metrics of the literature, in
// closed form and on other routes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "energy/albedo_integrator.hpp"
#include "energy/prepare.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/composition.hpp"
#include "metric/products.hpp"
#include "model/lobes.hpp"
#include "support/device.hpp"
#include "support/materials.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

Material irreciprocal(const std::string& text) {
  Term term;
  term.model = std::string(kCustomModel);
  term.weight = {1};
  term.formula = Formula{.text = text, .width = 1, .reciprocal = false};
  return prepare(device(), {.name = text, .family = {}, .terms = {term}});
}

/// x^i y^j with x = N.L and y = N.V.
Material powers(int i, int j) {
  return irreciprocal("pow(cos_i, " + std::to_string(i) + ".0) * pow(cos_o, " + std::to_string(j) + ".0)");
}

/// max(x - 1/2, 0) y: its kink is where N.L is 1/2, and nowhere else.
Material half_lit() {
  return irreciprocal("fmax(cos_i - 0.5, 0.0) * cos_o");
}

/// Formulas as such, as functions, and as tables.
const std::vector<MetricOptions> kRoutes{{.route = Route::formulas},
                                         {.route = Route::functions, .function_tolerance = 1e-4},
                                         {.grid = HemisphereGrid::gauss(32, 64)}};

void expect_holds(const Estimate& found, double expected, double enough) {
  EXPECT_NEAR(found.value, expected, found.error);
  EXPECT_LE(found.error, enough * std::abs(expected));
}

// The integral of x^i y^j x dx y dy over [0, 1]^2 is 1/((i + 2) (j + 2)); over both azimuths it is 4 pi^2 times that.
TEST(Irreciprocal, HasPointProductsInClosedForm) {
  const Metric found =
      measure(device(), {powers(1, 2), powers(3, 0), half_lit()}, Lighting::point(), {.tolerance = 1e-7}).combined;
  const auto expect = [&](Eigen::Index i, Eigen::Index j, double expected) {
    expect_holds({found.gram(i, j), found.gram_error(i, j)}, 4 * pi * pi * expected, 1e-6);
  };
  expect(0, 0, 1.0 / (4 * 6));
  expect(0, 1, 1.0 / (6 * 4));
  expect(1, 1, 1.0 / (8 * 2));
  const double square = std::pow(0.5, 4) / 4 + std::pow(0.5, 4) / 3;  // of (x - 1/2)^2 x over [1/2, 1]
  expect(2, 2, square / 4);
  const double moment = (1 - std::pow(0.5, 4)) / 4 - (1 - std::pow(0.5, 3)) / 6;  // of x (x - 1/2) x
  expect(0, 2, moment / 5);
}

// As powers have by themselves; the anisotropic part is odd in L_x and squares to x^2 (1 - x^2)/2 on the average.
TEST(Irreciprocal, HasPointProductsBesideAnisotropicOnes) {
  const Material turned = irreciprocal("(1 + in_x) * cos_o * cos_o");
  const Metric found = measure(device(), {turned, powers(1, 2)}, Lighting::point()).combined;

  const double squares = 0.5 + (0.5 - 0.25) / 2;  // integrals of x and of (1 - x^2) x / 2
  expect_holds({found.gram(0, 0), found.gram_error(0, 0)}, 4 * pi * pi * squares / 6, 1e-4);
  expect_holds({found.gram(0, 1), found.gram_error(0, 1)}, 4 * pi * pi / (3 * 6), 1e-4);
}

// The light comes from everywhere, so albedos are those of what the viewer sees: 2 pi y^j / (i + 2).
TEST(Irreciprocal, HasProductsUnderDaylightOfWhatTheViewerSees) {
  const std::vector<Reflectance> both{powers(1, 2), powers(3, 0)};
  for (const auto& options : kRoutes) {
    const Metric found = measure(device(), both, Lighting::daylight(), options).combined;
    expect_holds({found.gram(0, 1), found.gram_error(0, 1)}, std::pow(2 * pi, 3) / (3 * 5 * 4), 2e-2);
    expect_holds({found.gram(1, 1), found.gram_error(1, 1)}, std::pow(2 * pi, 3) / (5 * 5 * 2), 2e-2);
  }
  // Panels of L end on its kink.
  const Metric kinked = measure(device(), {half_lit()}, Lighting::daylight(), {.tolerance = 1e-8}).combined;
  const double seen = std::pow(0.5, 3) / 3 + std::pow(0.5, 3) / 2;  // integral of (x - 1/2) x over [1/2, 1]
  expect_holds({kinked.gram(0, 0), kinked.gram_error(0, 0)}, std::pow(2 * pi, 3) * seen * seen / 4, 2e-8);
}

// A study shares its slabs among processes by their number. The kink N.L = 3 N.V meets the normal of L where N.V = 1/3.
TEST(Irreciprocal, HasAsManySlabsUnderDaylightAsItIsIntegratedBy) {
  const std::vector<Material> one{irreciprocal("fmax(cos_i - 3 * cos_o, 0.0)")};
  const LobeSet lobes = make_lobe_set(one, {});
  const MetricOptions options;
  const AlbedoIntegrator integrator(device(), lobes, options.precision, Given::viewer, options.tolerance,
                                    SharedRule::by_limits);
  EXPECT_EQ(daylight_slabs(lobes, options), integrator.rule().slabs());
  EXPECT_NE(daylight_slabs(lobes, options), AlbedoRule(lobes.given_extent(), options.tolerance).slabs());
}

// Patch light smooths over L: under any of them the square of x y^3 is half that of x y.
TEST(Irreciprocal, IsSmoothedOverTheLightByPatchLights) {
  for (const auto& light : {Lighting::patch(0.5), Lighting::patch(1.5)}) {
    const Metric known = measure(device(), {powers(1, 1)}, light, {.tolerance = 1e-6}).combined;
    for (const auto& options : kRoutes) {
      const Metric found = measure(device(), {powers(1, 3), powers(3, 1)}, light, options).combined;
      expect_holds({found.gram(0, 0), found.gram_error(0, 0) + known.gram_error(0, 0)}, known.gram(0, 0) / 2, 5e-2);
      EXPECT_GT(std::abs(found.gram(1, 1) / found.gram(0, 0) - 1), 0.02) << light.name();  // the orders differ
    }
  }
}

// Under eta = 1/pi, which is the patch of radius 2, f becomes what the viewer sees of daylight, over pi.
TEST(Irreciprocal, HasOneProductUnderLightsThatAreTheSame) {
  const Material first = powers(1, 2);
  const Material second = powers(3, 0);
  const Metric daylight = measure(device(), {first, second}, Lighting::daylight()).combined;
  const auto expect_same = [&](const ReflectanceList& both, const Lighting& light, const MetricOptions& options) {
    const Metric found = measure(device(), both, light, options).combined;
    for (Eigen::Index i = 0; i < 2; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        const double error = found.gram_error(i, j) + daylight.gram_error(i, j);
        expect_holds({found.gram(i, j), error}, daylight.gram(i, j) / pi, 5e-2);
      }
    }
  };
  for (const auto& light :
       {Lighting::patch(2), parse_lighting("material:lambert"), parse_lighting("material:basic_patch:R=2")}) {
    expect_same({first, second}, light, {});
    expect_same({as_function(device(), first), as_function(device(), second)}, light, {});
    expect_same({first, second}, light, {.grid = HemisphereGrid::gauss(32, 64)});
  }
}

// C_{f,g}(L, V) is the integral of f(L, X) g(X, V) (N.X) over X.
TEST(Irreciprocal, IsComposedInTheOrderOfItsDirections) {
  const Directions pair{0.4, 1.1, 0.7};
  const double x = std::cos(pair.theta_in);
  const double y = std::cos(pair.theta_out);
  const auto composed = [&](const Material& f, const Material& g) {
    return composition_at(device(), f, g, {&pair, 1}, {.tolerance = 1e-9}).at(0).at(0);
  };
  expect_holds(composed(powers(1, 2), powers(3, 0)), x * 2 * pi / 7, 1e-8);
  expect_holds(composed(powers(3, 0), powers(1, 2)), x * x * x * y * y * 2 * pi / 3, 1e-8);
  const double half = (1 - std::pow(0.5, 5)) / 5 - (1 - std::pow(0.5, 4)) / 8;  // of z^3 (z - 1/2) over [1/2, 1]
  expect_holds(composed(powers(1, 2), half_lit()), x * y * 2 * pi * half, 1e-8);
  const double moment = (1 - std::pow(0.5, 4)) / 4 - (1 - std::pow(0.5, 3)) / 6;
  expect_holds(composed(half_lit(), half_lit()), (x - 0.5) * y * 2 * pi * moment, 1e-8);
}

TEST(Irreciprocal, HasTheDistancesOfTheLiteratureThatItHasAsAFunction) {
  const std::vector<Material> materials{parse_material("zeltner_sheen:alpha=0.5"), parse_material("lambert:scale=0.5")};
  for (const auto metric : {LiteratureMetric::ngan_l2, LiteratureMetric::log_relative,
                            LiteratureMetric::albedo_of_difference, LiteratureMetric::cube_root_l2}) {
    const auto formulas = compare(device(), {materials[0], materials[1]}, metric);
    const auto functions =
        compare(device(), {as_function(device(), materials[0]), as_function(device(), materials[1])}, metric);
    ASSERT_EQ(formulas.route, Route::formulas) << static_cast<int>(metric);
    ASSERT_EQ(functions.route, Route::functions) << static_cast<int>(metric);
    const double error = formulas.combined.distance_error(0, 1) + functions.combined.distance_error(0, 1);
    EXPECT_NEAR(formulas.combined.distance(0, 1), functions.combined.distance(0, 1), error) << static_cast<int>(metric);
    EXPECT_LE(error, 0.01 * formulas.combined.distance(0, 1)) << static_cast<int>(metric);
  }
}

// Against Gauss rules over N.L, N.V and the azimuth that are graded towards 0 and have 8 or 6 nodes per panel, which
// agree to 1e-10. Below alpha = 0.1 the lobe is a ridge at grazing angles that no panel follows, and errors are larger.
TEST(Irreciprocal, HasThePointNormsOfAnIndependentQuadrature) {
  struct Sheen {
    std::string text;
    double norm, enough;
  };
  for (const auto& [text, norm, enough] :
       {Sheen{"zeltner_sheen:alpha=0.01", 7.0765683062e-4, 0.2}, Sheen{"zeltner_sheen:alpha=0.04", 0.25001310132, 0.01},
        Sheen{"zeltner_sheen:alpha=0.1", 0.62904390827, 1e-3}, Sheen{"zeltner_sheen:alpha=0.3", 0.36718503865, 1e-6}}) {
    const Metric found = measure(device(), {parse_material(text)}, Lighting::point()).combined;
    EXPECT_NEAR(found.norm(0), norm, found.norm_error(0)) << text;
    EXPECT_LE(found.norm_error(0), enough * norm) << text;
  }
}

// One number by three routes.
TEST(Irreciprocal, HasTheSameProductsByEveryRoute) {
  const Material sheen = parse_material("zeltner_sheen:alpha=0.3");
  const Material other = parse_material("ggx:alpha=0.5");
  for (const Lighting& lighting : {Lighting::point(), Lighting::daylight()}) {
    const Metric formulas = measure(device(), {sheen, other}, lighting).combined;
    for (const auto& options :
         {MetricOptions{.route = Route::functions}, MetricOptions{.grid = HemisphereGrid::gauss(64, 128)}}) {
      const Metric found = measure(device(), {sheen, other}, lighting, options).combined;
      EXPECT_NEAR(found.gram(0, 1), formulas.gram(0, 1), found.gram_error(0, 1) + formulas.gram_error(0, 1))
          << lighting.name();
      EXPECT_NEAR(found.gram(0, 0), formulas.gram(0, 0), found.gram_error(0, 0) + formulas.gram_error(0, 0))
          << lighting.name();
      EXPECT_LE(found.gram_error(0, 1), 0.05 * formulas.gram(0, 1)) << lighting.name();
    }
    EXPECT_LE(formulas.gram_error(0, 0), 1e-5 * formulas.gram(0, 0)) << lighting.name();
  }
}

}  // namespace
}  // namespace lobe::test
