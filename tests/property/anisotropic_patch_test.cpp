// Patches with an edge in an elliptic or a p-th power norm: albedos and products against areas of the base plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/table.hpp"
#include "model/evaluate.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"
#include "support/device.hpp"
#include "support/materials.hpp"
#include "support/names.hpp"
#include "support/options.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

/// The text of a number in a specification and the number.
struct Text {
  std::string text;
  [[nodiscard]] double number() const { return std::stod(text); }
};

struct Patch {
  Text radius, ratio, p, rotation;

  [[nodiscard]] std::string parameters() const {
    return ":R=" + radius.text + ",ratio=" + ratio.text + ",p=" + p.text + ",rotation=" + rotation.text;
  }
  [[nodiscard]] std::string mirror() const { return "basic_patch_anisotropic" + parameters(); }
  [[nodiscard]] std::string retro() const { return "retro_patch_anisotropic" + parameters(); }
  [[nodiscard]] reference::PatchNorm norm() const { return {ratio.number(), p.number(), rotation.number()}; }
  [[nodiscard]] double constant() const {
    return static_cast<double>(1 / reference::patch_norm_area(radius.number(), norm()));
  }
  /// Distance of the edge at an azimuth: 4.38 is homogeneous.
  [[nodiscard]] double reach(double azimuth) const {
    const reference::Vector grazing{std::cos(azimuth), std::sin(azimuth), 0};
    return radius.number() / static_cast<double>(reference::patch_metric({0, 0, 1}, grazing, norm()));
  }
};

std::ostream& operator<<(std::ostream& out, const Patch& patch) {
  return out << patch.mirror();
}

const Patch kEllipse{{"0.3"}, {"0.4"}, {"2"}, {"0.6"}};
const Patch kThinEllipse{{"0.02"}, {"0.05"}, {"2"}, {"-1"}};
const Patch kWideEllipse{{"1.2"}, {"0.6"}, {"2"}, {"0"}};
const Patch kRhombus{{"0.4"}, {"0.5"}, {"1"}, {"0.3"}};
const Patch kPillow{{"0.3"}, {"0.7"}, {"1.6"}, {"0"}};
const Patch kOdd{{"0.5"}, {"0.8"}, {"3"}, {"1.4"}};
const Patch kRectangle{{"0.25"}, {"0.4"}, {"20"}, {"0.2"}};

/// Area of the unit disc within the edge about a point of it, to 1e-8 or so: strips along the minor axis, adaptive.
double overlap(const Patch& patch, double theta, double azimuth) {
  const double x = std::sin(theta) * std::cos(azimuth - patch.rotation.number());
  const double y = std::sin(theta) * std::sin(azimuth - patch.rotation.number());
  const double radius = patch.radius.number();
  const double half = radius / patch.ratio.number();
  const double p = patch.p.number();
  const auto strip = [&](double u) {
    const double share = std::abs(u - x) / half;
    if (share >= 1 || std::abs(u) >= 1) return 0.0;
    const double height = radius * std::pow(1 - std::pow(share, p), 1 / p);
    const double circle = std::sqrt(1 - u * u);
    return std::max(0.0, std::min(y + height, circle) - std::max(y - height, -circle));
  };
  double area = 0;
  constexpr int kPieces = 16;
  for (int k = 0; k < kPieces; ++k) {
    area += reference::integrate(strip, x - half + 2 * half * k / kPieces, x - half + 2 * half * (k + 1) / kPieces,
                                 1e-11 * half * radius);
  }
  return area;
}

/// f . g under point light: over the base-plane vector z from the mirror direction, of the area common to two unit
/// discs z apart, pi - 2t - sin(2t) with |z| = 2 sin(t); the integral over |z| in closed form.
double point_product(const Patch& f, const Patch& g) {
  const auto sector = [&](double azimuth) {
    const double t = std::asin(std::min({f.reach(azimuth), g.reach(azimuth), 2.0}) / 2);
    return pi - (pi - 2 * t) * std::cos(2 * t) - std::sin(2 * t) - t + std::sin(4 * t) / 4;
  };
  constexpr int kSteps = 50000;  // the kinks where the edges cross cost the square of a step
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) sum += sector(pi * (k + 0.5) / kSteps);
  return 2 * pi / kSteps * sum * f.constant() * g.constant();
}

class AnisotropicPatch : public ::testing::TestWithParam<Patch> {};

