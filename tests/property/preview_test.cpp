// Spheres of materials: against the reference's midpoints, closed forms, albedos by other ways, and their own errors.
#include "lobe/render/preview.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "energy/prepare.hpp"
#include "lobe/core/colour.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/plot/preview_sheet.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "reference/models.hpp"
#include "reference/sphere.hpp"
#include "support/deviation.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

using reference::Real;
using reference::Vector;
using std::numbers::pi;
using ::testing::HasSubstr;

constexpr int kSize = 24;

SphereImage rendered(const std::string& text, const SphereLighting& lighting, std::size_t size = kSize) {
  return render_sphere(device(), prepare(device(), parse_material(text)), lighting, {.size = size});
}

Eigen::Index pixel(int row, int column) {
  return Eigen::Index{row} * kSize + column;
}

/// By how much errors are above what an image states, where its radiance is to be `level`.
double excess_over(const SphereImage& image, double level) {
  const Eigen::ArrayXd difference = image.radiance.row(0).transpose() - level * image.coverage;
  return (difference.abs() - image.error.row(0).transpose().array()).maxCoeff();
}

/// The middle of a pixel, as the normal there.
Vector normal_at(int row, int column) {
  const Real x = (2 * column + 1 - kSize) / Real{kSize};
  const Real y = (kSize - 2 * row - 1) / Real{kSize};
  return {x, y, std::sqrt(1 - x * x - y * y)};
}

/// A material that the reference knows, too.
struct SphereCase {
  std::string text;
  reference::SphereReflectance f;
};

std::ostream& operator<<(std::ostream& out, const SphereCase& one) {
  return out << one.text;
}

class Sphere : public ::testing::TestWithParam<SphereCase> {};

const std::vector<std::array<int, 2>> kPixels{{11, 12}, {5, 6}, {7, 7}, {3, 14}, {16, 20}, {12, 23}, {1, 7}, {0, 12}};

TEST_P(Sphere, UnderPointLightsIsThatOfTheReference) {
  const SphereLighting lighting = three_point_lights();
  std::vector<reference::SphereLight> lights;
  for (const auto& [direction, irradiance] : lighting.points) {
    lights.push_back({reference::normalised({direction[0], direction[1], direction[2]}), irradiance});
  }
  const auto radiance = reference::under_lights(GetParam().f, lights);

  const SphereImage image = rendered(GetParam().text, lighting);

  Deviation deviation;
  for (const auto& [row, column] : kPixels) {
    constexpr int kSteps = 60;
    const auto expected = static_cast<double>(reference::pixel_mean(radiance, kSize, row, column, kSteps));
    const auto coarser = static_cast<double>(reference::pixel_mean(radiance, kSize, row, column, kSteps / 2));
    // Midpoints are off by about as much as by halving their number, more at the outline, which they step over.
    const double tolerance =
        image.error(0, pixel(row, column)) + 2 * std::abs(expected - coarser) + 1e-3 * expected / kSteps;
    deviation.add(std::abs(image.radiance(0, pixel(row, column)) - expected), tolerance + 1e-12,
                  std::to_string(row) + ", " + std::to_string(column));
  }
  deviation.report(GetParam().text);
  EXPECT_LE(deviation.worst(), 1);
}

TEST_P(Sphere, UnderDaylightIsThatOfTheReference) {
  const SphereImage image = rendered(GetParam().text, homogeneous_daylight());

  Deviation deviation;
  for (const auto& place : std::vector<std::array<int, 2>>{{11, 12}, {5, 6}, {4, 16}, {13, 21}}) {
    const int row = place[0];
    const int column = place[1];
    const auto at = [&](int steps) {
      return static_cast<double>(
          reference::pixel_mean(reference::under_sky(GetParam().f, steps), kSize, row, column, 3));
    };
    constexpr int kSteps = 60;
    const double expected = at(kSteps);
    // Nine midpoints of a pixel are off by its curvature.
    const double tolerance = image.error(0, pixel(row, column)) + std::abs(expected - at(kSteps / 2)) + 1e-3 * expected;
    deviation.add(std::abs(image.radiance(0, pixel(row, column)) - expected), tolerance,
                  std::to_string(row) + ", " + std::to_string(column));
  }
  deviation.report(GetParam().text);
  EXPECT_LE(deviation.worst(), 1);
}

