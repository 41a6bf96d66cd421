// Products up to a largest angle: of formulas, functions and tables, against closed forms and the reference.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "metric/routes.hpp"
#include "metric/table_metric.hpp"
#include "reference/domain.hpp"
#include "reference/models.hpp"
#include "support/device.hpp"
#include "support/functions.hpp"
#include "support/materials.hpp"
#include "support/measured_data.hpp"
#include "support/names.hpp"
#include "support/tables.hpp"

namespace lobe::test {
namespace {

using reference::Lobe;
using reference::Real;
using reference::Vector;
using std::numbers::pi;
using ::testing::HasSubstr;

/// Of f = 1/pi: projected solid angles up to theta have pi sin^2(theta), so that albedos are sin^2(theta).
double lambert_square(const Lighting& lighting, double theta_max) {
  const double sine2 = std::pow(std::sin(theta_max), 2);
  if (lighting == Lighting::point()) return sine2 * sine2;
  if (lighting == Lighting::daylight()) return pi * std::pow(sine2, 3);
  return pi * pi * std::pow(sine2, 4);
}

const std::vector<Lighting>& lightings() {
  static const std::vector<Lighting> kLightings{Lighting::point(), Lighting::daylight(), Lighting::mean_albedo()};
  return kLightings;
}

/// A material, and the same by the reference.
struct DomainCase {
  std::string specification;
  Lobe lobe;
};

std::ostream& operator<<(std::ostream& stream, const DomainCase& c) {
  return stream << c.specification;
}

/// What has kinks within the domain: attenuation (2.10), R.V = 0, and a lobe that grows at grazing angles.
std::vector<DomainCase> cases() {
  return {{"lambert:scale=0.5", {[](const Vector& l, const Vector& v) { return 0.5L * reference::lambert(l, v); }, 1}},
          {"ward:m=0.2", {[](const Vector& l, const Vector& v) { return reference::ward(l, v, 0.2L); }, 0.2}},
          {"cook_torrance:m=0.3,f0=0.5",
           {[](const Vector& l, const Vector& v) { return reference::cook_torrance(l, v, 0.3L, 0.5L); }, 0.3}},
          {"phong:n=3", {[](const Vector& l, const Vector& v) { return reference::phong(l, v, 3); }, 0.5}}};
}

class Domain : public ::testing::TestWithParam<double> {
 protected:
  static double theta_max() { return GetParam() * kDegree; }
};

/// What the rules of the reference resolve: not towards the horizon, where closed forms speak for the rest.
class DomainOfReference : public Domain {};

INSTANTIATE_TEST_SUITE_P(property, Domain, ::testing::Values(80.0, 37.0, 89.9),
                         [](const auto& instance) { return test_name(std::to_string(instance.param)); });
INSTANTIATE_TEST_SUITE_P(property, DomainOfReference, ::testing::Values(80.0, 37.0),
                         [](const auto& instance) { return test_name(std::to_string(instance.param)); });

TEST_P(Domain, OfLambertIsThatOfTheClosedForm) {
  for (const Lighting& lighting : lightings()) {
    SCOPED_TRACE(lighting.name());
    const double expected = lambert_square(lighting, theta_max());
    const auto formulas = measure(device(), parse_all({"lambert"}), lighting, {.theta_max = theta_max()});
    EXPECT_NEAR(formulas.combined.gram(0, 0), expected, formulas.combined.gram_error(0, 0)) << lighting.name();
    EXPECT_LT(formulas.combined.gram_error(0, 0), 1e-6 * expected) << lighting.name();
    EXPECT_EQ(formulas.theta_max, theta_max());

    const std::vector<BrdfFunction> functions{function_of([](const Directions&) { return 1 / pi; })};
    const auto function = measure_functions(functions, lighting, {.lobe_width = 0.1, .theta_max = theta_max()});
    EXPECT_NEAR(function.combined.gram(0, 0), expected, function.combined.gram_error(0, 0)) << lighting.name();
    EXPECT_LT(function.combined.gram_error(0, 0), 1e-3 * expected) << lighting.name();
    EXPECT_EQ(function.theta_max, theta_max());

    for (const char* grid : {"gauss:16x32", "uniform:17x8"}) {
      SCOPED_TRACE(grid);
      const std::vector<BrdfTable> tables{table_of("lambert", grid)};
      const auto table = measure(device(), tables, lighting, {.theta_max = theta_max()});
      EXPECT_NEAR(table.combined.gram(0, 0), expected, table.combined.gram_error(0, 0)) << lighting.name() << grid;
      EXPECT_LT(table.combined.gram_error(0, 0), 1e-9 * expected) << lighting.name() << grid;
      EXPECT_EQ(table.theta_max, theta_max());
    }
  }
}

TEST_P(DomainOfReference, IsThatOfFormulas) {
  const auto list = cases();
  std::vector<Material> materials;
  for (const auto& c : list) materials.push_back(parse_material(c.specification));
  const auto point = measure(device(), materials, Lighting::point(), {.theta_max = theta_max()}).combined;
  const auto daylight = measure(device(), materials, Lighting::daylight(), {.theta_max = theta_max()}).combined;
  const auto mean = measure(device(), materials, Lighting::mean_albedo(), {.theta_max = theta_max()}).combined;
  // Rules of fixed panels take kinks as they come: to 3e-4, measured by the next higher orders.
  constexpr double kReference = 5e-4;
  constexpr int kOrder = 5;
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const auto a = static_cast<Eigen::Index>(i);
      const auto b = static_cast<Eigen::Index>(j);
      const auto expect = [&](const Metric& found, double expected) {
        EXPECT_NEAR(found.gram(a, b), expected, kReference * found.norm(a) * found.norm(b)) << list[i] << list[j];
        EXPECT_LT(found.gram_error(a, b), 2e-6 * found.gram(a, b)) << list[i] << list[j];
      };
      expect(point, reference::point_product_up_to(theta_max(), list[i].lobe, list[j].lobe, kOrder));
      if (i != j) continue;
      expect(daylight, reference::daylight_product_up_to(theta_max(), list[i].lobe, list[j].lobe, kOrder));
      expect(mean, reference::mean_albedo_product_up_to(theta_max(), list[i].lobe, list[j].lobe, kOrder));
    }
  }
}

