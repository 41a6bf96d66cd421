// Whether materials and tables are found to be what they are known to be.
#include "lobe/energy/plausibility.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "energy/adaptive_albedo.hpp"
#include "energy/plausibility.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

ChannelPlausibility checked(const std::string& specification, const PlausibilityOptions& options = {}) {
  return check_plausibility(device(), parse_material(specification), options).channels.at(0);
}

// Portsmouth, Kutz and Hill 2025: E(x) = A (1 + r G(x)/pi) of the first scattering, and the rest of later ones.
TEST(Albedo, OfEnergyPreservingOrenNayarHasItsClosedForm) {
  for (const double r : {0.0, 0.3, 1.0}) {
    for (const double rho : {0.2, 1.0}) {
      const double normal = 1 / (1 + (0.5 - 2 / (3 * pi)) * r);
      const double mean = normal * (1 + (2.0 / 3 - 28 / (15 * pi)) * r);
      const std::vector<double> angles{0, 0.5, 1, 1.5, 1.57};
      const std::string name = "eon:r=" + std::to_string(r) + ",rho=" + std::to_string(rho);

      const auto found = albedo(device(), parse_material(name), angles, {.tolerance = 1e-9}).at(0);

      for (std::size_t k = 0; k < angles.size(); ++k) {
        const double sine = std::sin(angles[k]);
        const double cosine = std::cos(angles[k]);
        const double g =
            sine * (angles[k] - sine * cosine) + 2.0 / 3 * (sine / cosine * (1 - sine * sine * sine) - sine);
        const double first = normal * (1 + r * g / pi);
        const double multiple = rho * rho * mean / (1 - rho * (1 - mean));
        EXPECT_NEAR(found[k].value, rho * first + multiple * (1 - first), found[k].error + 1e-13) << name << " " << k;
        EXPECT_LE(found[k].error, 1e-8) << name << " " << k;
      }
      const Estimate all = mean_albedo(device(), parse_material(name)).at(0);
      EXPECT_NEAR(all.value, rho * mean + rho * rho * mean / (1 - rho * (1 - mean)) * (1 - mean), all.error) << name;
    }
  }
}

TEST(Plausibility, OfWardIsLostToAnAlbedoThatGrowsWithTheExponentOneHalf) {
  const auto found = checked("ward:m=0.1");

  ASSERT_TRUE(found.albedo.growth);
  EXPECT_NEAR(found.albedo.growth->value, 0.5, 0.01);  // errata, finding 1
  EXPECT_LE(std::abs(found.albedo.growth->value - 0.5), found.albedo.growth->error);
  EXPECT_FALSE(found.conserves_energy);
  EXPECT_TRUE(found.is_reciprocal);
  EXPECT_TRUE(found.is_non_negative);
}

TEST(Plausibility, OfNarrowWardLobesNeedsDirectionsFarBelowTheirWidth) {
  // Up to an elevation of 1e-7 no albedo of this lobe is above 1.
  const auto found = checked("ward:m=0.0003", {.with_mean_albedo = false});

  ASSERT_TRUE(found.albedo.growth);
  EXPECT_NEAR(found.albedo.growth->value, 0.5, 0.01);
}

TEST(Plausibility, OfCookTorranceIsKeptByABoundedAlbedo) {
  // The dissertation says that it grows without bound; errata, finding 1.
  const auto found = checked("cook_torrance:m=0.1");

  EXPECT_FALSE(found.albedo.growth);
  EXPECT_NEAR(found.albedo.largest.value, 1, found.albedo.largest.error);
  EXPECT_TRUE(found.is_plausible());
}

TEST(Plausibility, OfTheHarmonicMeanIsLostToTheExponentOne) {
  const auto found = checked("phong_mean:n=20,p=-1", {.tolerance = 1e-3, .with_mean_albedo = false});

  ASSERT_TRUE(found.albedo.growth);
  EXPECT_NEAR(found.albedo.growth->value, 1, 0.01);  // errata, finding 3
}

TEST(Plausibility, FindsTheLargestAlbedoAndItsAngle) {
  const auto found = checked("metal_phong:n=1", {.tolerance = 1e-6, .with_mean_albedo = false});

  // Errata, chapter 3: 2.886e-4 too much at 12.91 degrees.
  EXPECT_NEAR(found.albedo.largest.value, 1.0002886, 1e-7);
  EXPECT_NEAR(found.albedo.at.theta * 180 / pi, 12.91, 0.5);
  EXPECT_FALSE(found.conserves_energy);
}