INSTANTIATE_TEST_SUITE_P(
    Materials, Sphere,
    ::testing::Values(
        SphereCase{"lambert", reference::lambert},
        SphereCase{"phong:n=20", [](const Vector& l, const Vector& v) { return reference::phong(l, v, 20); }},
        SphereCase{"ward:m=0.15", [](const Vector& l, const Vector& v) { return reference::ward(l, v, 0.15L); }},
        SphereCase{"oren_nayar:sigma=0.5",
                   [](const Vector& l, const Vector& v) { return reference::oren_nayar(l, v, 0.5L, 0.33L); }},
        SphereCase{
            "ward_anisotropic:m_x=0.1,m_y=0.3,rotation=0.4",
            [](const Vector& l, const Vector& v) { return reference::ward_anisotropic(l, v, 0.1L, 0.3L, Real(0.4)); }}),
    [](const auto& tested) { return tested.param.text.substr(0, tested.param.text.find(':')); });

TEST(SphereImage, CoversPixelsByAreasThatAddUpToTheDisc) {
  for (const std::size_t size : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{24}}) {
    SCOPED_TRACE(size);
    const SphereImage image = rendered("lambert", homogeneous_daylight(), size);
    EXPECT_NEAR(image.coverage.sum() * 4 / static_cast<double>(size * size), pi, 1e-12) << size;
    EXPECT_LE(image.coverage.maxCoeff(), 1 + 1e-12);
  }
}

TEST(SphereImage, OfLambertUnderDaylightHasTheRadianceOfItsAlbedo) {
  const SphereImage image = rendered("lambert:scale=0.7", homogeneous_daylight());
  EXPECT_LT(excess_over(image, 0.7), 1e-9);
  EXPECT_LT(image.error.maxCoeff(), 1.0 / 512);
}

TEST(SphereImage, OfLambertUnderOneLightCollectsTheLightOfAHalfMoon) {
  // The integral of (N.L)+ over the picture of a sphere, with an angle a between light and viewer:
  // 2/3 (sin a + (pi - a) cos a), Lambert's phase law.
  const double a = 1.1;
  const SphereImage image = rendered("lambert", {.points = {{{std::sin(a), 0, std::cos(a)}, 3.0}}});
  const double expected = 3.0 / pi * 2 / 3 * (std::sin(a) + (pi - a) * std::cos(a));
  EXPECT_NEAR(image.radiance.sum() * 4 / (kSize * kSize), expected, 1e-4 * expected);
}

TEST(SphereImage, InAWhiteFurnaceShowsAlbedos) {
  for (const char* const text : {"ward:m=0.05", "metal_phong:n=50", "basic_patch:R=0.4", "cook_torrance:m=0.3"}) {
    const Material material = parse_material(text);
    const SphereImage image = render_sphere(device(), material, {.points = {}, .sky = 2}, {.size = kSize});
    for (const auto& [row, column] : kPixels) {
      if (image.coverage(pixel(row, column)) < 1) continue;
      const auto theta = static_cast<double>(std::acos(normal_at(row, column).z));
      const double expected = 2 * albedo(device(), material, std::vector{theta}).front().front().value;
      // A pixel's mean is not its middle: at most what the neighbours differ by.
      const double beside = std::max(std::abs(image.radiance(0, pixel(row, column + 1)) - expected),
                                     std::abs(image.radiance(0, pixel(row, column - 1)) - expected));
      EXPECT_NEAR(image.radiance(0, pixel(row, column)), expected,
                  0.25 * std::min(beside, expected) + image.error(0, pixel(row, column)) + 1e-5)
          << text << " " << row << " " << column;
    }
  }
}

TEST(SphereImage, OfAMirrorShowsTheSky) {
  const SphereImage image = rendered("mirror:scale=0.9", homogeneous_daylight());
  EXPECT_LT(excess_over(image, 0.9), 1e-9);
}

