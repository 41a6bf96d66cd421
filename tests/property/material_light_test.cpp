// Products under light of the pattern of a reflectance: in closed form, and against (5.23) taken literally.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "reference/models.hpp"
#include "reference/pattern_product.hpp"
#include "support/device.hpp"
#include "support/materials.hpp"
#include "support/measured_data.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

using reference::Vector;
using std::numbers::pi;

using PairFormula = std::function<reference::Real(const Vector&, const Vector&)>;

/// A reflectance by the library's name, and by the reference.
struct Known {
  std::string specification;
  PairFormula formula;
};

const Known kLambert{"lambert", reference::lambert};
const Known kPhong{"phong:n=20", [](const Vector& l, const Vector& v) { return reference::phong(l, v, 20); }};
const Known kSharpPhong{"phong:n=5000", [](const Vector& l, const Vector& v) { return reference::phong(l, v, 5000); }};
const Known kWidePhong{"phong:n=5", [](const Vector& l, const Vector& v) { return reference::phong(l, v, 5); }};
const Known kWard{"ward_anisotropic:m_x=0.4,m_y=0.6,rotation=0.3",
                  [](const Vector& l, const Vector& v) { return reference::ward_anisotropic(l, v, 0.4L, 0.6L, 0.3L); }};
const Known kSum{"lambert:scale=0.5+phong:n=8,scale=0.4", [](const Vector& l, const Vector& v) {
                   return 0.5L * reference::lambert(l, v) + 0.4L * reference::phong(l, v, 8);
                 }};
const Known kDrawnOut{"ward_anisotropic:m_x=0.5,m_y=0.8", [](const Vector& l, const Vector& v) {
                        return reference::ward_anisotropic(l, v, 0.5L, 0.8L, 0);
                      }};

reference::PairValues pair_values(const PairFormula& formula) {
  return [formula](std::span<const Directions> pairs) {
    std::vector<double> values;
    values.reserve(pairs.size());
    for (const Directions& pair : pairs) {
      values.push_back(static_cast<double>(formula(reference::light_of(pair), reference::view_of(pair))));
    }
    return values;
  };
}

Metric measured_under(const std::vector<Reflectance>& reflectances, const std::string& eta,
                      const MetricOptions& options = {}) {
  return measure(device(), reflectances, parse_lighting("material:" + eta), options).combined;
}

// Under eta = 1/pi f becomes a_f/pi, whatever the position of the light: Minnaert's k = 1 has the albedo cos(theta).
TEST(MaterialLight, OfDiffusePatternHasTheProductsOfAlbedosOverPi) {
  const Metric found = measured_under({parse_material("lambert"), parse_material("minnaert:k=1")}, "lambert");

  EXPECT_NEAR(found.gram(0, 0), 1, found.gram_error(0, 0));
  EXPECT_NEAR(found.gram(0, 1), 2.0 / 3, found.gram_error(0, 1));
  EXPECT_NEAR(found.gram(1, 1), 0.5, found.gram_error(1, 1));
  EXPECT_LE(found.gram_error.maxCoeff(), 1e-5);
  EXPECT_NEAR(found.distance(0, 1), std::sqrt(1.0 / 6), found.distance_error(0, 1));
}

// Of eta and the diffuse reflectance it is a_eta/pi, the same from everywhere.
TEST(MaterialLight, OnADiffuseReflectanceHasTheDaylightProductOfThePatternOverPi) {
  for (const char* eta : {"phong:n=5", "ward:m=0.3", "metal_phong:n=20"}) {
    const Metric daylight = measure(device(), parse_all({eta}), Lighting::daylight()).combined;

    const Metric found = measured_under({parse_material("lambert")}, eta);

    const double expected = daylight.gram(0, 0) / pi;
    EXPECT_NEAR(found.gram(0, 0), expected, found.gram_error(0, 0) + daylight.gram_error(0, 0) / pi) << eta;
    EXPECT_LE(found.gram_error(0, 0), 1e-4 * expected) << eta;
  }
}

// eta lights the side of the light: of f = cos(theta_o)/pi it makes a_eta cos(theta_o)/pi, the other order would not.
TEST(MaterialLight, StandsBeforeWhatItLights) {
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
  term.formula = Formula{.text = "cos_o / pi", .width = 1, .reciprocal = false};
  const Material towards_the_viewer{"towards the viewer", "", {term}};
  const Metric daylight = measure(device(), parse_all({"phong:n=5"}), Lighting::daylight()).combined;
  const double expected = daylight.gram(0, 0) / (2 * pi);
  for (const Reflectance& f : {Reflectance(tabulate(device(), towards_the_viewer, HemisphereGrid::gauss(32, 64))),
                               Reflectance(as_function(device(), towards_the_viewer))}) {
    const std::string kind = f.table() != nullptr ? "table" : "function";

    const Metric found = measured_under({f}, "phong:n=5");

    EXPECT_NEAR(found.gram(0, 0), expected, found.gram_error(0, 0) + daylight.gram_error(0, 0) / (2 * pi)) << kind;
    EXPECT_LE(found.gram_error(0, 0), 1e-2 * expected) << kind;
  }
}