// At a tolerance of 1e-3 most of these were off by 1.02 to 2.14 times what was stated: by two levels of quadrature that
// agreed by accident, and by larger albedos elsewhere that were less certain.
TEST(Plausibility, StatesHowFarTheLargestAlbedoIsOff) {
  for (const std::string specification :
       {"abg:a=251,b=5.01e-05,g=6", "cook_torrance_smith:m=0.0708,f0=0",
        "cook_torrance_trowbridge_fresnel:q=0.00562,ior=0.01,k=0", "cox_munk:wind=1.58,ior=1.34,k=0",
        "cox_munk:wind=0.0185,ior=1.34,k=0", "ggx:alpha=0.00562,f0=1", "tobler_power:n=4",
        "bagher_sgd:alpha=10,p=1.65,f0=1,f1=0,lambda=1,k=10,theta0=0"}) {
    const auto at = [&](double tolerance) {
      return checked(specification, {.tolerance = tolerance, .pairs = 4, .with_mean_albedo = false}).albedo.largest;
    };
    const Estimate rough = at(1e-3);
    const Estimate fine = at(1e-6);
    EXPECT_NEAR(rough.value, fine.value, rough.error + fine.error) << specification;
    EXPECT_LE(rough.error, 3e-3 * rough.value) << specification;
    EXPECT_LE(fine.error, 3e-5 * fine.value) << specification;
  }
}

// Halves of what is no finite number are none either: this took a million nodes for each direction.
TEST(AlbedosThatAreNoFiniteNumbers, AreGivenUpSoon) {
  AdaptiveAlbedo integral(device(), parse_material("lafortune:c_xy=-10,c_z=1,n=14100"), Precision::double_precision);
  const std::vector<IncidentNode> incident{{pi / 4, 1, 0}};

  EXPECT_FALSE(integral.within(incident, 1e-5, 1'000'000).front().is_finite);
  EXPECT_LT(integral.nodes(), 100'000U);
}

TEST(Plausibility, FindsTheLargestAlbedoOfAnisotropicLobesAtAnyAzimuth) {
  const PlausibilityOptions options{.tolerance = 1e-4, .angles = 10, .with_mean_albedo = false};
  const std::string lobe = "metal_phong_anisotropic:n=0.5,c_y=0.6";

  const auto found = checked(lobe, options);
  const auto turned = checked(lobe + ",rotation=0.7", options);

  EXPECT_FALSE(found.albedo.growth);
  EXPECT_NEAR(found.albedo.largest.value, turned.albedo.largest.value,
              found.albedo.largest.error + turned.albedo.largest.error);
  const auto there = albedo(device(), parse_material(lobe), std::vector{found.albedo.at}, {.tolerance = 1e-4});
  EXPECT_NEAR(found.albedo.largest.value, there.at(0).at(0).value, found.albedo.largest.error);
}

// f(L, V) = g(L) g(V), of which half a turn about the normal leaves nothing the same: a(L) = g(L) times the integral of
// g, by sums over rings of the base plane.
TEST(Plausibility, FindsTheLargestAlbedoOnTheSideWhereItIs) {
  constexpr double kX = -0.6;
  constexpr double kY = -0.22;  // at an azimuth of 200 degrees
  const auto g = [](double x, double y) { return 0.2 + std::exp(-20 * ((x - kX) * (x - kX) + (y - kY) * (y - kY))); };
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
  term.formula = Formula{.text =
                             "(0.2 + exp(-20 * ((in_x + 0.6) * (in_x + 0.6) + (in_y + 0.22) * (in_y + 0.22))))"
                             "* (0.2 + exp(-20 * ((out_x + 0.6) * (out_x + 0.6) + (out_y + 0.22) * (out_y + 0.22))))"};
  constexpr int kSteps = 400;
  double whole = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = (i + 0.5) / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      const double phi = 2 * pi * k / kSteps;
      whole += r * g(r * std::cos(phi), r * std::sin(phi)) * 2 * pi / (kSteps * kSteps);
    }
  }

  const auto found = check_plausibility(device(), {"one side", "", {term}},
                                        {.tolerance = 1e-4, .pairs = 64, .angles = 10, .with_mean_albedo = false})
                         .channels.at(0);

  // Sums over rings are off by 1/(24 n^2) or so of what they sum.
  EXPECT_NEAR(found.albedo.largest.value, g(kX, kY) * whole, found.albedo.largest.error + 1e-5);
  EXPECT_NEAR(std::sin(found.albedo.at.theta) * std::cos(found.albedo.at.phi), kX, 0.02);
  EXPECT_NEAR(std::sin(found.albedo.at.theta) * std::sin(found.albedo.at.phi), kY, 0.02);
}

