// Compositions at single pairs of directions: closed forms, identities, and an independent quadrature.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "lobe/algebra/pointwise.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/composition.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"
#include "support/device.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using reference::Lobe;
using reference::Real;
using reference::Vector;
using std::numbers::pi;

Estimate composed(const std::string& f, const std::string& g, const Directions& pair,
                  const PointwiseOptions& options = {}) {
  return composition_at(device(), parse_material(f), parse_material(g), {&pair, 1}, options).at(0).at(0);
}

// --- Closed forms.

struct Exponents {
  std::string name;
  double m, n;
};
std::ostream& operator<<(std::ostream& out, const Exponents& exponents) {
  return out << exponents.name;
}

class ComposedPhong : public ::testing::TestWithParam<Exponents> {};

TEST_P(ComposedPhong, IsAPowerIntegralAtTheNormal) {
  const auto [name, m, n] = GetParam();
  const double expected = (m + 2) * (n + 2) / (2 * pi * (m + n + 2));  // c_m c_n 2 pi / (m+n+2)
  const Directions normal{0, 0, 0};

  const auto value =
      composition_at(device(), make_material("phong", {{"n", m}}), make_material("phong", {{"n", n}}), {&normal, 1})
          .at(0)
          .at(0);

  EXPECT_NEAR(value.value, expected, 1e-11 * expected);
  EXPECT_LE(std::abs(value.value - expected), value.error);
}

INSTANTIATE_TEST_SUITE_P(property, ComposedPhong,
                         ::testing::Values(Exponents{"half_and_one", 0.5, 1}, Exponents{"5_and_20", 5, 20},
                                           Exponents{"1_and_1e6", 1, 1e6}, Exponents{"1e3_and_1e5", 1e3, 1e5},
                                           Exponents{"1e6_and_1e6", 1e6, 1e6}),
                         ByName{});

TEST(Composition, OfMinnaertsIsSeparable) {
  // c_j c_k (N.L)^j (N.V)^k times the integral of (N.X)^(j+k), 2 pi / (j+k+2).
  const Directions pair{1.1, 0.4, 2};
  const double expected = 3 * 4 / (4 * pi * pi) * std::cos(1.1) * std::pow(std::cos(0.4), 2) * 2 * pi / 5;

  EXPECT_NEAR(composed("minnaert:k=1", "minnaert:k=2", pair).value, expected, 1e-12 * expected);
}

struct Discs {
  std::string name;
  double radius_f, radius_g;
  Directions pair;
};
std::ostream& operator<<(std::ostream& out, const Discs& discs) {
  return out << discs.name;
}

class ComposedPatches : public ::testing::TestWithParam<Discs> {};

TEST_P(ComposedPatches, AreTheAreaCommonToTwoDiscs) {
  const auto& [name, r1, r2, pair] = GetParam();
  const double s1 = std::sin(pair.theta_in);
  const double s2 = std::sin(pair.theta_out);
  ASSERT_TRUE(s1 + r1 <= 1 || s2 + r2 <= 1) << "the lens must lie in the unit disc";
  const double distance = std::sqrt(s1 * s1 + s2 * s2 - 2 * s1 * s2 * std::cos(pair.delta_phi));
  const double expected = static_cast<double>(reference::lens_area(r1, r2, distance)) / (pi * pi * r1 * r1 * r2 * r2);

  const auto value = composition_at(device(), make_material("basic_patch", {{"R", r1}}),
                                    make_material("basic_patch", {{"R", r2}}), {&pair, 1})
                         .at(0)
                         .at(0);

  EXPECT_NEAR(value.value, expected, 1e-9 * expected);
  EXPECT_LE(std::abs(value.value - expected), value.error + 1e-13 * expected);
}

INSTANTIATE_TEST_SUITE_P(property, ComposedPatches,
                         ::testing::Values(Discs{"concentric", 0.3, 0.5, {0, 0, 0}},
                                           Discs{"equal_at_the_normal", 0.25, 0.25, {0, 0, 0}},
                                           Discs{"one_inside", 0.1, 0.5, {0.1, 0.2, 1}},
                                           Discs{"lens_near_the_normal", 0.3, 0.4, {0.1, 0.3, 2}},
                                           Discs{"lens_in_plane", 0.2, 0.2, {0.5, 0.3, 0}},
                                           Discs{"lens_across_the_normal", 0.3, 0.2, {0.2, 0.1, pi}},
                                           Discs{"sliver", 0.2, 0.1, {0.3, 0.582, 0.1}},
                                           Discs{"small_radii", 0.004, 0.003, {0.7, 0.705, 0.004}},
                                           Discs{"unequal_radii", 0.9, 0.002, {0.05, 1.07, 0.3}},
                                           Discs{"apart", 0.1, 0.1, {0.5, 0.5, 2}}),
                         ByName{});