TEST_P(Domain, OfFunctionsAndTablesIsThatOfFormulas) {
  const std::vector<std::string> texts{"lambert:scale=0.5", "ward:m=0.3", "phong:n=3"};
  std::vector<BrdfFunction> functions;
  std::vector<BrdfTable> tables;
  for (const auto& text : texts) {
    functions.push_back(as_function(device(), parse_material(text)));
    tables.push_back(table_of(text, "gauss:32x64"));
  }
  for (const Lighting& lighting : lightings()) {
    const Metric exact = measure(device(), parse_all(texts), lighting, {.theta_max = theta_max()}).combined;
    const Metric function =
        measure_functions(functions, lighting, {.lobe_width = 0.1, .theta_max = theta_max()}).combined;
    const Metric table = measure(device(), tables, lighting, {.theta_max = theta_max()}).combined;
    for (Eigen::Index i = 0; i < 3; ++i) {
      SCOPED_TRACE(i);
      for (Eigen::Index j = 0; j < 3; ++j) {
        SCOPED_TRACE(j);
        for (const Metric* found : {&function, &table}) {
          EXPECT_NEAR(found->gram(i, j), exact.gram(i, j), found->gram_error(i, j) + exact.gram_error(i, j))
              << lighting.name() << i << j << (found == &table);
          EXPECT_NEAR(found->distance(i, j), exact.distance(i, j),
                      found->distance_error(i, j) + exact.distance_error(i, j));
          // Ward's lobe grows as cos^-1/2, which rings do not resolve so near to the horizon.
          const double known = GetParam() > 80 ? 0.11 : 1.2e-2;
          EXPECT_LT(found->gram_error(i, j), known * exact.norm(i) * exact.norm(j)) << lighting.name() << i << j;
        }
      }
    }
  }
}

TEST(DomainOfProducts, OfDrawnOutLobesOfEqualWidthsIsThatOfRoundOnes) {
  const auto materials = parse_all({"ward:m=0.2", "ward_anisotropic:m_x=0.2,m_y=0.2"});
  for (const Lighting& lighting : lightings()) {
    SCOPED_TRACE(lighting.name());
    const auto found = measure(device(), materials, lighting, {.tolerance = 1e-4, .theta_max = 80 * kDegree}).combined;
    EXPECT_NEAR(found.gram(0, 0), found.gram(1, 1), found.gram_error(0, 0) + found.gram_error(1, 1));
    EXPECT_LT(found.gram_error(1, 1), 2e-4 * found.gram(1, 1)) << lighting.name();
  }
}