// With L the projection on constants, (L/2 + I/2)^2 = (3 L + I) / 4.
TEST(MaterialLight, WithARetroReflectingPartAddsPointLight) {
  const std::vector<Reflectance> both{parse_material("phong:n=20"), parse_material("phong:n=5")};
  const Metric point = measure(device(), both, Lighting::point()).combined;
  const Metric daylight = measure(device(), both, Lighting::daylight()).combined;

  const Metric found = measured_under(both, "lambert:scale=0.5+rrim:scale=0.5");

  for (const auto& [i, j] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 1)}) {
    const double expected = (3 * daylight.gram(i, j) / pi + point.gram(i, j)) / 4;
    EXPECT_NEAR(found.gram(i, j), expected, found.gram_error(i, j) + 1e-6 * expected) << i << j;
    EXPECT_LE(found.gram_error(i, j), 1e-2 * expected) << i << j;
  }
}

// A mirror turns f by half a turn, which no product of isotropic reflectances sees.
TEST(MaterialLight, OfAMirrorIsPointLight) {
  const std::vector<Reflectance> both{parse_material("phong:n=20"),
                                      parse_material("ward_anisotropic:m_x=0.4,m_y=0.6,rotation=0.3")};
  const Metric point = measure(device(), both, Lighting::point()).combined;

  const Metric found = measured_under(both, "mirror");

  for (const auto& [i, j] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 1)}) {
    EXPECT_NEAR(found.gram(i, j), point.gram(i, j), found.gram_error(i, j) + point.gram_error(i, j)) << i << j;
    EXPECT_LE(found.gram_error(i, j), 0.2 * point.gram(i, j)) << i << j;
  }
}

// What a mirror makes of the pattern is the pattern turned: its norm is the point norm of eta.
TEST(MaterialLight, GivesMirrorsANormUnlessItHasADeltaPartItself) {
  const std::vector<Reflectance> mirror{parse_material("mirror")};
  const Metric point = measure(device(), parse_all({"phong:n=5"}), Lighting::point()).combined;

  const Metric found = measured_under(mirror, "phong:n=5");

  EXPECT_NEAR(found.gram(0, 0), point.gram(0, 0), found.gram_error(0, 0) + point.gram_error(0, 0));
  EXPECT_LE(found.gram_error(0, 0), 1e-4 * point.gram(0, 0));
  try {
    (void)measured_under(mirror, "phong:n=5+mirror:scale=0.1");
    FAIL() << "computed";
  } catch (const NumericError& error) {
    EXPECT_NE(std::string(error.what()).find("is infinite"), std::string::npos) << error.what();
  }
}

TEST(MaterialLight, RefusesWhatHasNoNorm) {
  for (const auto& [eta, f] : {std::pair("phong:n=5", "ward_duer:m=0.3"), std::pair("ward_duer:m=0.3", "lambert")}) {
    try {
      (void)measured_under({parse_material(f)}, eta);
      FAIL() << eta << " " << f;
    } catch (const NumericError& error) {
      EXPECT_EQ(error.fault(), Fault::infinite_norm) << error.what();
    }
  }
}

/// Pattern, both reflectances, how finely the reference integrates, and the largest error relative to norms.
struct LiteralCase {
  std::string name;
  Known eta, f, g;
  reference::PatternRule rule;
  double largest_error;
};

std::ostream& operator<<(std::ostream& out, const LiteralCase& one) {
  return out << one.name;
}

constexpr reference::PatternRule kSmooth{
    .views = 8, .azimuths = 32, .nodes = 8, .narrowest = 0.3, .patterns = 7, .pattern_turns = 24};
constexpr reference::PatternRule kSharp{
    .views = 8, .azimuths = 32, .nodes = 6, .narrowest = 0.01, .patterns = 7, .pattern_turns = 24};
constexpr reference::PatternRule kTurned{
    .views = 7, .turns = 8, .azimuths = 32, .nodes = 8, .narrowest = 0.5, .patterns = 7, .pattern_turns = 20};

