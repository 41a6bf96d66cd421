// Materials as expressions: factors, formulas and adjustments against models of the catalogue that are the same
// function.
#include "energy/prepare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/options.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

Material written_out(const std::string& text, bool reciprocal = true) {
  Formula formula{.text = text, .width = 0.3, .reciprocal = reciprocal};
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
  term.formula = formula;
  return {text, "custom", {term}};
}

TEST(Albedo, ThatCancelsBelowItsRoundingIsToldWithItsError) {
  const Material f = parse_material("phong:n=20+lambert:scale=-1");  // 1 - 1 along the normal
  const std::array angles{1.0, 0.0};
  std::vector<MissedTolerance> missed;
  const auto note = [&](const MissedTolerance& one) { missed.push_back(one); };
  const Estimate normal = albedo(device(), f, angles, {.missed = note}).front()[1];
  EXPECT_NEAR(normal.value, 0, normal.error);
  ASSERT_EQ(missed.size(), 1U);
  EXPECT_EQ(missed[0].index, 1U);
  EXPECT_DOUBLE_EQ(missed[0].relative_error, normal.error / std::abs(normal.value));
  EXPECT_DOUBLE_EQ(missed[0].tolerance, 1e-6);
  EXPECT_NO_THROW((void)albedo(device(), f, angles));
  EXPECT_THROW((void)albedo(device(), f, angles, {.missed = refuse_missed_tolerance}), NumericError);
}

// Levels of quadrature had missed the tolerance of 1e-6 by far; the panels end at the edge now.
TEST(Albedo, HasTheErrorOfAnEdgeOfAFormula) {
  const Material edged = written_out("where(cos_lv > 0.7, 1.0, 0.5) / pi");
  const Estimate normal = albedo(device(), edged, std::array{0.0}).front().front();
  EXPECT_NEAR(normal.value, 0.51 + 0.49 / 2, normal.error);
  EXPECT_LE(normal.error, 1e-6);
}

TEST(Albedo, ThatIsInfiniteIsRefusedWhateverTheTolerance) {
  for (const char* text : {"1 / (cos_i * cos_i * cos_o * cos_o)", "0.1 / pow(cos_i * cos_o, 2.5)"}) {
    for (const double tolerance : {1e-6, 1e-3}) {
      EXPECT_THROW((void)albedo(device(), written_out(text), std::array{0.5}, {.tolerance = tolerance}), NumericError)
          << text;
    }
  }
}

TEST(Expression, HasTheProductsOfTheSameModel) {
  const std::vector<Material> materials{parse_material("phong:n=20*cos_max"), parse_material("metal_phong:n=20"),
                                        parse_material("lambert*lacquer:s=0.2"), parse_material("lacquer:s=0.2"),
                                        written_out("22 / (2 * pi) * exp(20 * log_rv) / fmax(cos_i, cos_o)")};
  for (const auto& lighting : {Lighting::point(), Lighting::daylight(), Lighting::patch(0.5)}) {
    const auto result = measure(device(), materials, lighting, with_tolerance(1e-6));
    const auto& channel = result.combined;
    const auto expect_equal = [&](Eigen::Index i, Eigen::Index j) {
      for (Eigen::Index k = 0; k < 5; ++k) {
        // The same lobes at the same nodes: what differs is rounding. Elsewhere the forms have rules of their own.
        const bool has_same_nodes = lighting.kind() == Lighting::Kind::point;
        const double known =
            has_same_nodes ? 1e-12 * std::abs(channel.gram(i, k)) : channel.gram_error(i, k) + channel.gram_error(j, k);
        EXPECT_NEAR(channel.gram(i, k), channel.gram(j, k), known) << lighting.name();
      }
      EXPECT_LE(channel.distance(i, j), channel.distance_error(i, j)) << lighting.name();
    };
    expect_equal(0, 1);
    expect_equal(0, 4);
    expect_equal(2, 3);
  }
}

TEST(Expression, ThatLacquerMakesFiniteHasANorm) {
  const Material covered = parse_material("ward_duer:m=0.2*lacquer:s=0.1");
  EXPECT_THROW((void)measure(device(), {{parse_material("ward_duer:m=0.2")}}, Lighting::point()), NumericError);
  EXPECT_GT(measure(device(), {{covered}}, Lighting::point(), with_tolerance(1e-4)).combined.gram(0, 0), 0);
}