// --- Identities.

struct Incidence {
  std::string name;
  std::string material;
  double theta;
};
std::ostream& operator<<(std::ostream& out, const Incidence& incidence) {
  return out << incidence.name;
}

class ComposedWithLambert : public ::testing::TestWithParam<Incidence> {};

TEST_P(ComposedWithLambert, IsTheAlbedoOverPi) {
  const std::vector<double> theta{GetParam().theta};
  const auto expected = albedo(device(), parse_material(GetParam().material), theta, {.tolerance = 1e-9}).at(0).at(0);

  const auto value = composed(GetParam().material, "lambert", {GetParam().theta, 0.7, 2});

  EXPECT_NEAR(value.value * pi, expected.value, pi * value.error + expected.error);
}

INSTANTIATE_TEST_SUITE_P(property, ComposedWithLambert,
                         ::testing::Values(Incidence{"phong", "phong:n=100000", 0.5},
                                           Incidence{"ward_grazing", "ward:m=0.2", 1.57},
                                           Incidence{"sharp_ward", "ward:m=0.005", 1.2},
                                           Incidence{"cook_torrance", "cook_torrance:m=0.3", 1.4},
                                           Incidence{"oren_nayar", "oren_nayar:sigma=0.5", 0.001},
                                           Incidence{"basic_patch", "basic_patch:R=0.5", 0.8},
                                           Incidence{"metal_phong", "metal_phong:n=20", 1.1},
                                           Incidence{"exponential_patch", "exponential_patch:s=8", 0}),
                         ByName{});

struct Composed {
  std::string name;
  std::string f, g;
  Lobe reference_f, reference_g;
  Directions pair;
};
std::ostream& operator<<(std::ostream& out, const Composed& composed) {
  return out << composed.name;
}

class CompositionOf : public ::testing::TestWithParam<Composed> {};

TEST_P(CompositionOf, IsThatOfAnIndependentQuadrature) {
  const auto& c = GetParam();

  const auto value = composed(c.f, c.g, c.pair);
  const double expected = reference::composition(c.reference_f, c.reference_g, c.pair, 1e-12 * value.value);

  EXPECT_NEAR(value.value, expected, value.error + 2e-9 * expected);
}

TEST_P(CompositionOf, IsSemiSymmetric) {
  const auto& c = GetParam();
  const Directions swapped{c.pair.theta_out, c.pair.theta_in, -c.pair.delta_phi};

  const auto forward = composed(c.f, c.g, c.pair);
  const auto backward = composed(c.g, c.f, swapped);

  EXPECT_NEAR(forward.value, backward.value, forward.error + backward.error);
}

TEST_P(CompositionOf, EstimateCoversTheDifferenceToAFinerRun) {
  const auto& c = GetParam();

  const auto fine = composed(c.f, c.g, c.pair, {.tolerance = 1e-10});
  EXPECT_LE(fine.error, 1e-10 * fine.value);
  // Tolerances with 7, 11 and 15 nodes.
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const auto coarse = composed(c.f, c.g, c.pair, {.tolerance = tolerance});
    EXPECT_LE(coarse.error, tolerance * coarse.value) << tolerance;
    EXPECT_LE(std::abs(coarse.value - fine.value), coarse.error + fine.error) << tolerance;
  }
}

// Of 5010 random compositions the one whose error came nearest to the estimate: a third of it would be too little.
TEST(Composition, HasAnEstimateOfFewNodesThatHolds) {
  const Directions pair{.theta_in = 53.2649 * kDegree, .theta_out = 82.278 * kDegree, .delta_phi = 0};
  const std::string f = "bagher_sgd:alpha=0.5519,p=0.09082,f0=1.966,f1=1.243,lambda=3.891,k=3.928,theta0=-0.2369";
  const std::string g = "he_torrance:sigma=0.01813,tau=17.16,ior=23.24,k=1.059";
  const auto rough = composed(f, g, pair, {.tolerance = 1e-2});
  const auto fine = composed(f, g, pair, {.tolerance = 1e-10});

  EXPECT_LE(std::abs(rough.value - fine.value), rough.error);
  EXPECT_GT(std::abs(rough.value - fine.value), rough.error / 3);
}