std::vector<LiteralCase> literal_cases() {
  std::vector<LiteralCase> cases{{"lobe", kWidePhong, kLambert, kPhong, kSmooth, 1e-5},
                                 {"sharp", kWidePhong, kLambert, kSharpPhong, kSharp, 1e-4},
                                 {"sum", kSum, kPhong, kWidePhong, kSmooth, 1e-5},
                                 {"anisotropic pattern", kDrawnOut, kLambert, kWard, kTurned, 2e-2}};
  if (full_scale()) cases.push_back({"anisotropic material", kWidePhong, kPhong, kWard, kTurned, 1e-2});
  return cases;
}

class LiteralMaterialLight : public ::testing::TestWithParam<LiteralCase> {};
INSTANTIATE_TEST_SUITE_P(property, LiteralMaterialLight, ::testing::ValuesIn(literal_cases()), [](const auto& test) {
  std::string name = test.param.name;
  std::ranges::replace(name, ' ', '_');
  return name;
});

TEST_P(LiteralMaterialLight, HasTheProductsOfTheDoubleIntegral) {
  const LiteralCase& own = GetParam();
  const auto integral = [&](const reference::PatternRule& rule) {
    return reference::pattern_products(pair_values(own.eta.formula), pair_values(own.f.formula),
                                       pair_values(own.g.formula), rule);
  };
  reference::PatternRule rougher = own.rule;
  rougher.views = own.rule.views * 3 / 4;
  rougher.azimuths = own.rule.azimuths - 8;
  rougher.nodes = own.rule.nodes - 1;
  rougher.patterns = own.rule.patterns - 1;
  rougher.pattern_turns = own.rule.pattern_turns * 3 / 4;
  const std::vector<double> expected = integral(own.rule);
  const std::vector<double> before = integral(rougher);

  const Metric found =
      measured_under({parse_material(own.f.specification), parse_material(own.g.specification)}, own.eta.specification);

  for (const auto& [i, j, at] : {std::tuple(0, 0, 0), std::tuple(0, 1, 1), std::tuple(1, 1, 2)}) {
    const auto k = static_cast<std::size_t>(at);
    const double missed = std::abs(expected[k] - before[k]);
    EXPECT_NEAR(found.gram(i, j), expected[k], found.gram_error(i, j) + 2 * missed) << i << j;
    EXPECT_LE(missed, 2e-4 * expected[k] + 1e-6) << i << j;
    EXPECT_LE(found.gram_error(i, j), own.largest_error * found.norm(i) * found.norm(j)) << i << j;
  }
}

class MeasuredUnderMaterialLight : public MeasuredData {
 protected:
  MeasuredUnderMaterialLight() : MeasuredData("nbrdf") {}
};

TEST_F(MeasuredUnderMaterialLight, HasTheProductsOfTheDoubleIntegral) {
  ReadOptions options;
  options.channels = {"red"};
  const Reflectance file = load_reflectance(data_ / "merl" / "alum-bronze.h5", options);
  const BrdfFunction function = as_function(device(), file);
  const reference::PairValues values = [&](std::span<const Directions> pairs) {
    const BrdfValues found = function.at(pairs);
    std::vector<double> first(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) first[k] = found.value(static_cast<Eigen::Index>(k), 0);
    return first;
  };
  const auto integral = [&](int views, int azimuths) {
    return reference::pattern_products(
        pair_values(kWidePhong.formula), values, pair_values(kLambert.formula),
        {.views = views, .azimuths = azimuths, .nodes = 6, .patterns = 6, .pattern_turns = 20});
  };
  const std::vector<double> expected = integral(20, 48);
  const std::vector<double> before = integral(14, 36);

  const Metric found = measured_under({file, parse_material("lambert")}, "phong:n=5");

  for (const auto& [i, j, at] : {std::tuple(0, 0, 0), std::tuple(0, 1, 1)}) {
    const auto k = static_cast<std::size_t>(at);
    const double missed = std::abs(expected[k] - before[k]);
    EXPECT_NEAR(found.gram(i, j), expected[k], found.gram_error(i, j) + missed) << i << j;
    EXPECT_LE(missed, 2e-3 * expected[k]) << i << j;
    EXPECT_LE(found.gram_error(i, j), 2e-2 * found.norm(i) * found.norm(j)) << i << j;
    // The reference's own error is part of the difference.
    EXPECT_LE(found.gram_error(i, j), 20 * std::abs(found.gram(i, j) - expected[k])) << i << j;
  }
}