TEST(Prepare, NormalisesToALargestAlbedoOfOne) {
  const Material prepared = prepare(device(), parse_material("blinn:n=3,scale=0.3/0.6*cos_max@normalise"));

  EXPECT_TRUE(prepared.adjustments.empty());
  const auto peaks = largest_albedo(device(), prepared, 89.9999 * pi / 180);
  EXPECT_NEAR(peaks.at(0).albedo.value, 0.5, 1e-6);
  EXPECT_NEAR(peaks.at(1).albedo.value, 1, 1e-6);
}

TEST(Prepare, LeavesAMaterialWithoutAdjustmentsAlone) {
  const Material material = parse_material("lambert:scale=0.3+phong:n=5*cos_max");

  EXPECT_FALSE(needs_preparation(material));
  EXPECT_EQ(to_json(prepare(device(), material)), to_json(material));
}

TEST(Prepare, IsDoneByVerbsThemselves) {
  const auto found = mean_albedo(device(), parse_material("lambert:scale=0.3@normalise")).front();
  EXPECT_NEAR(found.value, 1, found.error + kAdjustmentError);
}

TEST(Prepare, CannotNormaliseNothing) {
  EXPECT_THROW((void)prepare(device(), parse_material("lambert:scale=0@normalise")), NumericError);
}

std::string complaint(const Material& material) {
  try {
    (void)prepare(device(), material);
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "none";
}

TEST(Prepare, RefusesAFormulaThatIsNotWhatItClaims) {
  EXPECT_THAT(complaint(written_out("cos_i")), ::testing::HasSubstr("expected the same, or 'reciprocal = false'"));
  EXPECT_EQ(complaint(written_out("cos_i", false)), "none");
  EXPECT_EQ(complaint(written_out("cos_i * cos_o")), "none");
}

TEST(Prepare, RefusesAFormulaWithoutFiniteValues) {
  EXPECT_THAT(complaint(written_out("log(cos_lv)")), ::testing::HasSubstr("is no finite number at theta_in"));
}

TEST(Expression, MadeByHandIsRefusedWhereItDoesNotFit) {
  Material material = written_out("cos_i * cos_o");
  material.terms[0].values.assign(40, 1.0);
  EXPECT_THROW((void)mean_albedo(device(), material), ArgumentError);
  Material curved = parse_material("lambert");
  curved.terms[0].pumping = Pumping{Correction::g1, {{1, 2, 3}}};
  EXPECT_THROW((void)mean_albedo(device(), curved), ArgumentError);
}

TEST(KullaConty, MakesFacetsWhite) {
  const std::vector<double> angles{0, 0.3, 0.8, 1.3, 1.5, 1.57};
  for (const char* text : {"ggx:alpha=0.5", "ggx_separable:alpha=0.9", "cook_torrance:m=0.6", "ggx:alpha=0.02",
                           "beckmann:m=0.5", "beckmann_separable:m=0.8"}) {
    const Material white = prepare(device(), parse_material(std::string(text) + "@kulla_conty"));
    const auto before = albedo(device(), parse_material(text), angles).at(0);

    const auto found = albedo(device(), white, angles).at(0);

    for (std::size_t k = 0; k < angles.size(); ++k) {
      EXPECT_NEAR(found[k].value, 1, found[k].error + 2 * kAdjustmentError) << text << " " << k;
    }
    EXPECT_GT(1 - before.back().value, 10 * kAdjustmentError) << text;
    const std::array<double, 2> horizon{pi / 2 - 1e-6, pi / 2 - 1e-7};
    const auto last_ones = albedo(device(), white, horizon).at(0);
    for (const Estimate& last : last_ones) {
      EXPECT_LE(last.value, 1 + last.error + kAdjustmentError) << text;
    }
  }
}

TEST(KullaConty, ColoursWhatIsScatteredMoreThanOnce) {
  const std::vector<double> f0{0.04, 0.3, 0.9};
  const Material found = prepare(device(), parse_material("ggx:alpha=0.6,f0=0.04/0.3/0.9,scale=0.5@kulla_conty"));
  const Material white = parse_material("ggx:alpha=0.6");
  const std::vector<Directions> pairs{{0.2, 0.9, 1}, {1.2, 0.1, 2}, {1.4, 1.3, 0.4}};
  const double mean = mean_albedo(device(), white, {.tolerance = 1e-8}).at(0).value;
  const Eigen::MatrixXd values = evaluate(device(), found, pairs);
  for (std::size_t c = 0; c < f0.size(); ++c) {
    const Material once = make_material("ggx", {{"alpha", 0.6}, {"f0", f0[c]}});
    const double fresnel = f0[c] + (1 - f0[c]) / 21;
    const double later = fresnel * fresnel * mean / (1 - fresnel * (1 - mean));
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const std::array<double, 2> angles{pairs[k].theta_in, pairs[k].theta_out};
      const auto albedos = albedo(device(), white, angles, {.tolerance = 1e-8}).at(0);
      const double rest = (1 - albedos[0].value) * (1 - albedos[1].value) / (pi * (1 - mean));
      const double expected = 0.5 * (evaluate(device(), once, {&pairs[k], 1})(0, 0) + later * rest);
      EXPECT_NEAR(values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)), expected, 4e-6 * expected)
          << c << " " << k;
    }
  }
}