TEST_P(AnisotropicPatch, HasAlbedosByTheAreaWithinItsEdge) {
  const std::vector<Direction> incident{{0, 0}, {0.6, 0.3}, {0.9, 1.2}, {1.2, 2.5}, {1.5, 0.7}, {1.57, 1.9}};
  for (const auto& specification : {GetParam().mirror(), GetParam().retro()}) {
    const auto found = albedo(device(), parse_material(specification), incident, {.tolerance = 1e-7}).at(0);

    for (std::size_t i = 0; i < incident.size(); ++i) {
      const double expected = GetParam().constant() * overlap(GetParam(), incident[i].theta, incident[i].phi);
      EXPECT_NEAR(found[i].value, expected, found[i].error + 1e-8) << specification << " " << i;
      EXPECT_LE(found[i].error, 1e-7 * found[i].value) << specification << " " << i;
    }
  }
}

TEST_P(AnisotropicPatch, HasTheAlbedo1AtNormalIncidenceAndNoLargerOne) {
  const std::vector<Direction> incident{{0, 0}, {0.4, 0.2}, {0.8, 1}, {1.2, 3}, {1.5, 5}};
  const auto found = albedo(device(), parse_material(GetParam().mirror()), incident, {.tolerance = 1e-7}).at(0);

  EXPECT_NEAR(found[0].value, 1, found[0].error);
  for (const Estimate& estimate : found) EXPECT_LE(estimate.value - estimate.error, 1) << estimate.value;
}

INSTANTIATE_TEST_SUITE_P(property, AnisotropicPatch,
                         ::testing::Values(kEllipse, kThinEllipse, kWideEllipse, kRhombus, kPillow, kOdd, kRectangle),
                         [](const auto& instance) { return "patch_" + std::to_string(instance.index); });

TEST(AnisotropicPatches, HaveThePointProductsOfTheAreaThatTheyShare) {
  const auto found =
      measure(device(), parse_all({kEllipse.mirror(), kRhombus.mirror()}), Lighting::point(), with_tolerance(1e-3));

  const double expected = point_product(kEllipse, kRhombus);
  EXPECT_NEAR(found.combined.gram(0, 1), expected, found.combined.gram_error(0, 1) + 1e-8);
  EXPECT_LE(found.combined.gram_error(0, 1), 1e-4 * expected);
}

// Those with Lambert's are the integral of their albedos.
TEST(AnisotropicPatches, HaveTheDaylightProductsOfTheirAlbedos) {
  const auto found =
      measure(device(), parse_all({kRhombus.retro(), "lambert"}), Lighting::daylight(), with_tolerance(1e-3));

  const double expected = point_product(kRhombus, kRhombus) / kRhombus.constant();
  EXPECT_NEAR(found.combined.gram(0, 1), expected, found.combined.gram_error(0, 1) + 1e-8);
  EXPECT_LT(found.combined.gram(0, 0), expected);  // no albedo is above 1
}

// |f|^2 = C^2 and f . lambert = C / pi times the same area of pairs of directions.
TEST(AnisotropicPatches, AboutTheRetroDirectionHaveThePointProductsOfThoseAboutTheMirrorDirection) {
  const auto found =
      measure(device(), parse_all({kEllipse.retro(), "lambert"}), Lighting::point(), with_tolerance(1e-3));

  const double expected = point_product(kEllipse, kEllipse);
  EXPECT_NEAR(found.combined.gram(0, 0), expected, found.combined.gram_error(0, 0) + 1e-8);
  EXPECT_NEAR(found.combined.gram(0, 1), expected / (kEllipse.constant() * pi), found.combined.gram_error(0, 1) + 1e-8);
}

// The coarsest levels of the rules are for loose tolerances, and agree by accident if at all.
TEST(AnisotropicPatches, LeaveTheNormsOfOtherLobesWithinLooseErrors) {
  const std::vector<std::pair<std::string, std::string>> pairs{
      {"basic_patch_anisotropic:R=0.5,ratio=0.5,rotation=0.4", "cook_torrance_torrance:m=0.05"},
      {"exponential_patch_anisotropic:s=5,ratio=0.3,p=1", "retro_metal_phong:n=10"},
      {kEllipse.mirror(), "ward:m=0.1"}};
  for (const auto& lighting : {Lighting::point(), Lighting::daylight()}) {
    for (const auto& [patch, other] : pairs) {
      const auto alone = measure(device(), parse_all({other}), lighting).combined;
      const auto beside = measure(device(), parse_all({patch, other}), lighting, with_tolerance(1e-2)).combined;
      SCOPED_TRACE(patch + " " + other + " " + lighting.name());
      EXPECT_NEAR(beside.gram(1, 1), alone.gram(0, 0), beside.gram_error(1, 1) + alone.gram_error(0, 0));
      EXPECT_LE(beside.gram_error(1, 1), 1e-2 * beside.gram(1, 1));
    }
  }
}