TEST(Plausibility, FindsNegativeValuesOfNarrowLobes) {
  // The lobe is 0.002 rad wide: none of 10 000 directions spread evenly would meet it.
  const auto found = checked("lambert:scale=0.9+phong:n=200000,scale=-0.001", {.with_mean_albedo = false});

  EXPECT_FALSE(found.is_non_negative);
  EXPECT_LT(found.least.value.value, 0.9 / pi - 0.99 * 0.001 * 200002 / (2 * pi));
  EXPECT_NEAR(found.least.at.theta_in, found.least.at.theta_out, 0.002);
}

TEST(Plausibility, IsThatOfEveryChannel) {
  auto material = parse_material("lambert");
  material.terms[0].weight = {0.5, 1.5, 1};

  const auto found = check_plausibility(device(), material, {.pairs = 64, .with_mean_albedo = true});

  ASSERT_EQ(found.channels.size(), 3U);
  EXPECT_TRUE(found.channels[0].is_plausible());
  EXPECT_FALSE(found.channels[1].conserves_energy);
  EXPECT_TRUE(found.channels[2].is_plausible());
  EXPECT_NEAR(found.channels[1].mean_albedo->value, 1.5, 1e-5);
}

TEST(Plausibility, CountsMirrorsAmongAlbedos) {
  EXPECT_TRUE(checked("mirror").is_plausible());
  EXPECT_EQ(checked("mirror:rho=0.5+rrim:rho=0.25").albedo.largest.value, 0.75);

  const auto coated = checked("mirror:rho=0.6+lambert:scale=0.5");

  EXPECT_NEAR(coated.albedo.largest.value, 1.1, 1e-6);
  EXPECT_NEAR(coated.mean_albedo->value, 1.1, 1e-6);
  EXPECT_FALSE(coated.conserves_energy);
}

TEST(Plausibility, KnowsTheEdgesOfPatches) {
  const auto mirror = check_plausibility(device(), parse_material("basic_patch:R=0.5"), {.with_mean_albedo = false});
  const auto retro = check_plausibility(device(), parse_material("retro_patch:R=0.3"), {.with_mean_albedo = false});

  ASSERT_EQ(mirror.breaks.size(), 1U);
  EXPECT_FALSE(mirror.breaks[0].is_about_retro);
  EXPECT_EQ(mirror.breaks[0].radius, 0.5);
  ASSERT_EQ(retro.breaks.size(), 1U);
  EXPECT_TRUE(retro.breaks[0].is_about_retro);
  // Within, (4.2) is 1 over the area of the disc.
  EXPECT_GT(mirror.breaks[0].jump.at(0), 0.999 / (pi * 0.25));
  EXPECT_GT(retro.breaks[0].jump.at(0), 0.999 / (pi * 0.09));
}

TEST(Plausibility, FindsTheJumpOfAnAnisotropicPatchAcrossIt) {
  for (const bool is_about_retro : {false, true}) {
    SCOPED_TRACE(is_about_retro);
    const std::string model = is_about_retro ? "retro_patch_anisotropic" : "basic_patch_anisotropic";
    const auto found = check_plausibility(device(), parse_material(model + ":R=0.2,ratio=0.4,rotation=0.7"),
                                          {.angles = 4, .azimuths = 2, .with_mean_albedo = false});

    ASSERT_EQ(found.breaks.size(), 1U);
    EXPECT_EQ(found.breaks[0].is_about_retro, is_about_retro);
    EXPECT_TRUE(found.breaks[0].is_anisotropic);
    EXPECT_EQ(found.breaks[0].radius, 0.2);
    EXPECT_NEAR(found.breaks[0].jump.at(0), 1 / (pi * 0.2 * 0.5), 1e-12);
  }
}