/// Twice the integral of a Fresnel term with the cosine, by the midpoint rule.
double mean_of(const std::function<double(double)>& fresnel) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    sum += 2 * cosine * fresnel(cosine) / kSteps;
  }
  return sum;
}

TEST(KullaConty, ColoursByFresnelFactors) {
  const auto edge = [](double f0, double tint) {
    return [=](double x) {
      const double at_edge = f0 + (1 - f0) * std::pow(6.0 / 7, 5);
      const double value = f0 + (1 - f0) * std::pow(1 - x, 5) -
                           (1 - tint) * at_edge * x * std::pow(1 - x, 6) * std::pow(7, 7) / std::pow(6, 6);
      return std::max(0.0, value);
    };
  };
  const auto dielectric = [](double x) {  // ior = 1.5
    const double inside = std::sqrt(1 - (1 - x * x) / 2.25);
    const double across = std::pow((x - 1.5 * inside) / (x + 1.5 * inside), 2);
    const double along = std::pow((1.5 * x - inside) / (1.5 * x + inside), 2);
    return (across + along) / 2;
  };
  const Material white = parse_material("ggx:alpha=0.6");
  const double mean = mean_albedo(device(), white, {.tolerance = 1e-8}).at(0).value;
  const std::vector<Directions> pairs{{0.2, 0.9, 1}, {1.2, 0.1, 2}, {1.4, 1.3, 0.4}};
  for (const auto& [factor, f] :
       std::vector<std::pair<std::string, std::function<double(double)>>>{{"f82:f0=0.9,tint=0.4", edge(0.9, 0.4)},
                                                                          {"f82:f0=0.05,tint=0", edge(0.05, 0)},
                                                                          {"fresnel:ior=1.5", dielectric}}) {
    const Material once = parse_material("ggx:alpha=0.6*" + factor);
    const Material found = prepare(device(), parse_material("ggx:alpha=0.6*" + factor + "@kulla_conty"));
    const Eigen::MatrixXd values = evaluate(device(), found, pairs);
    const double fresnel = mean_of(f);
    const double later = fresnel * fresnel * mean / (1 - fresnel * (1 - mean));
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const std::array<double, 2> angles{pairs[k].theta_in, pairs[k].theta_out};
      const auto albedos = albedo(device(), white, angles, {.tolerance = 1e-8}).at(0);
      const double rest = (1 - albedos[0].value) * (1 - albedos[1].value) / (pi * (1 - mean));
      const double expected = evaluate(device(), once, {&pairs[k], 1})(0, 0) + later * rest;
      EXPECT_NEAR(values(static_cast<Eigen::Index>(k), 0), expected, 4e-6 * expected) << factor << " " << k;
    }
  }
}

TEST(KullaConty, RefusesWhatHasNoFacetsToScatterTwice) {
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"lambert:scale=0.3+ggx:alpha=0.3@kulla_conty", "it is a sum"},
           {"ggx:alpha=0.3*cos_max:p=0.5@kulla_conty", "it has factors"},
           {"ggx:alpha=0.3*f82:f0=0.5*lacquer:s=0.1@kulla_conty", "it has factors"},
           {"ggx:alpha=0.3,f0=0.5*f82:f0=0.5@kulla_conty", "it has two Fresnel terms"},
           {"ggx:alpha=0.3,f0=0.5@pump@kulla_conty", "it is pumped up"},
           {"ggx_fresnel:alpha=0.3,ior=1.5,k=0@kulla_conty", "is not Schlick's"},
           {"disney_diffuse:rough=1@kulla_conty", "its albedo is 1."}}) {
    try {
      (void)prepare(device(), parse_material(text));
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << text << ": " << error.what();
    }
  }
  // What loses no light stays as it is.
  EXPECT_EQ(prepare(device(), parse_material("lambert@kulla_conty")).terms.size(), 1U);
}