// The tail of a sharp lobe within the edge of a disc falls so steeply from there that no node sees it: as a formula, of
// which only its jump tells, as much as for the model.
TEST(Composition, OfASharpLobeAndAFormulaThatJumpsIsThatOfTheModel) {
  const Directions pair{61.33231859172974 * kDegree, 32.2197455793261 * kDegree, 58.4019937699636 * kDegree};
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
  term.formula = Formula{.text = "where(distance_p <= 0.6, 0.8841941, 0)", .parameters = {}, .width = 0.3};
  const Material jumps{"disc", "", {term}};
  const Material disc = parse_material("basic_patch:R=0.6");
  const Material sharp = parse_material("phong:n=14520");

  const auto rough = composition_at(device(), jumps, sharp, {&pair, 1}, {.tolerance = 1e-2}).front().front();
  const auto fine = composition_at(device(), disc, sharp, {&pair, 1}, {.tolerance = 1e-9}).front().front();

  EXPECT_GT(fine.value, 1e-75);
  EXPECT_NEAR(rough.value, fine.value, rough.error + 1e-6 * fine.value);
}

Lobe lobe_of(Real (*model)(const Vector&, const Vector&, Real), Real parameter, double width) {
  return {[=](const Vector& l, const Vector& v) { return model(l, v, parameter); }, width};
}
Lobe phong(Real n) {
  return lobe_of(reference::phong, n, static_cast<double>(1 / std::sqrt(n)));
}
Lobe ward(Real m) {
  return lobe_of(reference::ward, m, static_cast<double>(2 * m));
}
Lobe cook_torrance(Real m) {
  return {[=](const Vector& l, const Vector& v) { return reference::cook_torrance(l, v, m, 1); },
          static_cast<double>(2 * m)};
}
Lobe oren_nayar(Real sigma) {
  return {[=](const Vector& l, const Vector& v) { return reference::oren_nayar(l, v, sigma, 0.33L); }, 1};
}

// --- Anisotropic factors and delta parts.

TEST(AnisotropicComposition, IsThatOfAnIndependentQuadrature) {
  const auto ward = [](Real rotation) {
    return Lobe{
        [=](const Vector& l, const Vector& v) { return reference::ward_anisotropic(l, v, 0.3L, 0.6L, rotation); }, 0.6};
  };
  const std::string text = "ward_anisotropic:m_x=0.3,m_y=0.6,rotation=";
  for (const Directions& pair : {Directions{0.5, 0.9, 1, 0.4}, Directions{1.2, 0.3, -2, 3}}) {
    SCOPED_TRACE(pair.theta_in);
    const auto beside = composed(text + "0.5", "phong:n=20", pair);
    const double expected = reference::composition(ward(0.5L), phong(20), pair, 1e-9 * beside.value);
    EXPECT_NEAR(beside.value, expected, beside.error + 2e-8 * expected);
    EXPECT_LE(beside.error, 1e-6 * expected);

    const auto both = composed(text + "0.5", text + "-0.3", pair);
    const double of_both = reference::composition(ward(0.5L), ward(-0.3L), pair, 1e-9 * both.value);
    EXPECT_NEAR(both.value, of_both, both.error + 2e-8 * of_both);
  }
}

double value_at(const std::string& text, const Directions& pair) {
  return evaluate(device(), Reflectance(parse_material(text)), {&pair, 1}).value(0, 0);
}

/// A mirror turns the direction of its own side by half a turn, a retro-mirror leaves it.
TEST(CompositionWithDeltaParts, HasTheValuesOfTheOtherFactor) {
  const Directions pair{0.5, 0.9, 1, 0.4};
  const Directions light_turned{0.5, 0.9, 1 - pi, 0.4 + pi};
  const Directions view_turned{0.5, 0.9, 1 + pi, 0.4};
  const std::string ward = "ward_anisotropic:m_x=0.3,m_y=0.6,rotation=0.5";
  EXPECT_NEAR(composed("mirror:rho=0.3", ward, pair).value, 0.3 * value_at(ward, light_turned), 1e-14);
  EXPECT_NEAR(composed(ward, "mirror:rho=0.3", pair).value, 0.3 * value_at(ward, view_turned), 1e-14);
  EXPECT_NEAR(composed("rrim:rho=0.3", ward, pair).value, 0.3 * value_at(ward, pair), 1e-14);
  EXPECT_EQ(composed("mirror:rho=0.3", "rrim:rho=0.4", pair).value, 0);
}