TEST(MaterialLight, HasNoNegativeSquares) {
  std::vector<Reflectance> all;
  for (const char* text : {"lambert", "phong:n=5", "phong:n=5.1", "phong:n=20", "ward:m=0.4", "minnaert:k=1",
                           "lambert:scale=0.3+mirror*fresnel:ior=1.5,k=0", "lambert:scale=0.5"}) {
    all.emplace_back(parse_material(text));
  }
  for (const char* eta : {"phong:n=3", "lambert:scale=0.5+phong:n=20"}) {
    const Metric found = measured_under(all, eta);

    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(found.gram);

    EXPECT_GE(parts.eigenvalues()(0), -1e-13 * parts.eigenvalues().tail(1)(0)) << eta;
  }
}

// Patches as lights are patch lights, whose products come by another route, which a sum of two halves does not take;
// their jumps leave larger errors.
TEST(MaterialLight, OfAPatchIsPatchLight) {
  const std::vector<Reflectance> both{parse_material("phong:n=5"), parse_material("lambert:scale=0.5")};
  MetricOptions options;
  options.patch_tolerance = 1e-2;
  const Metric patch = measure(device(), both, Lighting::patch(0.8)).combined;

  const Metric found = measured_under(both, "basic_patch:R=0.8,scale=0.5+basic_patch:R=0.8,scale=0.5", options);

  for (const auto& [i, j] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 1)}) {
    EXPECT_NEAR(found.gram(i, j), patch.gram(i, j), found.gram_error(i, j) + patch.gram_error(i, j)) << i << j;
    EXPECT_LE(found.gram_error(i, j), 5e-2 * found.norm(i) * found.norm(j)) << i << j;
  }
  EXPECT_NEAR(found.distance(0, 1), patch.distance(0, 1), found.distance_error(0, 1) + patch.distance_error(0, 1));
}

// W is quadratic in the pattern.
TEST(MaterialLight, OfOneBasicPatchIsMeasuredAsPatchLight) {
  const std::vector<Reflectance> one{parse_material("phong:n=5")};
  const Lighting lighting = parse_lighting("material:basic_patch:R=0.8,scale=-3");
  MetricOptions options;
  options.patch_tolerance = 1e-2;

  const MetricResult found = measure(device(), one, lighting, options);

  EXPECT_EQ(found.lighting, lighting);
  EXPECT_EQ(found.route, Route::formulas);
  EXPECT_EQ(found.combined.gram, measure(device(), one, Lighting::mixture({{0.8, 9}}), options).combined.gram);
  // Tables may be not reciprocal, and grids are asked for.
  const HemisphereGrid grid = HemisphereGrid::gauss(6, 12);
  EXPECT_EQ(measure(device(), {tabulate(device(), one[0], grid)}, lighting, options).route, Route::tables);
  options.grid = grid;
  EXPECT_EQ(measure(device(), one, lighting, options).route, Route::tables);
}

// Lobes as narrow as the rings of a grid are apart: what they make of each other is a ridge that its rules just see.
TEST(MaterialLight, StatesErrorsThatAreLargeEnoughOnAGridThatIsTooCoarse) {
  double tightest = 1e9;
  for (const char* lobe : {"phong:n=300", "phong:n=1000"}) {
    const std::vector<Reflectance> one{parse_material(lobe)};
    MetricOptions options;
    options.patch_tolerance = 1e-3;
    const Metric fine = measured_under(one, lobe, options);
    for (const char* grid : {"gauss:6x12", "gauss:8x16", "gauss:12x24"}) {
      options.grid = HemisphereGrid::parse(grid);

      const Metric found = measured_under(one, lobe, options);

      const double error = std::abs(found.gram(0, 0) - fine.gram(0, 0));
      EXPECT_LE(error, found.gram_error(0, 0) + fine.gram_error(0, 0)) << lobe << " " << grid;
      if (error > 10 * fine.gram_error(0, 0)) tightest = std::min(tightest, found.gram_error(0, 0) / error);
    }
  }
  EXPECT_LE(tightest, 30);
}

// (5.25): the product with the identity is |f|_W, the integral of f W; under eta that is the trace of eta f eta*.
TEST(MaterialLight, HasTheWeightedMeanAlbedoAsTheProductWithTheIdentity) {
  const std::vector<Reflectance> both{parse_material("minnaert:k=1"), parse_material("rrim")};

  const Metric found = measured_under(both, "lambert");

  EXPECT_NEAR(found.gram(0, 1), 2.0 / 3, found.gram_error(0, 1));
  EXPECT_NEAR(found.gram(1, 1), 1, found.gram_error(1, 1));
}

TEST(MaterialLight, TakesOneChannelOnly) {
  EXPECT_THROW((void)parse_lighting("material:phong:n=5/6/7"), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