TEST(DomainOfProducts, OfPatchesIsThatOfTheirCommonAreas) {
  const double theta_max = 80 * kDegree;
  const auto found = measure(device(), parse_all({"basic_patch:R=0.4"}), Lighting::point(), {.theta_max = theta_max});
  const double expected = reference::patch_square_up_to(theta_max, 0.4);
  EXPECT_NEAR(found.combined.gram(0, 0), expected, found.combined.gram_error(0, 0) + 1e-9 * expected);
  EXPECT_LT(found.combined.gram_error(0, 0), 2e-6 * expected);
  // In a norm of the base plane that is a disc: the rule with panels of azimuths.
  const auto norm = measure(device(), parse_all({"basic_patch_anisotropic:R=0.4,ratio=1"}), Lighting::point(),
                            {.tolerance = 1e-4, .theta_max = theta_max});
  EXPECT_NEAR(norm.combined.gram(0, 0), expected, norm.combined.gram_error(0, 0) + 1e-9 * expected);
}

// 1/(N.L) + 1/(N.V) over 2 pi: the integral of 1/cos^2 dmu is -2 pi ln cos(theta_max), that of 1/cos dmu 2 pi (1 -
// cos(theta_max)).
TEST_P(Domain, GivesNormsToFormulasThatHaveNone) {
  const auto materials = parse_all({"lambert*power_mean:p=-1"});
  EXPECT_THROW((void)measure(device(), materials, Lighting::point()), NumericError);
  const double cosine = std::cos(theta_max());
  const double sine2 = 1 - cosine * cosine;
  const auto point = measure(device(), materials, Lighting::point(), {.theta_max = theta_max()}).combined;
  const double square = -std::log(cosine) * sine2 + 2 * std::pow(1 - cosine, 2);
  EXPECT_NEAR(point.gram(0, 0), square, point.gram_error(0, 0));
  EXPECT_LT(point.gram_error(0, 0), 2e-6 * square);
  // The albedo is sin^2 / (2 cos(theta)) + 1 - cos(theta_max).
  const auto daylight = measure(device(), materials, Lighting::daylight(), {.theta_max = theta_max()}).combined;
  const double squares = pi * (-std::log(cosine) * sine2 * sine2 / 2 + 2 * sine2 * std::pow(1 - cosine, 2) +
                               sine2 * std::pow(1 - cosine, 2));
  EXPECT_NEAR(daylight.gram(0, 0), squares, daylight.gram_error(0, 0));
  EXPECT_LT(daylight.gram_error(0, 0), 2e-6 * squares);
}

/// 0.01 / (N.L N.V)^power.
Material own_formula(double power) {
  Term term;
  term.model = kCustomModel;
  term.formula = Formula{.text = "s / pow(cos_i * cos_o, p)", .parameters = {"s", "p"}};
  term.values = {0.01, power};
  term.weight = {1.0};
  return {.name = "own", .family = "custom", .terms = {term}};
}

// Over the hemisphere: |f| = s 2 pi / (2 - 2p) by point light, s 2 pi / (2 - p) (2 pi / (2 - 2p))^1/2 by daylight.
TEST(NormsOfOwnFormulas, HoldOrAreRefusedWhereTheyGrowTowardsTheHorizon) {
  for (const double p : {0.7, 0.9}) {
    const std::vector<Material> materials{own_formula(p)};
    const double point = 0.01 * 2 * pi / (2 - 2 * p);
    const double daylight = 0.01 * 2 * pi / (2 - p) * std::sqrt(2 * pi / (2 - 2 * p));
    for (const auto& [lighting, expected] : {std::pair{Lighting::point(), point}, {Lighting::daylight(), daylight}}) {
      const Metric found = measure(device(), materials, lighting, {.tolerance = 1e-5}).combined;
      EXPECT_NEAR(found.norm(0), expected, found.norm_error(0)) << lighting.name() << p;
      EXPECT_LT(found.norm_error(0), 0.05 * expected) << lighting.name() << p;  // else it would say nothing
    }
  }
  const std::vector<Material> infinite{own_formula(1)};
  for (const Lighting& lighting :
       {Lighting::point(), Lighting::daylight(), Lighting::patch(0.5), Lighting::material(parse_material("lambert"))}) {
    EXPECT_THROW((void)measure(device(), ReflectanceList{infinite.front()}, lighting), NumericError) << lighting.name();
  }
  const Metric mean = measure(device(), infinite, Lighting::mean_albedo()).combined;
  EXPECT_NEAR(mean.norm(0), 0.01 * 4 * pi * pi, mean.norm_error(0) + 1e-12);
  const Metric confined = measure(device(), infinite, Lighting::point(), {.theta_max = 80 * kDegree}).combined;
  EXPECT_NEAR(confined.norm(0), -0.01 * 2 * pi * std::log(std::cos(80 * kDegree)), confined.norm_error(0) + 1e-12);
}