TEST(CompositionWithDeltaParts, StatesTheRoundingOfTurnedDirections) {
  double share = 0;
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    for (const double m : {0.5, 0.1, 0.01, 0.001}) {
      for (const double theta : {0.2, 0.9, 1.4}) {
        for (const double widths : {0.0, 0.5, 1.0, 2.0, 4.0}) {
          const double delta_phi = widths * m / std::sin(theta);
          if (delta_phi > pi) continue;
          const Directions pair{theta, std::max(0.0, theta - 0.3 * widths * m), delta_phi};
          const std::string ward = "ward:m=" + std::to_string(m);
          SCOPED_TRACE(ward + " at " + std::to_string(widths) + " widths");
          const Vector light = reference::light_of(pair);
          const double expected = static_cast<double>(
              0.9L * reference::ward({-light.x, -light.y, light.z}, reference::view_of(pair), static_cast<Real>(m)));
          if (expected < 1e-12) continue;
          for (const auto& found : {composed("mirror:rho=0.9", ward, pair, {.precision = precision}),
                                    composed(ward, "mirror:rho=0.9", pair, {.precision = precision})}) {
            EXPECT_LE(std::abs(found.value - expected), found.error);
            EXPECT_LE(found.error, (precision == Precision::double_precision ? 1e-10 : 1e-4) * expected);
            share = std::max(share, std::abs(found.value - expected) / found.error);
          }
        }
      }
    }
  }
  EXPECT_GT(share, 0.5);  // half the error would be too small
}

TEST(CompositionWithDeltaParts, AddsThemToTheSmoothParts) {
  const Directions pair{0.5, 0.9, 1};
  const std::string fresnel = "mirror*fresnel:ior=1.5,k=0";
  const auto smooth = composed("lambert:scale=0.3", "phong:n=20", pair);
  const auto whole = composed("lambert:scale=0.3+" + fresnel, "phong:n=20", pair);
  // The albedo of a mirror is what it reflects at the angle.
  const std::vector<double> theta{pair.theta_in};
  const double share = albedo(device(), parse_material(fresnel), theta).at(0).at(0).value;
  EXPECT_NEAR(whole.value, smooth.value + share * value_at("phong:n=20", {0.5, 0.9, 1 - pi}), whole.error + 1e-12);
  EXPECT_GT(share, 0.04);
}

INSTANTIATE_TEST_SUITE_P(
    property, CompositionOf,
    ::testing::Values(
        Composed{
            "phong_cook_torrance", "phong:n=20", "cook_torrance:m=0.3", phong(20), cook_torrance(0.3L), {0.5, 0.9, 1}},
        Composed{"oren_nayar_metal_phong",
                 "oren_nayar:sigma=0.5",
                 "metal_phong:n=20",
                 oren_nayar(0.5L),
                 lobe_of(reference::metal_phong, 20, 0.2),
                 {1.2, 0.4, 2.5}},
        Composed{"grazing_ward_phong", "ward:m=0.1", "phong:n=500", ward(0.1L), phong(500), {1.5, 1.45, 0.1}},
        Composed{"sharp_phong_ward", "phong:n=100000", "ward:m=0.005", phong(100000), ward(0.005L), {1, 1.004, 0.01}},
        Composed{"sharp_lobes_apart", "phong:n=10000", "ward:m=0.02", phong(10000), ward(0.02L), {0.6, 0.7, 0.3}},
        Composed{"sharp_phong_lambert",
                 "phong:n=100000",
                 "lambert",
                 phong(100000),
                 Lobe{reference::lambert, 1},
                 {1, 0.3, 2}},
        Composed{"exponential_patches",
                 "exponential_patch:s=8",
                 "exponential_patch:s=50",
                 lobe_of(reference::exponential_patch, 8, 0.1),
                 lobe_of(reference::exponential_patch, 50, 0.02),
                 {0.3, 0.8, 0.7}}),
    ByName{});

TEST(Composition, OfSharpLobesFarApartIsZeroWithinTheSmallestNumbers) {
  const auto value = composed("phong:n=100000", "ward:m=0.005", {0.5, 0.5, pi});

  EXPECT_EQ(value.value, 0);
  EXPECT_LT(value.error, 1e-300);
}

TEST(Composition, OfForwardLobesPeaksOnTheRetroSide) {
  EXPECT_GT(composed("phong:n=100", "phong:n=100", {0.8, 0.8, 0}).value, 1);
  EXPECT_LT(composed("phong:n=100", "phong:n=100", {0.8, 0.8, pi}).value, 1e-9);
}