TEST(Plausibility, CountsAlbedosThatDidNotReachTheTolerance) {
  EXPECT_EQ(check_plausibility(device(), parse_material("lambert")).unresolved, 0U);

  const auto material = parse_material("ggx:alpha=0.01");
  const Plausibility rough =
      check_plausibility(device(), material, {.pairs = 4, .most_nodes = 1, .with_mean_albedo = false});
  const Estimate fine = checked("ggx:alpha=0.01", {.pairs = 4, .with_mean_albedo = false}).albedo.largest;
  EXPECT_GT(rough.unresolved, 0U);
  const Estimate& largest = rough.channels.front().albedo.largest;
  EXPECT_NEAR(largest.value, fine.value, largest.error + fine.error);
}

// The error of the largest albedo says how much larger another may be; one above 1 that is certain stays above 1.
TEST(Plausibility, IsLostToAnAlbedoThatIsCertainBesideOthersThatAreNot) {
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
  term.formula = Formula{.text = "1.05 / pi + where(cos_i < 0.5, 0.3 * sin(300 * theta_o), 0)"};
  const Plausibility found =
      check_plausibility(device(), {"restless", "", {term}}, {.pairs = 4, .most_nodes = 1, .with_mean_albedo = false});
  const ChannelPlausibility& channel = found.channels.front();
  EXPECT_LT(channel.albedo.largest.value - channel.albedo.largest.error, 1);
  EXPECT_FALSE(channel.conserves_energy);
}

TEST(Plausibility, KnowsLargestAlbedosBelowZero) {
  const Estimate largest = checked("lambert:scale=-1", {.pairs = 4, .with_mean_albedo = false}).albedo.largest;
  EXPECT_NEAR(largest.value, -1, largest.error);
  EXPECT_LE(largest.error, 1e-5);
}

TEST(Plausibility, RefusesOptionsOutOfRange) {
  EXPECT_THROW(static_cast<void>(checked("lambert", {.tolerance = 0})), ArgumentError);
  EXPECT_THROW(static_cast<void>(checked("lambert", {.pairs = 3})), ArgumentError);
  EXPECT_THROW(static_cast<void>(checked("lambert", {.most_nodes = 0})), ArgumentError);
}

BrdfTable small_table(const std::string& specification) {
  return tabulate(device(), parse_material(specification), HemisphereGrid::gauss(12, 24));
}

TEST(TablePlausibility, OfATabulatedMaterialIsThatOfTheMaterial) {
  const auto phong = check_plausibility(small_table("phong:n=5"));
  const auto bright = check_plausibility(small_table("phong:n=5,scale=1.2"));

  EXPECT_TRUE(phong.is_plausible());
  EXPECT_NEAR(phong.channels.at(0).mean_albedo->value, mean_albedo(device(), parse_material("phong:n=5"))[0].value,
              phong.channels.at(0).mean_albedo->error);
  EXPECT_FALSE(bright.channels.at(0).conserves_energy);
  EXPECT_TRUE(bright.channels.at(0).is_reciprocal);
}

TEST(TablePlausibility, FindsWhatIsWrongInOneValue) {
  auto table = small_table("lambert:scale=0.5");
  const std::size_t half = table.grid.half_azimuths();
  const std::size_t at = (2 * table.rows() + 7) * half + 3;
  table.values[at] = -0.125;

  const auto found = check_plausibility(table).channels.at(0);

  EXPECT_FALSE(found.is_non_negative);
  EXPECT_EQ(found.least.value.value, -0.125);
  EXPECT_FALSE(found.is_reciprocal);
  EXPECT_NEAR(found.reciprocity.absolute, 0.125 + 0.5 / pi, 1e-12);
  const double theta = table.grid.rings()[2].theta;
  EXPECT_TRUE(found.reciprocity.absolute_at.theta_in == theta || found.reciprocity.absolute_at.theta_out == theta);
  EXPECT_GT(found.reciprocity.relative, 0);
  EXPECT_LT(found.reciprocity.relative, 0.1);
}

TEST(TablePlausibility, OfGeneralTablesIsTheSame) {
  const auto table = small_table("phong:n=5,scale=1.2");

  const auto isotropic = check_plausibility(table).channels.at(0);
  const auto general = check_plausibility(to_general(table)).channels.at(0);

  EXPECT_NEAR(isotropic.albedo.largest.value, general.albedo.largest.value, 1e-12);
  EXPECT_EQ(isotropic.albedo.at.theta, general.albedo.at.theta);
  EXPECT_TRUE(general.is_reciprocal);
  EXPECT_EQ(isotropic.least.value.value, general.least.value.value);
}

}  // namespace
}  // namespace lobe::test