// W of the widest patch light is the same between all directions, 1/pi.
TEST(NormsOfOwnFormulas, HoldUnderPatchLightsWhereTheyGrowTowardsTheHorizon) {
  const double p = 0.9;
  const double expected = 0.01 * 2 * pi / (2 - p) * std::sqrt(2 / (2 - 2 * p));
  const Metric found =
      measure(device(), {Reflectance(own_formula(p))}, Lighting::patch(2), {.patch_tolerance = 1e-3}).combined;
  EXPECT_NEAR(found.norm(0), expected, found.norm_error(0));
  EXPECT_LT(found.norm_error(0), 0.05 * expected);  // else it would say nothing
}

// By the route of functions, which compositions take.
TEST(NormsOfOwnFormulas, HoldAsFunctionsWhereTheyGrowTowardsTheHorizon) {
  const double p = 0.9;
  const Metric found = measure(device(), {Reflectance(own_formula(p))}, Lighting::point(),
                               {.route = Route::functions, .function_tolerance = 0.02})
                           .combined;
  EXPECT_NEAR(found.norm(0), 0.01 * 2 * pi / (2 - 2 * p), found.norm_error(0));
}

TEST(DomainOfProducts, EndsOnTheLimitOfARingOfCells) {
  const std::vector<BrdfTable> tables{table_of("lambert", "klems:145", TableForm::general)};
  for (const Lighting& lighting : {Lighting::daylight(), Lighting::mean_albedo()}) {
    SCOPED_TRACE(lighting.name());
    const auto found = measure(device(), tables, lighting, {.theta_max = 75 * kDegree});
    EXPECT_NEAR(found.combined.gram(0, 0), lambert_square(lighting, 75 * kDegree), 1e-12);
  }
  const auto point = measure(device(), tables, Lighting::point(), {.theta_max = 75 * kDegree});
  EXPECT_NEAR(point.combined.gram(0, 0), lambert_square(Lighting::point(), 75 * kDegree), 1e-12);
  try {
    (void)measure(device(), tables, Lighting::point(), {.theta_max = 80 * kDegree});
    FAIL() << "80 degrees is within a ring";
  } catch (const ArgumentError& error) {
    EXPECT_STREQ(error.what(),
                 "the domain ends at 80 degrees, within a ring of cells of the grid klems:145; expected the limit of a "
                 "ring, such as 75 or 90");
  }
}

// <lambert, mirror> = sin^2(theta_max): a mirror turns the light by half a turn, and it stays in the domain.
TEST_P(Domain, HoldsOfProductsWithDeltaParts) {
  const double sine2 = std::pow(std::sin(theta_max()), 2);
  const MetricOptions options{.theta_max = theta_max(), .allow_infinite = true};
  const Reflectance table = table_of("lambert", "gauss:16x32");
  const Reflectance mixed = table_of("mirror+lambert:scale=0.3", "gauss:16x32");
  const struct {
    const char* name;
    Reflectance f, g;
    double expected;
  } kCases[]{{"formulas", parse_material("lambert"), parse_material("mirror"), sine2},
             {"table and mirror", table, parse_material("mirror"), sine2},
             {"mirror and table", parse_material("mirror"), table, sine2},
             {"table and retro mirror", table, parse_material("rrim"), sine2},
             {"tables", table, mixed, sine2 + 0.3 * sine2 * sine2}};
  for (const auto& c : kCases) {
    const Metric found = measure(device(), ReflectanceList{c.f, c.g}, Lighting::point(), options).combined;
    EXPECT_NEAR(found.gram(0, 1), c.expected, found.gram_error(0, 1) + 1e-14) << c.name;  // rounding of sine2
    EXPECT_LT(found.gram_error(0, 1), 1e-6 * c.expected) << c.name;  // of the formulas, by their tolerance
  }
}

TEST(DomainOfProducts, IsRefusedUnderPatchLightsAndOutOfRange) {
  const auto materials = parse_all({"lambert"});
  EXPECT_THROW((void)measure(device(), materials, Lighting::patch(0.5), {.theta_max = 1}), ArgumentError);
  EXPECT_THROW((void)measure(device(), materials, Lighting::point(), {.theta_max = 0}), ArgumentError);
  EXPECT_THROW((void)measure(device(), materials, Lighting::point(), {.theta_max = 1.6}), ArgumentError);
  EXPECT_THROW((void)measure(device(), materials, Lighting::point(), {.theta_max = std::nan("")}), ArgumentError);
  const std::vector<BrdfTable> tables{table_of("lambert", "gauss:8x16")};
  EXPECT_THROW((void)measure(device(), tables, Lighting::patch(0.5), {.theta_max = 1}), ArgumentError);
}