TEST(SphereImage, OfAMirrorShowsALightAsADisc) {
  const double a = 0.9;
  const double irradiance = 2;
  const SphereImage image =
      rendered("mirror:scale=0.8", {.points = {{{0, std::sin(a), std::cos(a)}, irradiance}}}, 200);
  const double sine = std::sin(kLightDiscRadius);
  const double radiance = 0.8 * irradiance / (pi * sine * sine);
  EXPECT_NEAR(image.radiance.maxCoeff(), radiance, 1e-9 * radiance);
  // Normals see the disc within an ellipse: half of its radius in the plane of light and viewer, 1 / cos(a/2) of that
  // across it; the picture shows cos(a/2) of its area, to first order.
  const double area = pi * std::pow(kLightDiscRadius / 2, 2);
  const double total = image.radiance.sum() * 4 / (200.0 * 200.0);
  EXPECT_NEAR(total, radiance * area, 5e-3 * radiance * area);
  Eigen::Index row = 0;
  Eigen::Index brightest = 0;
  image.radiance.maxCoeff(&row, &brightest);
  EXPECT_NEAR(1 - 2 * (static_cast<double>(brightest / 200) + 0.5) / 200, std::sin(a / 2), 0.02);
}

TEST(SphereImage, OfARetroReflectingMirrorShowsTheSkyAndNoLightBesideTheViewer) {
  const SphereImage daylight = rendered("rrim", homogeneous_daylight());
  EXPECT_LT(excess_over(daylight, 1), 1e-9);
  EXPECT_EQ(rendered("rrim", three_point_lights()).radiance.maxCoeff(), 0);
  EXPECT_THROW(rendered("rrim", {.points = {{{0, 0, 1}, 1}}}), ArgumentError);
}

TEST(SphereImage, IntegratesOverTheLightWhereFormulasAreNotReciprocal) {
  // f = N.L / pi: the viewer sees 2/3 of the sky at any angle; the albedo (1.13) would be N.L.
  Material material;
  material.name = "towards the light";
  Term term;
  term.model = std::string(kCustomModel);
  term.weight = {1};
  term.formula = Formula{.text = "cos_i / pi", .width = 1, .reciprocal = false};
  material.terms = {term};
  const SphereImage image =
      render_sphere(device(), prepare(device(), material), homogeneous_daylight(), {.size = kSize});
  EXPECT_LT(excess_over(image, 2.0 / 3), 1e-9);
  EXPECT_LT(image.error.maxCoeff(), 1.0 / 512);
}

TEST(SphereImage, KnowsItsErrorsOfSharpHighlights) {
  // The light of a highlight, whatever the pixels: those of 40 and of 100 agree within their errors.
  for (const char* const text : {"ward:m=0.005", "phong:n=100000", "ggx:alpha=0.004"}) {
    const SphereLighting lighting{.points = {{{0.5, 0.5, 0.6}, 1}}};
    const auto total = [&](std::size_t size) {
      const SphereImage image = rendered(text, lighting, size);
      const double area = 4 / static_cast<double>(size * size);
      return std::array{image.radiance.sum() * area, image.error.sum() * area};
    };
    const auto [coarse, coarse_error] = total(40);
    const auto [fine, fine_error] = total(100);
    EXPECT_GT(fine, 0.01) << text;
    EXPECT_NEAR(coarse, fine, coarse_error + fine_error + 1e-9) << text;
    EXPECT_LT(coarse_error, 1e-2 * fine) << text;
  }
}

TEST(SphereImage, RefusesLobesThatPixelsCannotResolve) {
  try {
    rendered("phong:n=1e10", three_point_lights());
    FAIL();
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("too narrow for pixels"));
  }
}

TEST(SphereImage, OfATableIsThatOfItsMaterialWithinTheErrors) {
  const Material material = parse_material("lambert:scale=0.4+phong:n=8,scale=0.5+mirror:scale=0.1");
  const BrdfTable table = tabulate(device(), material, HemisphereGrid::gauss(24, 48));
  for (const SphereLighting& lighting : {three_point_lights(), homogeneous_daylight()}) {
    const SphereImage exact = render_sphere(device(), material, lighting, {.size = kSize});
    const SphereImage image = render_sphere(device(), table, lighting, {.size = kSize});
    // Between nodes and beyond the last ring values are interpolated: 1e-3 of them, 2 % in pixels of the outline.
    for (Eigen::Index k = 0; k < image.coverage.size(); ++k) {
      const double share = image.coverage(k) < 1 ? 0.02 : 1e-3;
      EXPECT_NEAR(image.radiance(0, k), exact.radiance(0, k),
                  image.error(0, k) + exact.error(0, k) + share * exact.radiance(0, k) + 1e-9)
          << k;
    }
  }
}