TEST(Composition, KeepsItsKinksWhereThoseOfBothCross) {
  // Exponents below 1: (R.X)^n begins like a root on two great circles, which cross.
  const Directions pair{1.3, 1.2, 2};

  const auto coarse = composed("phong:n=0.5", "phong:n=0.7", pair, {.tolerance = 1e-5});
  const auto fine = composed("phong:n=0.5", "phong:n=0.7", pair, {.tolerance = 1e-9});

  EXPECT_LE(std::abs(coarse.value - fine.value), coarse.error + fine.error);
}

// --- Options and mistakes.

TEST(Composition, InSinglePrecisionKeepsItsEstimate) {
  const Directions pair{0.6, 0.65, 0.1};

  const auto fine = composed("phong:n=500", "ward:m=0.1", pair);
  const auto single = composed("phong:n=500", "ward:m=0.1", pair, {.precision = Precision::single_precision});

  EXPECT_LE(std::abs(single.value - fine.value), single.error + fine.error);
  EXPECT_LE(single.error, 1e-4 * single.value);
}

TEST(Composition, StopsAtAnAbsoluteError) {
  const Directions tail{1.4, 1.4, pi};

  const auto value = composed("phong:n=20", "phong:n=20", tail, {.tolerance = 1e-8, .absolute = 1e-6});

  EXPECT_LE(value.error, 1e-6);
}

TEST(Composition, OfOneChannelServesAllChannelsOfTheOther) {
  Material tinted = parse_material("phong:n=20");
  tinted.terms[0].weight = {1, 0.5, 0.25};
  const std::vector<Directions> pairs{{0.5, 0.6, 0.2}, {1, 1.1, 2}};

  const auto values = composition_at(device(), parse_material("ward:m=0.2"), tinted, pairs);

  ASSERT_EQ(values.size(), 3U);
  ASSERT_EQ(values[0].size(), 2U);
  EXPECT_NEAR(values[2][1].value, 0.25 * values[0][1].value, values[2][1].error + values[0][1].error);
}

TEST(Composition, OfNoPairsIsEmpty) {
  EXPECT_TRUE(composition_at(device(), parse_material("lambert"), parse_material("lambert"), {}).at(0).empty());
}

TEST(Composition, SaysWhichDirectionsAreOutOfRange) {
  try {
    (void)composed("lambert", "lambert", {0.5, pi / 2, 0});
    FAIL() << "expected ArgumentError";
  } catch (const ArgumentError& error) {
    EXPECT_NE(std::string(error.what()).find("expected theta_in and theta_out in [0, 90)"), std::string::npos);
  }
}

TEST(Composition, ThatCancelsBelowItsRoundingIsToldWithItsError) {
  // a_f(N) = 1 - 1.
  const Material f = parse_material("phong:n=20+lambert:scale=-1");
  const Material g = parse_material("lambert");
  const std::array directions{Directions{1, 0, 0}, Directions{0, 0, 0}};
  std::vector<MissedTolerance> missed;
  const auto values =
      composition_at(device(), f, g, directions, {.missed = [&](const auto& one) { missed.push_back(one); }}).front();
  ASSERT_EQ(missed.size(), 1U);
  EXPECT_EQ(missed.front().index, 1U);
  EXPECT_GT(missed.front().relative_error, missed.front().tolerance);
  EXPECT_NEAR(values[1].value, 0, values[1].error);
  EXPECT_LT(values[1].error, 1e-11);  // of terms of 1/pi, the last attempt at 1e-10
  EXPECT_THROW((void)composition_at(device(), f, g, directions, {.missed = refuse_missed_tolerance}), NumericError);
}

// Where of some thousand values of random pairs of models most of the stated error is needed: a tenth of it, here of
// two models that are far from smooth in opposite corners of the hemisphere. A factor of two in what is stated shows.
TEST(Composition, StatesErrorsThatAreAsLargeAsTheyWereChosen) {
  const Material f = parse_material(
      "he_torrance:sigma=0.0031597524353788515,tau=44.769462344431616,ior=14.141799763615508,k=0.0049674606935902945");
  const Material g = parse_material("hapke_isotropic:g=4.137114146092937");
  const Directions pair{1.402770619390578, 0.41119610017734481, 0.091672711707501339};
  const auto at = [&](double tolerance) {
    return composition_at(device(), f, g, {&pair, 1}, {.tolerance = tolerance}).front().front();
  };
  const Estimate found = at(1e-3);
  const Estimate finer = at(1e-10);
  const double off = std::abs(found.value - finer.value);
  ASSERT_LT(finer.error, 0.1 * off);
  EXPECT_GT(off / found.error, 0.07);
  EXPECT_LT(off / found.error, 0.15);
}

}  // namespace
}  // namespace lobe::test