/// f = cos(theta_out)^-power / pi.
BrdfFunction growing(double power) {
  return function_of([power](const Directions& pair) { return std::pow(std::cos(pair.theta_out), -power) / pi; });
}

std::string complaint_of(const BrdfFunction& function, const Lighting& lighting) {
  try {
    (void)measure_functions(std::vector<BrdfFunction>{function}, lighting, {.lobe_width = 0.1});
  } catch (const NumericError& error) {
    return error.what();
  }
  return "";
}

// Every decade of the cosine adds ln(10) 2 / pi to the squared norm of 1/(pi cos).
TEST(DomainOfProducts, IsOfferedWhereANormDoesNotExist) {
  for (const Lighting& lighting : {Lighting::point(), Lighting::daylight()}) {
    SCOPED_TRACE(lighting.name());
    EXPECT_EQ(complaint_of(growing(1), lighting),
              "the norm of 'formula' under lighting '" + lighting.name() +
                  "' is infinite: every decade of cos(theta) towards the horizon adds as much to it; 'mean-albedo' "
                  "takes it, or measure it up to a largest angle, such as 80 degrees");
    EXPECT_THAT(complaint_of(growing(1.5), lighting), HasSubstr("is infinite"));
    // A decade adds 0.87 of what the one before did, and 0.76: the first sum is 50 decades long, the other 8.
    EXPECT_THAT(complaint_of(growing(0.97), lighting), HasSubstr("is infinite"));
    EXPECT_EQ(complaint_of(growing(0.94), lighting), "");
    EXPECT_EQ(complaint_of(growing(0.25), lighting), "");
    EXPECT_EQ(complaint_of(growing(0), lighting), "");
  }
  EXPECT_EQ(complaint_of(growing(1), Lighting::mean_albedo()), "");
  // Under light that has no domains, one that has is named.
  try {
    (void)measure(device(), {parse_material("lambert*cos_max:p=1+ward_duer:m=0.3")}, Lighting::patch(0.5));
    FAIL() << "computed";
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("or measure it under 'point' or 'daylight' up to a largest angle"));
  }
  // A part in a million of it is enough.
  const auto little = function_of([](const Directions& pair) { return 1 + 1e-6 / std::cos(pair.theta_in); });
  EXPECT_THAT(complaint_of(little, Lighting::point()), HasSubstr("is infinite"));
  // Albedos by V are integrals over L, which exist.
  EXPECT_EQ(complaint_of(little, Lighting::daylight()), "");
  // Single precision's pi/2 is none.
  const auto rounded = function_of(
      [](const Directions& pair) { return (std::cos(pair.theta_out) + 4.4e-8) / std::cos(pair.theta_out); });
  EXPECT_EQ(complaint_of(rounded, Lighting::point()), "");
}

TEST(DomainOfProducts, GivesNormsToFunctionsThatHaveNone) {
  const double theta_max = 80 * kDegree;
  const std::vector<BrdfFunction> functions{growing(1), growing(0)};
  const Metric point =
      measure_functions(functions, Lighting::point(), {.lobe_width = 0.1, .theta_max = theta_max}).combined;
  const double sine2 = std::pow(std::sin(theta_max), 2);
  // Integrals of 1/cos dw and of dw, times pi sin^2 of the other direction.
  EXPECT_NEAR(point.gram(0, 0), -2 * std::log(std::cos(theta_max)) * sine2, point.gram_error(0, 0));
  EXPECT_NEAR(point.gram(0, 1), 2 * (1 - std::cos(theta_max)) * sine2, point.gram_error(0, 1));
  EXPECT_LT(point.gram_error(0, 0), 1e-3);
}

/// They store f cos(theta_o), which is not 0 at the horizon.
class RglFiles : public MeasuredData {
 protected:
  RglFiles() : MeasuredData("rgl_bsdf") {}
};

TEST_F(RglFiles, HaveNoNormsButUpToALargestAngle) {
  const auto file = load_measured(data_ / "vch_golden_yellow_rgb.bsdf", {.luminance = "rec709"});
  EXPECT_THAT(complaint_of(file, Lighting::point()), HasSubstr("is infinite"));
  EXPECT_THAT(complaint_of(file, Lighting::daylight()), HasSubstr("is infinite"));
  EXPECT_EQ(complaint_of(file, Lighting::mean_albedo()), "");
}

}  // namespace
}  // namespace lobe::test