TEST(SphereImage, OfCellsIsThatOfTheirMaterialWithinTheErrors) {
  // Lambert is the same in every cell, so that steps between them leave no excuse.
  const BrdfTable table = tabulate(device(), parse_material("lambert:scale=0.6"), HemisphereGrid::klems(145));
  EXPECT_LT(excess_over(render_sphere(device(), table, homogeneous_daylight(), {.size = kSize}), 0.6), 1e-9);
  const SphereImage exact = rendered("lambert:scale=0.6", three_point_lights());
  const SphereImage image = render_sphere(device(), table, three_point_lights(), {.size = kSize});
  EXPECT_LT(((image.radiance - exact.radiance).cwiseAbs() - image.error - exact.error).maxCoeff(), 1e-9);
}

TEST(SphereImage, OfAMirrorInATableShowsALightAsThatOfItsMaterial) {
  const Material material = parse_material("mirror:scale=0.7");
  const BrdfTable table = tabulate(device(), material, HemisphereGrid::gauss(8, 16));
  const SphereLighting lighting{.points = {{{0.3, 0.4, 0.8}, 1}}};
  const SphereImage exact = render_sphere(device(), material, lighting, {.size = kSize});
  const SphereImage image = render_sphere(device(), table, lighting, {.size = kSize});
  EXPECT_GT(exact.radiance.maxCoeff(), 1);
  EXPECT_LT((image.radiance - exact.radiance).cwiseAbs().maxCoeff(), 1e-9 * exact.radiance.maxCoeff());
}

/// By how much two pictures differ beyond their errors and a share of the radiance.
double excess_between(const SphereImage& a, const SphereImage& b, double share) {
  return ((a.radiance - b.radiance).array().abs() - (a.error + b.error).array() - share * b.radiance.array())
      .maxCoeff();
}

TEST(SphereImage, OfAFunctionIsThatOfItsMaterial) {
  for (const char* const text : {"ward:m=0.2", "ward_anisotropic:m_x=0.3,m_y=0.6"}) {
    const Material material = parse_material(text);
    const SphereImage exact = render_sphere(device(), material, three_point_lights(), {.size = 12});
    const SphereImage image =
        render_sphere(device(), as_function(device(), material), three_point_lights(), {.size = 12});
    EXPECT_LT(excess_between(image, exact, 1e-4), 1e-9) << text;
  }
  const Material material = parse_material("ward:m=0.2");
  const SphereImage exact = render_sphere(device(), material, homogeneous_daylight(), {.size = 12});
  const SphereImage image =
      render_sphere(device(), as_function(device(), material), homogeneous_daylight(), {.size = 12});
  EXPECT_LT(excess_between(image, exact, 1e-4), 1e-9);
}

TEST(SphereImage, OfAnAnisotropicFunctionUnderDaylightShowsItsAlbedoByAzimuth) {
  // f = (1 + L_x^2 V_x^2) / pi has the albedo 1 + V_x^2 / 4, V_x along the parallel.
  BrdfFunction function;
  function.name = "along the parallels";
  function.channels = {"value"};
  function.is_isotropic = false;
  function.at = [](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Vector light = reference::light_of(pairs[i]);
      const Vector view = reference::view_of(pairs[i]);
      values.value(static_cast<Eigen::Index>(i), 0) =
          static_cast<double>((1 + light.x * light.x * view.x * view.x) / pi);
    }
    return values;
  };
  const auto expected = [](const Vector& normal) {
    const Vector view = reference::on_sphere(normal, {0, 0, 1});
    return 1 + view.x * view.x / 4;
  };
  const SphereImage image = render_sphere(device(), function, homogeneous_daylight(), {.size = kSize});
  for (const auto& [row, column] : kPixels) {
    SCOPED_TRACE(std::to_string(row) + " " + std::to_string(column));
    if (image.coverage(pixel(row, column)) < 1) continue;
    const auto mean = static_cast<double>(reference::pixel_mean(expected, kSize, row, column, 40));
    EXPECT_NEAR(image.radiance(0, pixel(row, column)), mean, image.error(0, pixel(row, column)) + 1e-4);
  }
  EXPECT_LT(image.error.maxCoeff(), 5e-3);
}