// f (1 + F (1 - a(V)) / a(V)), which a viewer of a uniform sky sees as 1 where F is: so the mean albedo is 1, too.
TEST(Turquin, ScalesTowardsTheViewer) {
  const Material white = parse_material("ggx:alpha=0.6");
  const std::vector<Directions> pairs{{0.2, 0.9, 1}, {1.2, 0.1, 2}, {1.4, 1.3, 0.4}};
  for (const auto& [text, once, fresnel] : std::vector<std::tuple<std::string, std::string, double>>{
           {"ggx:alpha=0.6@turquin", "ggx:alpha=0.6", 1},
           {"ggx:alpha=0.6,f0=0.3,scale=0.5@turquin", "ggx:alpha=0.6,f0=0.3,scale=0.5", 0.3},
           {"ggx:alpha=0.6*f82:f0=0.9,tint=0.4@turquin", "ggx:alpha=0.6*f82:f0=0.9,tint=0.4", 0.9},
           {"ggx:alpha=0.6*fresnel:ior=1.5@turquin", "ggx:alpha=0.6*fresnel:ior=1.5", 0.04}}) {
    const Material found = prepare(device(), parse_material(text));
    const Eigen::MatrixXd values = evaluate(device(), found, pairs);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const double a = albedo(device(), white, {&pairs[k].theta_out, 1}, {.tolerance = 1e-8}).at(0).at(0).value;
      const double expected =
          evaluate(device(), parse_material(once), {&pairs[k], 1})(0, 0) * (1 + fresnel * (1 - a) / a);
      EXPECT_NEAR(values(static_cast<Eigen::Index>(k), 0), expected, kAdjustmentError * expected) << text << " " << k;
    }
  }
  const Estimate mean = mean_albedo(device(), prepare(device(), parse_material("ggx:alpha=0.6@turquin"))).at(0);
  EXPECT_NEAR(mean.value, 1, mean.error + kAdjustmentError);
}

TEST(Turquin, ScalesChannelsByTheirOwn) {
  const Material found = prepare(device(), parse_material("ggx:alpha=0.6,f0=0.04/0.9@turquin"));
  const Directions pair{1.2, 0.1, 2};
  const Eigen::MatrixXd values = evaluate(device(), found, {&pair, 1});
  ASSERT_EQ(values.cols(), 2);
  for (Eigen::Index c = 0; c < 2; ++c) {
    const std::string one = std::string("ggx:alpha=0.6,f0=") + (c == 0 ? "0.04" : "0.9") + "@turquin";
    const double expected = evaluate(device(), prepare(device(), parse_material(one)), {&pair, 1})(0, 0);
    EXPECT_NEAR(values(0, c), expected, 1e-12 * expected) << c;
  }
}

TEST(Turquin, IsNotReciprocal) {
  const Material found = prepare(device(), parse_material("ggx:alpha=0.8@turquin"));
  EXPECT_FALSE(traits_of(found.terms.at(0)).reciprocal);
  const std::vector<double> angles{0, 1.4};
  const auto albedos = albedo(device(), found, angles).at(0);
  EXPECT_LT(albedos[0].value, 0.999);
  EXPECT_GT(albedos[1].value, 1.001);
}

TEST(Turquin, RefusesWhatHasNoFacetsToScatterTwice) {
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"lambert:scale=0.3+ggx:alpha=0.3@turquin", "after Turquin: it is a sum"},
           {"ggx:alpha=0.3*cos_max:p=0.5@turquin", "it has factors"},
           {"ggx:alpha=0.3@turquin@turquin", "not reciprocal"},
           {"zeltner_sheen:alpha=0.5@turquin", "not reciprocal"},
           {"ggx_anisotropic:alpha_x=0.2,alpha_y=0.5@turquin", "anisotropic"},
           {"disney_diffuse:rough=1@turquin", "its albedo is 1."}}) {
    try {
      (void)prepare(device(), parse_material(text));
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << text << ": " << error.what();
    }
  }
}

TEST(IrreciprocalFormula, HasAlbedosOfLight) {
  // Reflects into the elevation of light as cos_i: a(L) = pi cos_i, where its transpose has 2 pi / 3 for all L.
  const Material material = written_out("cos_i", false);
  const std::vector<double> angles{0.0, 1.0};
  const auto albedos = albedo(device(), material, angles).at(0);
  EXPECT_NEAR(albedos[0].value, pi, albedos[0].error + 1e-9);
  EXPECT_NEAR(albedos[1].value, pi * std::cos(1.0), albedos[1].error + 1e-9);
}

}  // namespace
}  // namespace lobe::test