// With u = V_P - L'_P and v = V_P - L_P, dmu dmu = du dv / 4. Patches that are together smaller than the base plane do
// not meet the horizon: then the product across is 1/4, as the integral of each is 1.
TEST(AnisotropicPatches, AboutBothDirectionsHavePointProducts) {
  const Patch retro{{"0.3"}, {"0.9"}, {"2"}, {"0.6"}};
  const Patch mirror{{"0.4"}, {"0.7"}, {"2"}, {"-0.4"}};
  const std::vector<std::string> materials{retro.retro(), "lambert", mirror.mirror(),
                                           retro.retro() + ",scale=0.5+" + mirror.mirror(),
                                           retro.retro() + ",scale=0.5+" + mirror.mirror() + ",scale=1.00001"};
  const auto found = measure(device(), parse_all(materials), Lighting::point(), with_tolerance(1e-3)).combined;

  const double of_retro = point_product(retro, retro);
  const double of_mirror = point_product(mirror, mirror);
  const Eigen::MatrixXd& gram = found.gram;
  const Eigen::MatrixXd& error = found.gram_error;
  EXPECT_NEAR(gram(0, 0), of_retro, error(0, 0) + 1e-8);
  EXPECT_NEAR(gram(0, 1), of_retro / (retro.constant() * pi), error(0, 1) + 1e-8);
  EXPECT_NEAR(gram(1, 1), 1, error(1, 1));
  EXPECT_NEAR(gram(2, 2), of_mirror, error(2, 2) + 1e-8);
  EXPECT_NEAR(gram(2, 1), of_mirror / (mirror.constant() * pi), error(2, 1) + 1e-8);
  EXPECT_NEAR(gram(2, 0), 0.25, error(2, 0) + 1e-12);
  EXPECT_NEAR(gram(3, 3), of_retro / 4 + 0.25 + of_mirror, error(3, 3) + 1e-8);
  EXPECT_NEAR(gram(3, 1), 0.5 * gram(0, 1) + gram(2, 1), error(3, 1) + 1e-12);
  for (Eigen::Index i = 0; i < gram.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      EXPECT_LE(error(i, j), 1e-3 * std::sqrt(gram(i, i) * gram(j, j))) << i << " " << j;
    }
  }
  // One rule has all that two sums of both kinds differ by.
  EXPECT_NEAR(found.distance(4, 3), 1e-5 * std::sqrt(of_mirror), found.distance_error(4, 3) + 1e-12);
  EXPECT_LE(found.distance_error(4, 3), 1e-2 * found.distance(4, 3));
}

TEST(AnisotropicPatches, OfTheWholeBasePlaneAreLambertAlsoInTheGrazingDirectionAcross) {
  const double theta = std::nextafter(pi / 2, 0);
  const std::vector<Directions> pairs{{theta, theta, 0, pi / 2}, {theta, theta, pi, pi / 2}, {1.5, 1.5, 0, 0}};

  for (const char* name : {"basic_patch_anisotropic", "retro_patch_anisotropic"}) {
    const Eigen::MatrixXd values = evaluate(device(), parse_material(std::string(name) + ":R=2,ratio=0.5"), pairs);
    for (Eigen::Index i = 0; i < values.rows(); ++i) EXPECT_NEAR(values(i, 0), 1 / pi, 1e-15) << name << " " << i;
  }
}

TEST(AnisotropicPatches, AreRefusedByGridsThatDoNotResolveThem) {
  EXPECT_THROW((void)tabulate(device(), parse_material(kThinEllipse.mirror()), HemisphereGrid::gauss(16, 32)),
               NumericError);
}

/// Powers whose norm has kinks.
TEST(ExponentialPatch, InANormOfAnyPowerHasTheAlbedosOfAPlainQuadrature) {
  for (const char* p : {"1", "1.5", "3"}) {
    const reference::PatchNorm norm{0.4L, std::stold(p), 0.4L};
    const reference::Real constant = reference::exponential_patch_constant(6, norm);
    const reference::Lobe lobe{[=](const reference::Vector& l, const reference::Vector& v) {
                                 return constant * std::exp(-6 * reference::patch_metric(l, v, norm));
                               },
                               0.1};
    const std::vector<Direction> incident{{0, 0}, {0.8, 0.4}, {1.3, 1.3}};

    const auto found =
        albedo(device(), parse_material("exponential_patch_anisotropic:s=6,ratio=0.4,rotation=0.4,p=" + std::string(p)),
               incident, {.tolerance = 1e-7})
            .at(0);

    EXPECT_NEAR(found[0].value, 1, found[0].error) << p;
    for (std::size_t i = 1; i < incident.size(); ++i) {
      const double expected = reference::albedo_at(lobe, incident[i].theta, incident[i].phi, 1e-7);
      EXPECT_NEAR(found[i].value, expected, found[i].error + 1e-6) << p << " " << i;
    }
  }
}

}  // namespace
}  // namespace lobe::test