TEST(SphereImage, MixesChannelsIntoThoseOfThePicture) {
  const Material material = parse_material("lambert:scale=0.1/0.2/0.3/0.4");
  Eigen::MatrixXd weights(2, 4);
  weights << 1, 1, 0, 0, 0, 0, 2, -1;
  const SphereImage image = render_sphere(device(), material, homogeneous_daylight(), {.size = 6, .weights = weights});
  ASSERT_EQ(image.radiance.rows(), 2);
  EXPECT_NEAR(image.radiance(0, 14), 0.3, 1e-6);
  EXPECT_NEAR(image.radiance(1, 14), 0.2, 1e-6);
  EXPECT_THROW(
      (void)render_sphere(device(), parse_material("lambert"), homogeneous_daylight(), {.size = 6, .weights = weights}),
      ArgumentError);
}

TEST(SphereImage, OfSmoothModelsIsKnownToHalfALevelOfTheDisplay) {
  for (const char* const text : {"lambert", "phong:n=20", "ward:m=0.1", "ggx:alpha=0.2", "oren_nayar:sigma=0.4",
                                 "ward_anisotropic:m_x=0.1,m_y=0.3", "lambert:scale=0.3+phong:n=100,scale=0.5"}) {
    for (const SphereLighting& lighting : {three_point_lights(), homogeneous_daylight()}) {
      const double exposure = reference_exposure(lighting);
      const SphereImage image =
          render_sphere(device(), parse_material(text), lighting, {.size = 48, .white = 1 / exposure});
      EXPECT_LT(display(image, exposure).largest_error, 1.0 / 512) << text << ", sky " << lighting.sky;
    }
  }
}

TEST(SphereImage, RefusesWhatIsNoPicture) {
  EXPECT_THROW(rendered("lambert", homogeneous_daylight(), 0), ArgumentError);
  EXPECT_THROW(rendered("lambert", homogeneous_daylight(), 5000), ArgumentError);
  EXPECT_THROW(rendered("lambert", {.points = {{{0, 0, 0}, 1}}}), ArgumentError);
  EXPECT_THROW(rendered("lambert", {.points = {{{0, 0, 1}, -1}}}), ArgumentError);
  EXPECT_THROW(rendered("lambert", {.points = {}, .sky = -1}), ArgumentError);
}

TEST(SphereImage, StopsWhereItIsTold) {
  const SphereOptions options{.size = kSize, .progress = [](std::string_view, double) { return false; }};
  EXPECT_THROW((void)render_sphere(device(), parse_material("lambert"), three_point_lights(), options), Cancelled);
}

TEST(ReferenceExposure, ShowsTheGreySphereUnderDaylightAtHalfOfTheRange) {
  EXPECT_NEAR(reference_exposure(homogeneous_daylight()), decode_srgb(0.5) / 0.5, 1e-12);
}

TEST(ReferenceExposure, ShowsTheMedianOfTheGreySphereUnderLightsAtHalfOfTheRange) {
  const SphereLighting lighting = three_point_lights();
  const double exposure = reference_exposure(lighting);
  const SphereImage image = rendered("lambert:scale=0.5", lighting, 64);
  std::vector<double> shown;
  for (Eigen::Index k = 0; k < image.coverage.size(); ++k) {
    if (image.coverage(k) > 0.999) shown.push_back(encode_srgb(exposure * image.radiance(0, k)));
  }
  const auto middle = shown.begin() + static_cast<std::ptrdiff_t>(shown.size() / 2);
  std::ranges::nth_element(shown, middle);
  EXPECT_NEAR(*middle, 0.5, 0.01);  // without the pixels of the outline
}

TEST(ReferenceExposure, IsOpenWhereMostOfTheSphereIsDark) {
  EXPECT_THROW((void)reference_exposure({.points = {{{0, 0.5, -1}, 1}}}), ArgumentError);
  EXPECT_THROW((void)reference_exposure({}), ArgumentError);
}

