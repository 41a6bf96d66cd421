// Scenes by path tracing: against closed forms, values of evaluate() and albedos, within the variances they state.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/plot/scene_picture.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/render/render_scene.hpp"
#include "lut/exr.hpp"
#include "support/device.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using ::testing::HasSubstr;

constexpr double kErrors = 5;  // standard errors that a mean may be off

/// A scene of one shape.
Scene scene_of(Reflectance reflectance, SceneShape shape) {
  Scene scene;
  scene.materials.push_back({"it", std::move(reflectance)});
  scene.shapes.push_back(std::move(shape));
  return scene;
}

/// A camera that sees nothing but a point, from a direction, on a few pixels.
SceneCamera camera_at(const SpaceVector& point, const SpaceVector& direction, double distance, std::size_t edge) {
  return {.position = {point[0] + distance * direction[0], point[1] + distance * direction[1],
                       point[2] + distance * direction[2]},
          .target = point,
          .up = {0.1, 0.2, 1},
          .field_of_view = 1e-7,
          .size = {edge, edge}};
}

SpaceVector direction_of(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Direct light.

class PointLit : public ::testing::TestWithParam<std::string> {};

TEST_P(PointLit, SphereShowsTheValueOfItsReflectanceTimesTheIrradiance) {
  const Reflectance reflectance = parse_material(GetParam());
  Scene scene = scene_of(reflectance, {SphereShape{{1, 2, 3}, 2}});
  scene.bounces = 0;
  scene.lights.push_back({{3, -4, 9}, {10, 20, 30}});
  for (const auto& [theta, phi] : {std::array{0.9, -0.8}, std::array{0.4, 0.3}, std::array{1.2, -1.9}}) {
    SCOPED_TRACE(theta);
    const SpaceVector out = direction_of(theta, phi);
    const Vector3d normal(out[0], out[1], out[2]);
    const Vector3d point = Vector3d(1, 2, 3) + 2 * normal;
    // The viewer looks at the point from aside.
    const Vector3d view = (normal + Vector3d(0.3, -0.5, 0.2)).normalized();
    scene.camera = camera_at({point[0], point[1], point[2]}, {view[0], view[1], view[2]}, 5, 1);

    const SceneImage image = render_scene(device(), scene, {.samples = 2});

    const Vector3d way = Vector3d(3, -4, 9) - point;
    const Vector3d light = way.normalized();
    const Vector3d east = Vector3d(0, 0, 1).cross(normal).normalized();
    const Vector3d north = normal.cross(east);
    const auto azimuth = [&](const Vector3d& v) { return std::atan2(v.dot(north), v.dot(east)); };
    const double cosine = light.dot(normal);
    ASSERT_GT(cosine, 0.05);
    const Directions pair{std::acos(cosine), std::acos(view.dot(normal)), azimuth(view) - azimuth(light),
                          azimuth(light)};
    const Eigen::MatrixXd value = evaluate(device(), reflectance, {&pair, 1}).value;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double f = value(0, value.cols() == 1 ? 0 : c);
      const double expected = f * cosine / way.squaredNorm() * 10 * static_cast<double>(c + 1);
      EXPECT_NEAR(image.radiance(c, 0), expected, 1e-5 * expected) << c;  // the camera is 1e-7 rad wide
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, PointLit,
                         ::testing::Values("lambert:scale=0.7/0.2/0.4", "ggx:alpha=0.3",
                                           "ward_anisotropic:m_x=0.2,m_y=0.5,rotation=0.6", "hapke:w=0.6",
                                           "metal_phong_fresnel:n=10,ior=0.2/0.4/1.5,k=3/2.6/1.9"),
                         [](const auto& test) { return test_name(test.param); });

TEST(Scene, ShapesThrowShadows) {
  Scene scene = scene_of(parse_material("lambert"), {PlaneShape{}});
  scene.bounces = 0;
  scene.lights.push_back({{0, 0, 5}, {1, 1, 1}});
  scene.camera = camera_at({0, 0, 0}, direction_of(0.7, 0), 5, 1);
  const double lit = render_scene(device(), scene, {.samples = 2}).radiance(0, 0);
  scene.shapes.push_back({SphereShape{{0, 0, 2}, 0.5}});
  const double shadowed = render_scene(device(), scene, {.samples = 2}).radiance(0, 0);
  scene.shapes.back() = {SphereShape{{0, 0, 7}, 0.5}};
  const double lit_again = render_scene(device(), scene, {.samples = 2}).radiance(0, 0);

  EXPECT_NEAR(lit, 1 / pi / 25, 1e-9);
  EXPECT_EQ(shadowed, 0);
  EXPECT_EQ(lit, lit_again);
}

TEST(Scene, MayHaveAnyUnitOfLength) {
  // A plane that a ball shades in part, with lengths times the unit and intensities times its square.
  const auto radiances = [](double unit) {
    Scene scene = scene_of(parse_material("lambert"), {PlaneShape{}});
    scene.shapes.push_back({SphereShape{{0, 0, 0.5 * unit}, 0.2 * unit}});
    scene.lights.push_back({{0, 0, 3 * unit}, {9 * unit * unit, 9 * unit * unit, 9 * unit * unit}});
    scene.sky.radiance = {1e-15, 1e-15, 1e-15};
    scene.camera = {
        .position = {0, -3 * unit, 1.5 * unit}, .target = {0, 0, 0}, .field_of_view = 0.5, .size = {24, 16}};
    return render_scene(device(), scene, {.samples = 4}).radiance;
  };
  const Eigen::Matrix3Xd expected = radiances(1);
  ASSERT_LT(expected.minCoeff(), 1e-14);  // the shadow, where the sky alone is seen
  EXPECT_GT(expected.minCoeff(), 0);
  for (const double unit : {1e-12, 1e-9, 1e-3, 1e6, 1e12}) {
    // Lengths round otherwise; no path takes another way.
    EXPECT_LT((radiances(unit) - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.maxCoeff()) << unit;
  }
}

// Skies.

/// Something under a uniform sky, whose radiance is its albedo.
struct AlbedoCase {
  std::string name;
  SamplingStrategy proposal = SamplingStrategy::tailored;
};
std::ostream& operator<<(std::ostream& out, const AlbedoCase& one) {
  return out << one.name << (one.proposal == SamplingStrategy::cosine ? "_by_cosine" : "");
}

class UnderASky : public ::testing::TestWithParam<AlbedoCase> {};

void expect_albedo(const Reflectance& reflectance, SamplingStrategy proposal, std::size_t samples) {
  constexpr double kTheta = 1.1;
  Scene scene = scene_of(reflectance, {PlaneShape{}});
  scene.sky.radiance = {1, 1, 1};
  scene.camera = camera_at({0, 0, 0}, direction_of(kTheta, 0.4), 5, 16);
  const auto expected = albedo(device(), reflectance, std::array{Direction{kTheta, 0.4}});

  const SceneImage image = render_scene(device(), scene, {.samples = samples, .proposal = proposal});

  const auto means = image.mean_radiance();
  for (std::size_t c = 0; c < 3; ++c) {
    const Estimate& wanted = expected[expected.size() == 1 ? 0 : c].front();
    EXPECT_NEAR(means.at(c).value, wanted.value, kErrors * means.at(c).error + wanted.error + 1e-7) << c;
    EXPECT_LT(means.at(c).error, 0.02 * wanted.value) << c;
  }
}

TEST_P(UnderASky, HasItsAlbedoAsRadiance) {
  expect_albedo(parse_material(GetParam().name), GetParam().proposal, 32);
}

INSTANTIATE_TEST_SUITE_P(
    Is, UnderASky,
    ::testing::Values(AlbedoCase{"lambert:scale=0.7"}, AlbedoCase{"phong:n=50"}, AlbedoCase{"basic_patch:R=0.4"},
                      AlbedoCase{"basic_patch:R=0.7", SamplingStrategy::cosine}, AlbedoCase{"exponential_patch:s=20"},
                      AlbedoCase{"lambert:scale=0.4/0.1/0.2+ggx:alpha=0.1,scale=0.5"},
                      AlbedoCase{"lambert:scale=0.4+mirror:scale=0.1/0.2/0.5"},
                      AlbedoCase{"lambert:scale=0.4+mirror:scale=0.1/0.2/0.5", SamplingStrategy::cosine},
                      AlbedoCase{"mirror:rho=0.8"}, AlbedoCase{"ward_anisotropic:m_x=0.3,m_y=0.6,rotation=0.6"},
                      AlbedoCase{"ggx:alpha=0.3@normalise"}, AlbedoCase{"ggx:alpha=0.6", SamplingStrategy::cosine}),
    [](const auto& test) {
      return test_name(test.param.name) + (test.param.proposal == SamplingStrategy::cosine ? "_by_cosine" : "");
    });

TEST(Scene, ShowsTablesAndFunctions) {
  const Reflectance formula = parse_material("lambert:scale=0.3+phong:n=8,scale=0.6");
  const Reflectance table = tabulate(device(), formula, HemisphereGrid::gauss(16, 32));
  expect_albedo(table, SamplingStrategy::tailored, 16);
  expect_albedo(as_function(device(), formula), SamplingStrategy::tailored, 16);
}

TEST(Scene, OfAnOvercastSkyLightsTheGroundBySevenNinths) {
  Scene scene = scene_of(parse_material("lambert:scale=0.5"), {PlaneShape{}});
  scene.sky = {SkyKind::overcast, {1, 2, 3}};
  scene.camera = camera_at({0, 0, 0}, direction_of(0.5, 0), 5, 8);

  const auto means = render_scene(device(), scene, {.samples = 256}).mean_radiance();

  for (std::size_t c = 0; c < 3; ++c) {
    // Irradiance pi times 7/9 of the zenith's radiance.
    const double expected = 0.5 * 7 / 9 * static_cast<double>(c + 1);
    EXPECT_NEAR(means.at(c).value, expected, kErrors * means.at(c).error) << c;
    EXPECT_LT(means.at(c).error, 0.01 * expected) << c;
  }
}

/// Ground below a black ball of radius 1 whose middle is at a height of 2, under a sky: a quarter of the sky's
/// irradiance is missing right below, and paths see the sky or nothing.
Scene ground_below_a_ball() {
  Scene scene = scene_of(parse_material("lambert:scale=0.8"), {PlaneShape{}});
  scene.materials.push_back({"black", parse_material("lambert:scale=0")});
  scene.shapes.push_back({SphereShape{{0, 0, 2}, 1}, 1});
  scene.sky.radiance = {1, 1, 1};
  scene.camera = camera_at({0, 0, 0}, direction_of(1.4, 0), 5, 32);
  return scene;
}

TEST(Scene, StatesStandardErrorsThatHold) {
  constexpr double kSeen = 0.75;
  constexpr std::size_t kSamples = 256;
  const SceneImage image = render_scene(device(), ground_below_a_ball(), {.samples = kSamples});

  const Eigen::ArrayXd radiance = image.radiance.row(0).transpose();
  const Eigen::ArrayXd variance = image.variance_of_mean().row(0).transpose();
  const auto pixels = static_cast<double>(radiance.size());
  const double expected = 0.8 * kSeen;
  const double chi2 = ((radiance - expected).square() / variance).sum() / pixels;
  EXPECT_NEAR(chi2, 1, kErrors * std::sqrt(2 / pixels) + 3.0 / kSamples);  // pixels do not know the others' variance
  EXPECT_NEAR(image.mean_radiance()[0].value, expected, kErrors * image.mean_radiance()[0].error);
  // Of a number that is 0.8 or 0.
  const double single = 0.8 * 0.8 * kSeen * (1 - kSeen);
  EXPECT_NEAR(image.variance.row(0).mean(), single, 0.01 * single);
}

TEST(Scene, StatesRoundingWhereSamplesDoNotVary) {
  Scene scene = scene_of(parse_material("lambert:scale=0.2/0.3/0.7"), {PlaneShape{}});
  scene.sky.radiance = {1, 1, 1};
  scene.camera = camera_at({0, 0, 0}, direction_of(0.5, 0.4), 5, 4);

  const auto means = render_scene(device(), scene, {.samples = 64}).mean_radiance();

  for (const auto& [channel, expected] : {std::pair{0U, 0.2}, std::pair{1U, 0.3}, std::pair{2U, 0.7}}) {
    EXPECT_LE(std::abs(means.at(channel).value - expected), means.at(channel).error) << channel;
    EXPECT_LT(means.at(channel).error, 2e-14) << channel;
  }
}

/// Asserts that no channel's mean is off by more than is stated.
/// \return the largest share of the stated error that one is off by
double expect_within_rounding(const SceneImage& image, const std::array<double, 3>& expected) {
  double share = 0;
  for (std::size_t c = 0; c < expected.size(); ++c) {
    const Estimate mean = image.mean_radiance().at(c);
    EXPECT_LE(std::abs(mean.value - expected.at(c)), mean.error) << c;
    share = std::max(share, std::abs(mean.value - expected.at(c)) / mean.error);
  }
  return share;
}

TEST(Scene, StatesTheRoundingOfManyReflections) {
  const std::array rho{0.9, 0.5, 0.2};
  double share = 0;
  for (const double radius : {3.0, 0.37, 100.0}) {
    for (const std::size_t bounces : {0U, 3U, 20U}) {
      SCOPED_TRACE(radius);
      Scene scene = scene_of(parse_material("lambert:scale=0.9/0.5/0.2"), {SphereShape{{0, 0, 0}, radius}});
      scene.lights.push_back({{0, 0, 0}, {2, 2, 2}});
      scene.camera = {.position = {radius / 6, 0, 0}, .target = {1, 1, 1}, .size = {6, 4}};
      scene.bounces = bounces;
      std::array<double, 3> expected{};
      for (std::size_t c = 0; c < rho.size(); ++c) {
        for (std::size_t k = 0; k <= bounces; ++k) expected.at(c) += std::pow(rho.at(c), static_cast<double>(k + 1));
        expected.at(c) *= 2 / (pi * radius * radius);
      }
      share = std::max(share, expect_within_rounding(render_scene(device(), scene, {.samples = 3}), expected));
    }
  }
  EXPECT_GT(share, 0.5);  // half the error would be too small
}

TEST(Scene, StatesTheRoundingOfDirectionsWhereLobesAreNarrow) {
  double share = 0;
  for (const auto& [text, width] : {std::pair{"ward:m=0.01", 0.01}, std::pair{"ggx:alpha=0.001", 0.001},
                                    std::pair{"blinn_phong:n=1000000", 0.001}}) {
    SCOPED_TRACE(text);
    for (const double theta : {0.1, 0.5, 1.2}) {
      for (const double widths : {0.0, 1.5, 5.0}) {
        Scene scene = scene_of(parse_material(text), {PlaneShape{}});
        scene.bounces = 0;
        const SpaceVector light = direction_of(theta, pi);
        scene.lights.push_back({{5 * light[0], 5 * light[1], 5 * light[2]}, {1, 1, 1}});
        const Directions pair{theta, theta + widths * width, pi, 0};
        scene.camera = camera_at({0, 0, 0}, direction_of(pair.theta_out, 0), 5, 1);
        scene.camera.field_of_view = 1e-150;
        const double f = evaluate(device(), scene.materials[0].reflectance, {&pair, 1}).value(0, 0);
        const double expected = f * std::cos(theta) / 25;
        share = std::max(share, expect_within_rounding(render_scene(device(), scene, {.samples = 2}),
                                                       {expected, expected, expected}));
      }
    }
  }
  EXPECT_GT(share, 0.5);
}

// Reflections between surfaces.

TEST(Scene, OfAnIntegratingSphereHasTheRadianceOfTheGeometricSeries) {
  constexpr double kRadius = 3;
  Scene scene = scene_of(parse_material("lambert:scale=0.9/0.5/0.2"), {SphereShape{{0, 0, 0}, kRadius}});
  scene.lights.push_back({{0, 0, 0}, {2, 2, 2}});
  scene.camera = {.position = {0.5, 0, 0}, .target = {1, 1, 1}, .size = {6, 4}};
  for (const std::size_t bounces : {std::size_t{0}, std::size_t{3}, std::size_t{20}}) {
    scene.bounces = bounces;
    const SceneImage image = render_scene(device(), scene, {.samples = 3});
    for (const auto& [channel, rho] : {std::pair{0, 0.9}, std::pair{1, 0.5}, std::pair{2, 0.2}}) {
      double series = 0;
      for (std::size_t k = 0; k <= bounces; ++k) series += std::pow(rho, static_cast<double>(k));
      const double expected = rho / pi * 2 / (kRadius * kRadius) * series;
      EXPECT_NEAR(image.radiance.row(channel).minCoeff(), expected, 1e-9 * expected) << bounces;
      EXPECT_NEAR(image.radiance.row(channel).maxCoeff(), expected, 1e-9 * expected) << bounces;
    }
  }
}

TEST(Scene, OfWhiteThingsInAWhiteFurnaceCannotBeSeen) {
  Scene scene = scene_of(parse_material("lambert"), {PlaneShape{{0, 0, 0}, {0, 0, 1}, std::array{9.0, 9.0}}});
  scene.shapes.push_back({SphereShape{{0, 0, 1}, 1}});
  scene.shapes.push_back({BoxShape{{1.5, 0.5, 0.5}, {1, 1, 1}, 0.4}});
  scene.shapes.push_back({CylinderShape{{-1.5, 0.5, 0}, {0, 0, 1}, 0.4}});
  scene.sky.radiance = {1, 1, 1};
  scene.bounces = kMostBounces;
  scene.camera = {.position = {0, -6, 3}, .target = {0, 0, 0.5}, .size = {24, 16}};

  const SceneImage image = render_scene(device(), scene, {.samples = 8});

  // Of a path that stays between the shapes for 63 reflections, less is seen.
  EXPECT_NEAR(image.radiance.minCoeff(), 1, 1e-6);
  EXPECT_NEAR(image.radiance.maxCoeff(), 1, 1e-12);
}

/// An octahedron that is shaded as a sphere: normals are off by up to 55 degrees.
MeshShape round_octahedron() {
  MeshShape mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.normals = mesh.vertices;
  for (std::uint32_t k = 0; k < 4; ++k) {
    mesh.triangles.push_back({k, (k + 1) % 4, 4});
    mesh.triangles.push_back({(k + 1) % 4, k, 5});
  }
  mesh.triangle_normals = mesh.triangles;
  return mesh;
}

TEST(Scene, LosesNoLightToInterpolatedNormals) {
  Scene scene = scene_of(parse_material("lambert"), {round_octahedron()});
  scene.sky.radiance = {1, 1, 1};
  scene.camera = {.position = {1, -5, 3}, .target = {0, 0, 0}, .field_of_view = 0.5, .size = {16, 16}};

  const SceneImage image = render_scene(device(), scene, {.samples = 8});

  // Convex and white: every path sees the sky.
  EXPECT_NEAR(image.radiance.minCoeff(), 1, 1e-12);
  EXPECT_NEAR(image.radiance.maxCoeff(), 1, 1e-12);
}

TEST(Scene, OfManyLightsIsThatUnderASkyForInterpolatedNormals) {
  constexpr std::size_t kLights = 8000;
  constexpr double kFar = 1e5;
  Scene scene = scene_of(parse_material("lambert:scale=0.7"), {round_octahedron()});
  scene.bounces = 0;
  // A Fibonacci lattice: each light stands for as much of the sky.
  for (std::size_t k = 0; k < kLights; ++k) {
    const double z = 1 - (2 * static_cast<double>(k) + 1) / kLights;
    const double phi = static_cast<double>(k) * pi * (3 - std::sqrt(5.0));
    const double level = std::sqrt(1 - z * z);
    const double intensity = kFar * kFar * 4 * pi / kLights;
    scene.lights.push_back(
        {{kFar * level * std::cos(phi), kFar * level * std::sin(phi), kFar * z}, {intensity, intensity, intensity}});
  }
  for (const SpaceVector& place : {SpaceVector{0.1, -0.8, 0.1}, SpaceVector{0.05, -0.45, 0.5}}) {
    SCOPED_TRACE(place[2]);
    scene.camera = camera_at(place, direction_of(1, -1.4), 5, 1);
    // The lattice misses the share of a part of the sky with an edge, here at the horizon, by about N^(-3/4); light
    // lost below normals that are turned by 20 degrees would be 3 %.
    EXPECT_NEAR(render_scene(device(), scene, {.samples = 2}).radiance(0, 0), 0.7, 2 * std::pow(kLights, -0.75))
        << place[2];
  }
}

/// Lambert's law by wavelengths under a white sky.
SceneImage spectral_image(const std::string& material, std::vector<double> wavelengths) {
  BrdfFunction function = as_function(device(), parse_material(material));
  function.wavelengths = std::move(wavelengths);
  function.channels.clear();
  for (const double wavelength : function.wavelengths) {
    function.channels.push_back(std::to_string(static_cast<int>(wavelength)) + " nm");
  }
  Scene scene = scene_of(std::move(function), {PlaneShape{}});
  scene.sky.radiance = {1, 1, 1};
  scene.bounces = 0;
  scene.camera = camera_at({0.1, 0.2, 0}, {0, 0.5, 1}, 5, 1);
  return render_scene(device(), scene, {.samples = 16});
}

TEST(Scene, ShowsWavelengthsInTheirColour) {
  const Vector3d flat = spectral_image("lambert:scale=0.5/0.5/0.5/0.5/0.5", {455, 505, 555, 605, 655}).radiance.col(0);
  // Sampling is exact for Lambert's law; five wavelengths do not make white to better than a hundredth.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(flat[c], 0.5, 0.005) << c;
  const Vector3d long_waves = spectral_image("lambert:scale=0/0/0/0.5/0.5", {455, 505, 555, 605, 655}).radiance.col(0);
  EXPECT_GT(long_waves[0], 5 * long_waves[1]);
  EXPECT_GT(long_waves[0], 20 * std::abs(long_waves[2]));
  try {
    (void)spectral_image("lambert:scale=0.1/0.2/0.3", {450, 550, 650});
    FAIL() << "three wavelengths were taken for red, green and blue";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has 3 channels without a colour"));
  }
}

/// Three things that light each other.
Scene small_scene(const std::string& material) {
  Scene scene = scene_of(parse_material("lambert:scale=0.6/0.5/0.4"), {PlaneShape{}});
  scene.materials.push_back({"it", parse_material(material)});
  scene.shapes.push_back({SphereShape{{-1, 0, 1}, 1}, 1});
  scene.shapes.push_back({CylinderShape{{1, 0.5, 0}, {0, 0, 1.5}, 0.6}, 1});
  scene.lights.push_back({{-2, -3, 5}, {20, 20, 20}});
  scene.sky = {SkyKind::overcast, {0.5, 0.6, 0.8}};
  scene.bounces = 3;
  scene.camera = {.position = {0, -7, 3}, .target = {0, 0, 0.8}, .field_of_view = 0.5, .size = {24, 16}};
  return scene;
}

class Strategies : public ::testing::TestWithParam<std::string> {};

TEST_P(Strategies, AgreeWithinTheirVariances) {
  const Scene scene = small_scene(GetParam());
  const SceneImage a = render_scene(device(), scene, {.samples = 192, .seed = 3});
  const SceneImage b = render_scene(device(), scene, {.samples = 192, .seed = 4, .proposal = SamplingStrategy::cosine});

  const Eigen::Matrix3Xd variance = a.variance_of_mean() + b.variance_of_mean();
  const Eigen::Matrix3Xd difference = a.radiance - b.radiance;
  // Colours of a pixel vary together, so that green alone is asked; pixels that hardly vary see the sky alone.
  double chi2 = 0;
  double count = 0;
  for (Eigen::Index k = 0; k < variance.cols(); ++k) {
    if (variance(1, k) < 1e-12) continue;
    chi2 += difference(1, k) * difference(1, k) / variance(1, k);
    ++count;
  }
  ASSERT_GT(count, 200);
  // Tails of weights are longer than those of a normal distribution: a tenth beside what chance alone does.
  EXPECT_NEAR(chi2 / count, 1, kErrors * std::sqrt(2 / count) + 0.1);
  for (std::size_t c = 0; c < 3; ++c) {
    const Estimate one = a.mean_radiance().at(c);
    const Estimate other = b.mean_radiance().at(c);
    EXPECT_NEAR(one.value, other.value, kErrors * std::hypot(one.error, other.error)) << c;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Strategies,
                         ::testing::Values("ggx:alpha=0.5", "lambert:scale=0.3/0.2/0.1+ward:m=0.4,scale=0.4",
                                           "ward_anisotropic:m_x=0.3,m_y=0.6,rotation=0.3", "exponential_patch:s=4"),
                         [](const auto& test) { return test_name(test.param); });

TEST(Scene, IsTheSameForTheSameSeedAndInParts) {
  const Scene scene = small_scene("ggx:alpha=0.3");
  const SceneImage one = render_scene(device(), scene, {.samples = 24, .seed = 9});
  const SceneImage again = render_scene(device(), scene, {.samples = 24, .seed = 9});
  const SceneImage first = render_scene(device(), scene, {.samples = 8, .seed = 9});
  const SceneImage rest = render_scene(device(), scene, {.samples = 16, .seed = 9, .first = 8});
  const SceneImage other = render_scene(device(), scene, {.samples = 24, .seed = 10});

  EXPECT_EQ(one.radiance, again.radiance);
  EXPECT_EQ(one.variance, again.variance);
  EXPECT_LT((one.radiance - (first.radiance * 8 + rest.radiance * 16) / 24).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_GT((one.radiance - other.radiance).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Scene, RefinedInStepsIsThatOfAsManySamples) {
  Scene scene = scene_of(parse_material("ggx:alpha=0.3,scale=0.8/0.3/0.1"), {SphereShape{}});
  scene.sky.radiance = {1, 1, 1};
  scene.camera.size = {20, 14};
  const SceneOptions options{.samples = 9, .seed = 3};
  const SceneOptions unlimited{.samples = 0, .noise = -1, .seed = 3};  // which do not count here
  SceneRendering rendering(device(), scene, unlimited);
  scene.sky.radiance = {0, 0, 0};  // it has a scene of its own
  EXPECT_EQ(rendering.samples(), 0U);
  EXPECT_TRUE(rendering.image().radiance.isZero(0));
  for (const std::size_t step : {1U, 2U, 6U}) rendering.refine(step);
  SceneRendering moved(std::move(rendering));
  const SceneImage image = moved.image();
  scene.sky.radiance = {1, 1, 1};
  const SceneImage whole = render_scene(device(), scene, options);
  EXPECT_EQ(image.samples, 9U);
  EXPECT_GT(image.seconds, 0);
  EXPECT_EQ(image.radiance, whole.radiance);
  EXPECT_EQ(image.variance, whole.variance);
  EXPECT_EQ(image.rounding, whole.rounding);
}

TEST(Scene, ShowsItsProgressAndStopsEarly) {
  const Scene scene = ground_below_a_ball();
  std::vector<std::size_t> samples;
  const SceneImage image =
      render_scene(device(), scene, {.samples = 100'000, .noise = 0.05, .refined = [&](const SceneImage& so_far) {
                                       samples.push_back(so_far.samples);
                                     }});

  EXPECT_LE(image.relative_noise(), 0.05);
  EXPECT_LT(image.samples, 100'000U);
  EXPECT_TRUE(std::ranges::is_sorted(samples));
  EXPECT_EQ(samples.back(), image.samples);
  EXPECT_THROW((void)render_scene(device(), scene, {.progress = [](std::string_view, double) { return false; }}),
               Cancelled);
}

// Sampling compared.

TEST(SamplingContest, FindsNothingToGainForCosinesAndMuchForLobes) {
  Scene scene = scene_of(parse_material("lambert"), {SphereShape{}});
  scene.shapes.push_back({PlaneShape{{0, 0, -1}}, 1});
  scene.materials.push_back({"ground", parse_material("lambert:scale=0.1+ggx:alpha=0.3")});
  scene.sky = {SkyKind::overcast, {1, 1, 1}};
  scene.camera.size = {20, 16};
  const std::vector<SceneMaterial> with{{"lambert", parse_material("lambert")},
                                        {"ggx", parse_material("ggx:alpha=0.1")}};

  const auto contests = compare_sampling(device(), scene, 0, with, {.samples = 128});

  ASSERT_EQ(contests.size(), 2U);
  EXPECT_DOUBLE_EQ(contests[0].equal_samples.value, 1);  // the same directions
  EXPECT_GT(contests[1].equal_samples.value - kErrors * contests[1].equal_samples.error, 3);
  const auto& [cosine, importance] = contests[1].radiance;
  EXPECT_NEAR(cosine.value, importance.value, kErrors * std::hypot(cosine.error, importance.error));
  EXPECT_GT(contests[1].pixels, 10U);
  EXPECT_GT(contests[1].equal_time.value, 0);
}

TEST(SamplingContest, HasNoRatioOfWhatDoesNotVary) {
  Scene scene = scene_of(parse_material("lambert"), {PlaneShape{}});
  scene.sky.radiance = {1, 1, 1};
  scene.camera = camera_at({0, 0, 0}, direction_of(0.5, 0.4), 5, 4);
  const std::vector<SceneMaterial> with{{"black", parse_material("lambert:scale=0")},
                                        {"grey", parse_material("lambert:scale=0.3")},
                                        {"mirror", parse_material("mirror:scale=0.7")}};
  for (const SamplingContest& contest : compare_sampling(device(), scene, 0, with, {.samples = 16})) {
    EXPECT_EQ(contest.variance[0].value, 0) << contest.material;
    EXPECT_EQ(contest.variance[1].value, 0) << contest.material;
    EXPECT_TRUE(std::isnan(contest.equal_samples.value)) << contest.material;
  }
}

// What is refused.

void expect_refusal(const Scene& scene, const SceneOptions& options, const std::string& message) {
  try {
    (void)render_scene(device(), scene, options);
    FAIL() << "was rendered: " << message;
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr(message));
  }
}

TEST(Scene, IsRefusedWhereItMakesNoSense) {
  const Scene good = ground_below_a_ball();
  expect_refusal(good, {.samples = 1}, "1 samples per pixel; expected 2 to");
  Scene scene = good;
  scene.materials[0].reflectance = parse_material("lambert:scale=0.1/0.2");
  expect_refusal(scene, {}, "'it' has 2 channels without a colour");
  scene = good;
  scene.shapes[0].material = 7;
  expect_refusal(scene, {}, "shape 1 of the scene has a material that the scene lacks");
  scene = good;
  scene.bounces = kMostBounces + 1;
  expect_refusal(scene, {}, "a scene of 63 bounces");
  scene = good;
  scene.lights.push_back({{0, 0, std::nan("")}, {1, 1, 1}});
  expect_refusal(scene, {}, "a light of the scene");
  scene = good;
  scene.materials[0].reflectance =
      tabulate(device(), parse_material("lambert:scale=0.5+mirror:rho=0.5"), HemisphereGrid::gauss(8, 16));
  expect_refusal(scene, {}, "has delta parts; expected a table of values");
  EXPECT_THROW((void)compare_sampling(device(), good, 0, good.materials, {.samples = 20}), ArgumentError);
  EXPECT_THROW((void)compare_sampling(device(), good, 5, good.materials, {.samples = 16}), ArgumentError);
}

// Files.

TEST(ScenePicture, ShowsWhiteAtTheExposureThatItChooses) {
  SceneImage image{.size = {10, 10}, .radiance = {}, .variance = {}, .samples = 4};
  image.radiance = Eigen::Matrix3Xd::Constant(3, 100, 0.25);
  image.radiance(0, 0) = 1000;  // one bright spot is no measure
  image.variance = Eigen::Matrix3Xd::Constant(3, 100, 0.04);
  EXPECT_DOUBLE_EQ(scene_exposure(image), 4);
  EXPECT_DOUBLE_EQ(image.variance_of_mean()(0, 0), 0.01);
  image.radiance.setZero();
  EXPECT_DOUBLE_EQ(scene_exposure(image), 1);
  EXPECT_TRUE(std::isinf(image.relative_noise()));
}

TEST(ScenePicture, KeepsRadiancesAndVariancesOfTheMeanAsOpenExr) {
  SceneImage image{.size = {3, 2}, .radiance = {}, .variance = {}, .samples = 4};
  image.radiance = Eigen::Matrix3Xd::Random(3, 6).cwiseAbs();
  image.variance = Eigen::Matrix3Xd::Random(3, 6).cwiseAbs();

  const FloatImage found = read_exr(FileBytes::copy("a.exr", scene_exr(image)), 3, 2);

  ASSERT_EQ(found.channels, (std::vector<std::string>{"R", "G", "B", "variance.B", "variance.G", "variance.R"}));
  for (Eigen::Index pixel = 0; pixel < 6; ++pixel) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto at = static_cast<std::size_t>(6 * pixel + c);
      EXPECT_EQ(found.values[at], static_cast<float>(image.radiance(c, pixel))) << pixel << ", " << c;
      EXPECT_EQ(found.values[at + 3], static_cast<float>(image.variance(2 - c, pixel) / 4)) << pixel << ", " << c;
    }
  }
}

TEST(ScenePicture, CountsTheRoundingOfOpenExrAsVariance) {
  SceneImage image{.size = {1, 1}, .radiance = {}, .variance = {}, .samples = 4};
  image.radiance = Eigen::Vector3d(0.2, 0.3, 1.1);
  image.variance = Eigen::Vector3d::Zero();

  const FloatImage found = read_exr(FileBytes::copy("a.exr", scene_exr(image)), 1, 1);

  for (Eigen::Index c = 0; c < 3; ++c) {
    const double off = double{found.values[static_cast<std::size_t>(c)]} - image.radiance(c, 0);
    const double error = std::sqrt(double{found.values[static_cast<std::size_t>(5 - c)]});
    EXPECT_LE(std::abs(off), std::sqrt(3.0) * error) << c;  // an even distribution ends there
    EXPECT_LT(error, 1e-7 * image.radiance(c, 0)) << c;
  }
}

}  // namespace
}  // namespace lobe::test