TEST(SkyRadiance, IsTheAlbedoOfLightFromTheViewerForReciprocalMaterials) {
  const std::vector<Direction> viewers{{0, 0}, {0.7, 0.3}, {1.3, 2}};
  for (const char* text :
       {"lambert:scale=0.3", "ggx:alpha=0.4,scale=0.5/0.2/0.1", "ward_anisotropic:m_x=0.2,m_y=0.5"}) {
    const Material material = parse_material(text);
    const SkyRadiance seen = sky_radiance(device(), material, viewers);
    const auto expected = albedo(device(), material, viewers);
    ASSERT_EQ(seen.value.rows(), static_cast<Eigen::Index>(expected.size())) << text;
    for (std::size_t c = 0; c < expected.size(); ++c) {
      for (std::size_t k = 0; k < viewers.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(c);
        const auto column = static_cast<Eigen::Index>(k);
        EXPECT_LE(seen.error(row, column), 1.0 / 1024) << text;
        EXPECT_NEAR(seen.value(row, column), expected[c][k].value,
                    seen.error(row, column) + expected[c][k].error + 1e-12)
            << text << ", viewer " << k;
      }
    }
  }
}

TEST(SkyRadiance, IsOfTheViewerWhereMaterialsAreNotReciprocal) {
  // Turquin's scaling makes viewers see all of a white sky; albedos of light exceed 1.
  const std::vector<Direction> viewers{{0, 0}, {0.9, 0}, {1.5, 0}};
  const Material material = parse_material("ggx:alpha=0.5@turquin");
  const SkyRadiance seen = sky_radiance(device(), material, viewers);
  for (Eigen::Index k = 0; k < seen.value.cols(); ++k) {
    EXPECT_NEAR(seen.value(0, k), 1, seen.error(0, k) + 1e-5) << "viewer " << k;
  }
  EXPECT_GT(albedo(device(), material, viewers).front().back().value, 1.2);
}

TEST(SkyRadiance, OfTablesAndFunctionsIsThatOfTheirFormula) {
  const std::vector<Direction> viewers{{0, 0}, {0.7, 0.3}, {1.2, 2}};
  const Material material = parse_material("lambert:scale=0.3+ggx:alpha=0.5");
  const SkyRadiance expected = sky_radiance(device(), material, viewers);
  const SkyRadiance table =
      sky_radiance(device(), tabulate(device(), material, HemisphereGrid::gauss(48, 96)), viewers);
  const SkyRadiance function = sky_radiance(device(), as_function(device(), material), viewers);
  for (Eigen::Index k = 0; k < expected.value.cols(); ++k) {
    const double value = expected.value(0, k);
    const double error = expected.error(0, k);
    EXPECT_NEAR(table.value(0, k), value, table.error(0, k) + error) << "viewer " << k;
    EXPECT_NEAR(function.value(0, k), value, function.error(0, k) + error) << "viewer " << k;
    EXPECT_LE(table.error(0, k), 0.01) << "viewer " << k;
    EXPECT_LE(function.error(0, k), 0.01) << "viewer " << k;
  }
}

TEST(SkyRadiance, MixesChannelsByTheirWeights) {
  const std::vector<Direction> viewers{{0.5, 0}};
  SphereOptions options;
  options.weights = Eigen::RowVector3d(1, 2, 3);
  const SkyRadiance seen = sky_radiance(device(), parse_material("lambert:scale=0.1/0.2/0.3"), viewers, options);
  ASSERT_EQ(seen.value.size(), 1);
  EXPECT_NEAR(seen.value(0, 0), 1.4, 1e-6);
}

TEST(SkyRadiance, RefusesViewersThatAreNone) {
  for (const Direction& viewer : {Direction{-0.1, 0}, Direction{pi / 2, 0}, Direction{NAN, 0}, Direction{0, NAN}}) {
    EXPECT_THROW((void)sky_radiance(device(), parse_material("lambert"), {&viewer, 1}), ArgumentError) << viewer.theta;
  }
  const Direction above{0.1, 0};
  EXPECT_THROW((void)sky_radiance(device(), parse_material("lambert"), {&above, 1}, {.tolerance = 0}), ArgumentError);
}

TEST(SkyRadiance, MayBeCancelled) {
  SphereOptions options;
  options.progress = [](std::string_view /*stage*/, double /*share*/) { return false; };
  const std::vector<Direction> viewers(3);
  EXPECT_THROW((void)sky_radiance(device(), parse_material("lambert"), viewers, options), Cancelled);
}

}  // namespace
}  // namespace lobe::test
