// Lookup tables of albedos against plain integrals, and their errors against plain interpolation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "formats/npy.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/lut.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

LutRequest request(const std::string& material, const std::vector<std::string>& axes,
                   LutQuantity quantity = LutQuantity::albedo, const std::string& split = {}) {
  LutRequest request{.reflectance = parse_material(material)};
  for (const auto& axis : axes) request.axes.push_back(parse_lut_axis(axis, request.reflectance));
  request.quantity = quantity;
  request.split = split;
  return request;
}

/// E at normal incidence, where the azimuth drops out: a single integral, in panels that shrink towards the peak.
double ggx_at_normal(double alpha, double f0) {
  const auto ring = [&](double theta) {
    const reference::Vector view{std::sin(theta), 0, std::cos(theta)};
    return 2 * std::numbers::pi * static_cast<double>(reference::ggx({0, 0, 1}, view, alpha, f0)) * std::cos(theta) *
           std::sin(theta);
  };
  double sum = 0;
  double high = std::numbers::pi / 2;
  for (; high > 1e-3 * alpha; high /= 2) sum += reference::integrate(ring, high / 2, high, 1e-13);
  return sum + reference::integrate(ring, 0, high, 1e-13);
}

TEST(LookupTable, HasTheLossAtNormalIncidenceOfTwentyRoughnesses) {
  const Lut lut = make_lut(
      device(),
      request("ggx:alpha=0.5,f0=1",
              {"alpha:count=20,map=sqrt,from=0.01,to=1,entries=nodes", "theta:count=2,from=0,to=60,entries=nodes"},
              LutQuantity::complement),
      {.tolerance = 1e-10});
  ASSERT_THAT(lut.columns, ElementsAre("complement"));
  for (std::size_t i = 0; i < 20; ++i) {
    const double alpha = lut.request.axes.front().value(lut.request.axes.front().coordinate(i));
    const double difference = std::abs(lut.values[2 * i] - (1 - ggx_at_normal(alpha, 1)));
    EXPECT_LT(difference, 1e-9) << alpha;
    EXPECT_LE(difference, lut.errors[2 * i] + 1e-12) << alpha;
  }
}

// Adobe's openpbr-bsdf has 6.1e-5 there.
TEST(LookupTable, HasTheLossOfOneRoughnessThatAPublishedTableMisses) {
  EXPECT_NEAR(1 - ggx_at_normal(std::pow(6.0 / 31, 2), 1), 1.49e-3, 5e-6);
}

TEST(LookupTable, SplitsTheAlbedoInF0) {
  const Lut lut =
      make_lut(device(), request("ggx:alpha=0.5,f0=1,scale=0.5+lambert:scale=0.1",
                                 {"alpha:count=3,from=0.1", "cos_theta:count=4"}, LutQuantity::albedo, "f0"));
  ASSERT_THAT(lut.columns, ElementsAre("scale", "bias"));
  const auto& axes = lut.request.axes;
  for (std::size_t i = 0; i < 12; ++i) {
    const double alpha = axes[0].value(axes[0].coordinate(i / 4));
    const double theta = std::acos(axes[1].value(axes[1].coordinate(i % 4)));
    const Material glossy = make_material("ggx", {{"alpha", alpha}, {"f0", 0.04}});
    const Estimate exact = albedo(device(), glossy, std::vector{theta})[0][0];
    const double sum = lut.values[2 * i + 1] + 0.04 * lut.values[2 * i];
    EXPECT_NEAR(sum, 0.5 * exact.value + 0.1, exact.error + lut.errors[2 * i] + lut.errors[2 * i + 1]) << i;
  }
}

TEST(LookupTable, SplitsTheAlbedoOfAdjustedFormulasAndOfChannels) {
  const std::vector<std::string> axes{"cos_theta:count=2"};
  const Lut adjusted = make_lut(device(), request("ggx:alpha=0.3,f0=1*cos_max:p=0", axes, LutQuantity::albedo, "f0"));
  const Lut plain = make_lut(device(), request("ggx:alpha=0.3,f0=1", axes, LutQuantity::albedo, "f0"));
  const Lut channels = make_lut(device(), request("ggx:alpha=0.3,f0=1,scale=1/0.5", axes, LutQuantity::albedo, "f0"));
  ASSERT_THAT(channels.columns, ElementsAre("scale", "bias", "scale_2", "bias_2"));
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t c = 0; c < 2; ++c) {
      const double value = plain.values[2 * i + c];
      const double error = 4 * plain.errors[2 * i + c];
      EXPECT_NEAR(adjusted.values[2 * i + c], value, error) << i;
      EXPECT_NEAR(channels.values[4 * i + c], value, error) << i;
      EXPECT_NEAR(channels.values[4 * i + c + 2], value / 2, error) << i;
    }
  }
}

TEST(LookupTable, SplitsF82IntoThreeTerms) {
  const std::vector<std::string> axes{"alpha:count=2,from=0.2", "theta:count=3,from=0,to=80,entries=nodes"};
  const Lut lut = make_lut(device(), request("ggx:alpha=1,f0=1", axes, LutQuantity::albedo, "f82"));
  EXPECT_EQ(lut.columns, (std::vector<std::string>{"scale", "bias", "edge"}));
  const Lut both = make_lut(device(), request("ggx:alpha=1,f0=1", axes, LutQuantity::albedo, "f0"));
  for (const auto& [f0, tint] : {std::pair{0.9, 0.3}, {0.5, 0.2}, {0.3, 1.0}}) {
    for (std::size_t i = 0; i < 6; ++i) {
      const double* terms = &lut.values[3 * i];
      const double found = terms[1] + f0 * terms[0] - (1 - tint) * (f0 + (1 - f0) * std::pow(6.0 / 7, 5)) * terms[2];
      const double alpha = i < 3 ? 0.4 : 0.8;
      const std::vector theta{static_cast<double>(i % 3) * 40 * kDegree};
      const Material metal = parse_material("ggx:alpha=" + std::to_string(alpha) + "*f82:f0=" + std::to_string(f0) +
                                            ",tint=" + std::to_string(tint));
      const Estimate exact = albedo(device(), metal, theta, {.tolerance = 1e-8})[0][0];
      const double error = lut.errors[3 * i] + lut.errors[3 * i + 1] + lut.errors[3 * i + 2] + exact.error;
      EXPECT_NEAR(found, exact.value, error) << f0 << " " << tint << " " << i;
      EXPECT_NEAR(terms[0], both.values[2 * i], lut.errors[3 * i] + both.errors[2 * i]) << i;
    }
  }
}

TEST(LookupTable, RefusesTheTermsOfF82WhereTheyAreNot) {
  for (const auto& [material, axis, reason] : std::vector<std::array<std::string, 3>>{
           {"lambert", "cos_theta:count=2", "has no parameter 'f0'"},
           {"ggx:alpha=0.5@kulla_conty", "cos_theta:count=2", "without adjustments"},
           {"ggx:alpha=0.5*f82:f0=0.5", "cos_theta:count=2", "several parts"}}) {
    try {
      (void)make_lut(device(), request(material, {axis}, LutQuantity::albedo, "f82"));
      FAIL() << material;
    } catch (const ArgumentError& error) {
      EXPECT_THAT(error.what(), HasSubstr(reason)) << material;
    }
  }
  try {
    (void)make_lut(device(), request("ggx:alpha=0.5", {"cos_theta:count=2", "f0:count=2"}, LutQuantity::albedo, "f82"));
    FAIL() << "it did not throw";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is an axis and the parameter of the split"));
  }
}

TEST(LookupTable, RefusesASplitInWhatTheAlbedoIsNotLinearIn) {
  try {
    (void)make_lut(device(), request("ggx:alpha=0.5,f0=1", {"cos_theta:count=2"}, LutQuantity::albedo, "alpha"));
    FAIL() << "it did not throw";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is not linear in alpha, which cannot be 0 or 1"));
  }
  try {
    (void)make_lut(device(), request("oren_nayar:sigma=0.5", {"cos_theta:count=2"}, LutQuantity::albedo, "sigma"));
    FAIL() << "it did not throw";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is not linear in sigma"));
  }
}

/// A formula whose albedo is p + bend * p * (1 - p).
LutRequest bent(double bend) {
  Material material;
  material.name = "bent";
  material.terms = {Term{.model = std::string(kCustomModel),
                         .values = {0.5, bend},
                         .weight = {1},
                         .formula = Formula{.text = "(p + bend * p * (1 - p)) / pi", .parameters = {"p", "bend"}}}};
  LutRequest request{.reflectance = material, .split = "p"};
  request.axes.push_back(parse_lut_axis("cos_theta:count=2", request.reflectance));
  return request;
}

// Only errors of albedos are no curve.
TEST(LookupTable, RefusesASplitOfAnAlbedoThatIsHardlyBent) {
  EXPECT_NO_THROW((void)make_lut(device(), bent(0), {.tolerance = 1e-9}));
  EXPECT_THROW((void)make_lut(device(), bent(1e-6), {.tolerance = 1e-9}), ArgumentError);
  EXPECT_THROW((void)make_lut(device(), bent(-1e-6), {.tolerance = 1e-9}), ArgumentError);
}

/// Albedo of the plain formula at coordinates of a table over sqrt(alpha) and cos_theta.
double albedo_at(double u, double v) {
  const double root = std::sqrt(0.1) + u * (1 - std::sqrt(0.1));
  const Material material = make_material("ggx", {{"alpha", root * root}, {"f0", 1}});
  return albedo(device(), material, std::vector{std::min(std::acos(v), 89.9999 * kDegree)}, {.tolerance = 1e-8})[0][0]
      .value;
}

TEST(LookupTable, StatesTheLargestErrorOfItsInterpolation) {
  const Lut lut = make_lut(
      device(), request("ggx:alpha=0.5,f0=1", {"alpha:count=3,map=sqrt,from=0.1", "cos_theta:count=4,entries=nodes"}));
  const LutErrors errors = lut_errors(device(), lut, lut, 2);
  // By hand: centres at 1/6, 1/2 and 5/6; nodes at 0, 1/3, 2/3 and 1.
  double between = 0;
  double all = 0;
  double worst_u = 0;
  for (int i = 0; i <= 8; ++i) {
    // 0, 1/12, 1/6, 1/3, 1/2, 2/3, 5/6, 11/12, 1
    const std::vector<double> us{0, 1. / 12, 1. / 6, 1. / 3, 0.5, 2. / 3, 5. / 6, 11. / 12, 1};
    const double u = us[static_cast<std::size_t>(i)];
    const double along = std::clamp(3 * u - 0.5, 0.0, 2.0);
    const auto row = std::min<std::size_t>(static_cast<std::size_t>(along), 1);
    const double t = along - static_cast<double>(row);
    for (int k = 0; k <= 6; ++k) {
      const double v = k / 6.0;
      const auto column = std::min<std::size_t>(static_cast<std::size_t>(3 * v), 2);
      const double s = 3 * v - static_cast<double>(column);
      const auto at = [&](std::size_t r, std::size_t c) { return lut.values[4 * r + c]; };
      const double value = (1 - t) * ((1 - s) * at(row, column) + s * at(row, column + 1)) +
                           t * ((1 - s) * at(row + 1, column) + s * at(row + 1, column + 1));
      const double difference = std::abs(value - albedo_at(u, v));
      if (difference > all) worst_u = u;
      all = std::max(all, difference);
      if (i >= 2 && i <= 6) between = std::max(between, difference);
    }
  }
  EXPECT_EQ(errors.points, 63U);
  EXPECT_NEAR(errors.all.largest, all, 0.1 * all);
  EXPECT_GE(errors.all.largest, all);
  EXPECT_GE(errors.between.largest, between);
  EXPECT_NEAR(errors.between.largest, between, 0.1 * between);
  EXPECT_LE(errors.entries.largest, 2e-6);
  const double root = std::sqrt(0.1) + worst_u * (1 - std::sqrt(0.1));
  EXPECT_NEAR(errors.all.at[0], root * root, 1e-12);
}

// Midpoints see at least two thirds of what a grid of sixteen steps finds.
TEST(LookupTable, FindsMostOfItsErrorAtTheMidpoints) {
  for (const char* material : {"ggx:alpha=0.5,f0=1", "cook_torrance:m=0.3,f0=0.04", "oren_nayar:sigma=0.5"}) {
    const Lut lut = make_lut(device(), request(material, {"cos_theta:count=12"}));
    const double half = lut_errors(device(), lut, lut, 2).between.largest;
    const double fine = lut_errors(device(), lut, lut, 16).between.largest;
    EXPECT_GE(half, fine / 1.5) << material;
    EXPECT_LE(half, fine * 1.1) << material;
  }
}

/// A smooth curve whose finer grid has errors of albedos, but hardly any of interpolation.
LutRequest smooth_curve() {
  return request("ggx:alpha=0.4,f0=1", {"cos_theta:count=16,from=0.6,to=0.7,entries=nodes"});
}

Lut shifted(Lut lut, double shift) {
  for (double& value : lut.values) value += shift;
  return lut;
}

/// How often the albedos of the finer grid are computed.
struct Passes {
  LutErrors errors;
  int count = 0;
};

Passes passes(const Lut& lut, const Lut& exact, double tolerance) {
  Passes result;
  const auto count = [&](std::string_view stage, double done) {
    result.count += stage == "error" && done == 1 ? 1 : 0;
    return true;
  };
  result.errors = lut_errors(device(), lut, exact, 2, {.tolerance = tolerance, .progress = count});
  return result;
}

// kErrorShare: by shifts from what is seen at once to what asks for more accurate albedos.
TEST(LookupTable, HasErrorsOfAlbedosUpToATenthOfItsOwn) {
  const Lut exact = make_lut(device(), smooth_curve(), {.tolerance = 1e-9});
  int just_enough = 0;
  int just_too_few = 0;
  for (double shift = 1e-7; shift < 1e-2; shift *= 1.25) {
    const Lut table = shifted(exact, shift);
    const Passes rough = passes(table, exact, 1e-4);
    ASSERT_EQ(rough.count, 1) << shift;
    const double share = rough.errors.all.exact.error / rough.errors.all.largest;
    just_enough += share > 0.05 && share <= 0.1 ? 1 : 0;
    just_too_few += share > 0.1 && share <= 0.2 ? 1 : 0;
    const Passes fine = passes(table, exact, 1e-8);
    EXPECT_EQ(fine.count == 1, share <= 0.1) << shift;
    EXPECT_LE(fine.errors.all.exact.error, 0.1 * fine.errors.all.largest) << shift;
  }
  EXPECT_GT(just_enough, 0);
  EXPECT_GT(just_too_few, 0);
}

// kRoughTolerance: where a table is far off, its error is that of albedos at 1e-4, no more and no less.
TEST(LookupTable, IsFirstHeldAgainstRoughAlbedos) {
  const Lut exact = make_lut(device(), smooth_curve(), {.tolerance = 1e-9});
  const LutErrors errors = lut_errors(device(), shifted(exact, 0.25), exact, 2, {.tolerance = 1e-9});
  const double theta = std::acos(errors.all.at[0]);
  const auto error_at = [&](double tolerance) {
    return albedo(device(), smooth_curve().reflectance, std::vector{theta}, {.tolerance = tolerance})[0][0].error;
  };
  EXPECT_EQ(errors.all.exact.error, error_at(1e-4));
  EXPECT_NE(error_at(5e-5), error_at(1e-4));
  EXPECT_NE(error_at(2e-4), error_at(1e-4));
}

TEST(LookupTable, OfAMeanHasNoAngle) {
  const Lut lut = make_lut(
      device(), request("ggx:alpha=0.5,f0=1", {"alpha:count=2,from=0.2,entries=nodes"}, LutQuantity::mean_complement));
  const Estimate mean = mean_albedo(device(), make_material("ggx", {{"alpha", 0.2}, {"f0", 1}}))[0];
  EXPECT_NEAR(lut.values[0], 1 - mean.value, mean.error + lut.errors[0]);
  EXPECT_THROW((void)make_lut(device(), request("ggx:alpha=0.5,f0=1", {"cos_theta"}, LutQuantity::mean_albedo)),
               ArgumentError);
  EXPECT_THROW((void)make_lut(device(), request("ggx:alpha=0.5,f0=1", {"alpha:count=2,from=0.2"})), ArgumentError);
}

TEST(LookupTable, OfATableHasAnglesAlone) {
  const Reflectance grey = tabulate(device(), parse_material("lambert:scale=0.4"), HemisphereGrid::gauss(8, 16));
  LutRequest wanted{.reflectance = grey};
  wanted.axes.push_back(parse_lut_axis("theta:count=4", grey));
  for (const double value : make_lut(device(), wanted).values) EXPECT_NEAR(value, 0.4, 1e-12);
  EXPECT_THROW((void)parse_lut_axis("alpha", grey), ArgumentError);
}

TEST(LookupTableAxis, HasItsMapAndItsEntries) {
  const Reflectance ggx = parse_material("ggx:alpha=0.5,f0=1");
  const LutAxis centres = parse_lut_axis("alpha:count=4,from=0,to=1,map=sqrt", ggx);
  EXPECT_EQ(centres.coordinate(0), 0.125);
  EXPECT_NEAR(centres.value(0.125), 0.125 * 0.125, 1e-15);
  const LutAxis nodes = parse_lut_axis("alpha:count=5,from=0.01,to=1,map=log,entries=nodes", ggx);
  EXPECT_EQ(nodes.coordinate(4), 1);
  EXPECT_NEAR(nodes.value(nodes.coordinate(2)), 0.1, 1e-15);
  const LutAxis square = parse_lut_axis("alpha:count=5,from=0.6,to=1,map=square", ggx);
  EXPECT_NEAR(square.value(0.5), std::sqrt(0.68), 1e-15);
  EXPECT_EQ(parse_lut_axis(to_string(nodes), ggx), nodes);
  EXPECT_EQ(parse_lut_axis("theta", ggx).to, 90);
}

TEST(LookupTableAxis, BeginsAt0WhereTheLeastValueIsTiny) {
  const Reflectance ggx = parse_material("ggx:alpha=0.5,f0=1");
  const LutAxis axis = parse_lut_axis("alpha:count=4,map=sqrt", ggx);
  EXPECT_EQ(axis.from, 0);
  EXPECT_EQ(axis.to, 1);
  for (std::size_t i = 0; i < axis.count; ++i) {
    const double roughness = axis.coordinate(i);
    EXPECT_EQ(axis.value(roughness), roughness * roughness) << i;
  }
  EXPECT_EQ(axis.value(0), 1e-5);  // the least alpha of ggx
  EXPECT_EQ(axis.value(0.001), 1e-5);
  EXPECT_EQ(lut_axis_text(axis), "alpha from 0 to 1, 4 cell centres, at least 1e-05, equally spaced in sqrt(alpha)");
  EXPECT_EQ(parse_lut_axis(to_string(axis), ggx), axis);
  EXPECT_EQ(parse_lut_axis("alpha:from=1,to=0", ggx).value(1), 1e-5);
  EXPECT_EQ(parse_lut_axis("alpha:map=log", ggx).from, 1e-5);
}

TEST(LookupTableAxis, WithItsEndAtTheLeastValueHasATable) {
  const Lut table =
      make_lut(device(), request("ggx:alpha=0.5,f0=1", {"alpha:count=2,entries=nodes", "cos_theta:count=2"}));
  const Lut least = make_lut(device(), request("ggx:alpha=1e-5,f0=1", {"cos_theta:count=2"}));
  // The same integral, by rules that may differ.
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(table.values[i], least.values[i], table.errors[i] + least.errors[i]) << i;
}

TEST(LookupTableAxis, IsRefusedInOneLine) {
  const Reflectance mixed = parse_material("ggx:alpha=0.5,f0=1+phong:n=20");
  const std::vector<std::pair<std::string, std::string>> cases{
      {"alhpa", "did you mean 'alpha'"},
      {"n", "the parameter has no range from 0 to 1; expected from=... and to=..."},
      {"n:from=1,to=x", "'x' is no number; expected one for to of axis n"},
      {"cos_theta:count=1", "count=1; expected a whole number from 2"},
      {"cos_theta:count=2.5", "expected a whole number from 2"},
      {"cos_theta:from=0.5,to=0.5", "its range 0.5 to 0.5 is empty"},
      {"cos_theta:to=2", "expected values from 0 to 1"},
      {"theta:to=91", "expected 0 to 90 degrees"},
      {"alpha:map=cube", "unknown map 'cube'"},
      {"cos_theta:map=log", "expected ends above 0 for map=log"},
      {"cos_theta:step=3", "unknown key of axis cos_theta 'step'"},
      {"cos_theta:count", "'count' has no value"},
      {"alpha\n:count=2", "has control characters"},
      {"cos_theta:entries=edges", "unknown place of entries 'edges'"}};
  for (const auto& [text, complaint] : cases) {
    try {
      (void)parse_lut_axis(text, mixed);
      ADD_FAILURE() << text << " was taken";
    } catch (const ArgumentError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint)) << text;
    }
  }
  const Reflectance twice = parse_material("phong:n=5+blinn:n=20");
  try {
    (void)parse_lut_axis("n:from=1,to=9", twice);
    FAIL() << "it did not throw";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("several parts of 'phong:n=5+blinn:n=20' have a parameter 'n'; expected blinn.n "
                          "or phong.n"));
  }
  EXPECT_EQ(parse_lut_axis("phong.n:from=1,to=9", twice).name, "phong.n");
}

TEST(LookupTable, SaysWhatItHoldsAndWhere) {
  const LutRequest mean =
      request("ggx:alpha=0.5,f0=1", {"alpha:count=2,from=0.2,map=log,entries=nodes"}, LutQuantity::mean_albedo, "f0");
  EXPECT_EQ(lut_quantity_text(mean), "mean albedo of ggx:alpha=0.5,f0=1 = bias + f0 * scale");
  EXPECT_EQ(lut_axis_text(mean.axes[0]), "alpha from 0.2 to 1, 2 nodes, equally spaced in log(alpha)");
  const LutRequest loss = request("lambert", {"theta:count=4"}, LutQuantity::complement);
  EXPECT_EQ(lut_quantity_text(loss), "1 - directional albedo of lambert");
  EXPECT_EQ(lut_axis_text(loss.axes[0]), "theta from 0 to 90 degrees, 4 cell centres");
  const Lut table{.request = loss, .columns = {"red", "green"}, .values = {}, .errors = {}};
  LutDeviation deviation;
  deviation.at = {12.34567};
  deviation.column = 1;
  EXPECT_EQ(lut_place_text(table, deviation), "theta 12.35 degrees (green)");
}

TEST(LookupTable, HasNoSplitByAParameterThatCannotBe0) {
  try {
    (void)make_lut(device(), request("ggx:alpha=0.5,f0=1", {"cos_theta:count=2"}, LutQuantity::albedo, "alpha"));
    FAIL() << "it did not throw";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is not linear in alpha, which cannot be 0 or 1 (its range is [1e-05, 1])"));
  }
}

class LookupTableFile : public ::testing::Test {
 protected:
  [[nodiscard]] static const Lut& lut() {
    static const Lut kLut = make_lut(
        device(),
        request("ggx:alpha=0.5,f0=1", {"alpha:count=3,from=0.1", "cos_theta:count=5"}, LutQuantity::albedo, "f0"));
    return kLut;
  }
  [[nodiscard]] static const Lut& curve() {
    static const Lut kCurve = make_lut(device(), request("ggx:alpha=0.5,f0=1", {"cos_theta:count=5,entries=nodes"}));
    return kCurve;
  }
  /// A table through a file and back.
  [[nodiscard]] Lut again(const Lut& table, const std::string& name, int bits = 0, bool is_float = false) const {
    const LutFileOptions options{.format = lut_format_of(name), .bits = bits, .is_float = is_float, .name = "albedo"};
    const Lut stored = as_stored(table, options);
    write(name, lut_file(stored, std::nullopt, options));
    return read_lut(directory_.path() / name, table.request);
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(directory_.path() / name, std::ios::binary) << content;
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return directory_.path() / name; }

 private:
  TemporaryDirectory directory_;
};

TEST_F(LookupTableFile, HoldsItsNumbersInEveryFormat) {
  for (const char* name : {"a.csv", "a.npy", "a.h5"}) EXPECT_EQ(again(lut(), name).values, lut().values) << name;
  for (const char* name : {"a.h", "a.glsl", "a.png", "a.exr", "a.ktx2"}) {
    const Lut back = again(lut(), name);
    const bool has_levels = std::string(name) == "a.png" || std::string(name) == "a.ktx2";
    const double step = has_levels ? 1.0 / 65535 : 6e-8;
    ASSERT_EQ(back.values.size(), lut().values.size()) << name;
    double largest = 0;
    for (std::size_t i = 0; i < back.values.size(); ++i)
      largest = std::max(largest, std::abs(back.values[i] - lut().values[i]));
    EXPECT_LE(largest, step / 2) << name;
    EXPECT_GT(largest, step / 20) << name;
  }
  EXPECT_EQ(again(curve(), "b.spi1d").values.size(), 5U);
  EXPECT_NEAR(again(curve(), "b.spi1d").values[2], curve().values[2], 3e-8);
  EXPECT_NEAR(again(curve(), "b8.png", 8).values[2], curve().values[2], 0.5 / 255);
  EXPECT_NEAR(again(curve(), "b8.ktx2", 8).values[2], curve().values[2], 0.5 / 255);
  EXPECT_EQ(again(curve(), "b.exr").values.size(), 5U);
}

TEST_F(LookupTableFile, IsReadAsItWasStored) {
  for (const char* name : {"a.csv", "a.npy", "a.h5", "a.h", "a.glsl", "a.png", "a.exr", "a.ktx2"}) {
    const Lut stored = as_stored(lut(), {.format = lut_format_of(name)});
    EXPECT_EQ(again(stored, name).values, stored.values) << name;
  }
}

// Of eleven bits of a fraction from 0.5 to 1 the last one is 2^-11.
TEST_F(LookupTableFile, HasTheErrorsOfHalvesAmongItsOwn) {
  for (const LutFileOptions& options : {LutFileOptions{.format = LutFormat::exr, .bits = 16},
                                        LutFileOptions{.format = LutFormat::ktx2, .is_float = true}}) {
    const Lut stored = as_stored(lut(), options);
    double largest = 0;
    for (std::size_t i = 0; i < stored.values.size(); ++i) {
      largest = std::max(largest, std::abs(stored.values[i] - lut().values[i]));
    }
    EXPECT_LE(largest, std::exp2(-12)) << options.bits;
    EXPECT_GT(largest, std::exp2(-13)) << options.bits;
    const double stated = lut_errors(device(), stored, lut(), 1).entries.largest;
    EXPECT_GE(stated, largest) << options.bits;
    EXPECT_LE(stated, largest + 2e-6) << options.bits;
  }
}

TEST_F(LookupTableFile, KeepsHalvesAndFloatsAsTheyWereStored) {
  for (const int bits : {16, 32}) {
    const Lut image = as_stored(lut(), {.format = LutFormat::exr, .bits = bits});
    EXPECT_EQ(again(image, "a.exr", bits).values, image.values) << bits;
    EXPECT_EQ(again(image, "a.ktx2", bits, true).values, image.values) << bits;
  }
}

TEST_F(LookupTableFile, HasFourColumnsInAnImageByTheirNames) {
  Lut wide = lut();
  wide.request.reflectance = parse_material("ggx:alpha=0.5,f0=1,scale=1/0.5");
  wide.columns = lut_columns(wide.request);
  wide.errors = {};
  wide.values.clear();
  for (int i = 0; i < 60; ++i) wide.values.push_back(i / 64.0);
  EXPECT_EQ(again(wide, "wide.exr").values, wide.values);
  EXPECT_EQ(again(wide, "wide.h5").values, wide.values);
}

TEST_F(LookupTableFile, StatesItsAxesAndItsErrors) {
  for (const char* name : {"a.csv", "a.h", "a.glsl"}) {
    const LutFileOptions options{.format = lut_format_of(name), .name = "dfg", .command_line = "lobe lut\n#define X"};
    const Lut stored = as_stored(lut(), options);
    const LutErrors errors = lut_errors(device(), stored, lut(), 1);
    const std::string content = lut_file(stored, errors, options);
    EXPECT_THAT(content, HasSubstr("directional albedo of ggx:alpha=0.5,f0=1 = bias + f0 * scale")) << name;
    EXPECT_THAT(content, HasSubstr("axis 1: alpha from 0.1 to 1, 3 cell centres, the slowest index")) << name;
    EXPECT_THAT(content, HasSubstr("largest error of linear interpolation between entries: ")) << name;
    EXPECT_THAT(content, Not(HasSubstr("\n#define"))) << name;
  }
}

TEST_F(LookupTableFile, OfSomebodyElseMayHaveOneColumn) {
  write("one.csv", "0.1,0.2,0.3,0.4,0.5\n0.1,0.2,0.3,0.4,0.5\n0.1,0.2,0.3,0.4,0.5\n");
  const Lut one = read_lut(path("one.csv"), lut().request);
  EXPECT_THAT(one.columns, ElementsAre("scale"));
  EXPECT_EQ(one.values[7], 0.3);
  const LutErrors errors = lut_errors(device(), one, lut(), 1);
  EXPECT_GT(errors.entries.largest, 0.1);
  write("c.h",
        "/* = {1} */ const float x[3][5][1] = { // 9\n{.1f, 2e-1, 3.0E-1f, +0.4, 0.5},\n"
        "{.1f, .2f, .3f, .4f, .5f}, {.1f, .2f, .3f, .4f, .5f}}; int y = 7;");
  const Lut floats = read_lut(path("c.h"), lut().request);
  ASSERT_EQ(floats.values.size(), one.values.size());
  bool is_same = true;
  for (std::size_t i = 0; i < 15; ++i)
    is_same = is_same && static_cast<float>(one.values[i]) == static_cast<float>(floats.values[i]);
  EXPECT_TRUE(is_same);
}

TEST_F(LookupTableFile, OfTextHasItsRowsWhereItsAxesSay) {
  const LutFileOptions options{.format = LutFormat::csv};
  const std::string text = lut_file(lut(), std::nullopt, options);
  const std::size_t names = text.find("alpha,cos_theta,");
  ASSERT_NE(names, std::string::npos);
  const std::size_t begin = text.find('\n', names) + 1;
  std::vector<std::string> rows;
  for (std::size_t at = begin; at < text.size(); at = text.find('\n', at) + 1) {
    rows.push_back(text.substr(at, text.find('\n', at) + 1 - at));
  }
  ASSERT_EQ(rows.size(), lut().entries());
  std::string reversed = text.substr(0, begin);
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) reversed += *row;
  write("reversed.csv", reversed);
  EXPECT_EQ(read_lut(path("reversed.csv"), lut().request).values, lut().values);

  const auto complaint = [&](std::string changed) -> std::string {
    write("changed.csv", std::move(changed));
    try {
      (void)read_lut(path("changed.csv"), lut().request);
    } catch (const Error& error) {
      return error.what();
    }
    return "taken";
  };
  const auto renamed = [&](std::string_view from, std::string_view to) {
    std::string changed = text;
    changed.replace(changed.find(from, names), from.size(), to);
    return changed;
  };
  EXPECT_THAT(complaint(renamed("cos_theta", "theta")), HasSubstr("names no axis 'cos_theta'"));
  EXPECT_THAT(complaint(renamed("scale", "red")), HasSubstr("names no column 'scale'"));
  EXPECT_THAT(complaint(renamed("scale_error", "red")), HasSubstr("'red' is no axis or column of the table"));
  std::string doubled = text;
  doubled.replace(begin + rows[0].size(), rows[1].size(), rows[0]);
  EXPECT_THAT(complaint(doubled), HasSubstr("has the values of the axes of an earlier line"));
  EXPECT_THAT(complaint(text.substr(0, text.size() - rows.back().size())), HasSubstr("entries; the axes ask for 15"));
  EXPECT_THAT(complaint(text.substr(0, begin) + "0.5,0.123,1,1,0,0\n"), HasSubstr("where the axis has no entry"));
}

TEST_F(LookupTableFile, OfNumPyHasTheShapeOfItsAxes) {
  write("turned.npy", npy_content(std::vector<std::size_t>{5, 3, 2}, lut().values));
  EXPECT_THROW((void)read_lut(path("turned.npy"), lut().request), IoError);
  write("flat.npy", npy_content(std::vector<std::size_t>{30}, lut().values));
  EXPECT_EQ(read_lut(path("flat.npy"), lut().request).values, lut().values);
}

TEST_F(LookupTableFile, IsRefusedWhereItDoesNotFit) {
  const auto complaint = [&](const std::string& name, const std::string& content) -> std::string {
    write(name, content);
    try {
      (void)read_lut(path(name), lut().request);
    } catch (const Error& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(complaint("few.csv", "1,2,3\n"), HasSubstr("few.csv: holds 3 numbers; the axes ask for 30"));
  EXPECT_THAT(complaint("word.csv", "1,2\n1,two\n"), HasSubstr("word.csv: line 2: 'two' is no number"));
  EXPECT_THAT(complaint("other.csv", "red,green\n1,2\n"), HasSubstr("line 1: names no column 'scale'"));
  EXPECT_THAT(complaint("a.h", "int main();"), HasSubstr("holds no array"));
  EXPECT_THAT(complaint("a.spi1d", "Version 1"), HasSubstr("holds no values between braces"));
  EXPECT_THAT(complaint("a.png", "no image"), HasSubstr("cannot read"));
  EXPECT_THAT(complaint("a.tiff", ""), HasSubstr("no format of lookup tables has the ending '.tiff'"));
  EXPECT_THAT(complaint("a.exr", "no image"), HasSubstr("is no OpenEXR file"));
  std::string tiled = lut_file(as_stored(lut(), {.format = LutFormat::exr}), std::nullopt, {.format = LutFormat::exr});
  tiled[5] = 2;  // flag 0x200
  EXPECT_THAT(complaint("a.exr", tiled), HasSubstr("expected one image of scan lines"));
  tiled[5] = 0;
  const std::size_t compression = tiled.find("compression") + 28;
  ASSERT_EQ(tiled[compression], 3);
  tiled[compression] = 4;
  EXPECT_THAT(complaint("a.exr", tiled), HasSubstr("is compressed by another method than zip"));
  EXPECT_THAT(complaint("a.ktx2", "no image"), HasSubstr("is no KTX file of version 2"));
  EXPECT_THAT(complaint("a.h5", "no file"), HasSubstr("cannot read"));
  const std::string image =
      lut_file(as_stored(lut(), {.format = LutFormat::png}), std::nullopt, {.format = LutFormat::png});
  for (std::size_t size = 0; size < image.size(); size += 7) {
    EXPECT_THAT(complaint("cut.png", image.substr(0, size)), HasSubstr("cannot read")) << size;
  }
  // A chunk that states 1.7 GB: libpng would allocate them.
  std::string long_chunk = image;
  long_chunk.replace(33, 4, "\x67\x41\x6d\x65");  // behind signature and IHDR
  EXPECT_THAT(complaint("long.png", long_chunk), HasSubstr("ends within a chunk"));
  for (const LutFormat format : {LutFormat::exr, LutFormat::ktx2}) {
    const std::string name = format == LutFormat::exr ? "cut.exr" : "cut.ktx2";
    const std::string whole = lut_file(as_stored(lut(), {.format = format}), std::nullopt, {.format = format});
    EXPECT_EQ(complaint(name, whole), "taken") << name;
    for (std::size_t size = 0; size < whole.size(); size += 7) {
      EXPECT_THAT(complaint(name, whole.substr(0, size)), HasSubstr("cannot read")) << name << size;
    }
  }
}

TEST_F(LookupTableFile, IsRefusedWithOtherSidesOrAxes) {
  const auto complaint = [&](const std::string& name, const LutRequest& wanted) -> std::string {
    (void)again(lut(), name);
    try {
      (void)read_lut(path(name), wanted);
    } catch (const IoError& error) {
      return error.what();
    }
    return "taken";
  };
  LutRequest turned = lut().request;
  std::swap(turned.axes[0].count, turned.axes[1].count);
  EXPECT_THAT(complaint("a.exr", turned), HasSubstr("is an image of 5 x 3 pixels; the axes ask for 3 x 5"));
  EXPECT_THAT(complaint("a.ktx2", turned), HasSubstr("is a texture of 5 x 3 x 0 texels; the axes ask for 3 x 5"));
  EXPECT_THAT(complaint("a.h5", turned), HasSubstr("/alpha"));
  // Of the range, a millionth is the same: kSame.
  LutRequest other = lut().request;
  other.axes[0].to += 1.44e-6;
  EXPECT_THAT(complaint("a.h5", other), HasSubstr("entry 3 of axis alpha is 0.85; the axis asked for has 0.85"));
  other.axes[0].to = lut().request.axes[0].to + 0.84e-6;
  EXPECT_EQ(complaint("a.h5", other), "taken");
}

TEST_F(LookupTableFile, SaysWhatAFormatCannotHold) {
  const auto complaint = [&](const Lut& table, const LutFileOptions& options) -> std::string {
    try {
      (void)as_stored(table, options);
    } catch (const ArgumentError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(complaint(lut(), {.format = LutFormat::spi1d}),
              HasSubstr("holds no table of 2 axes; expected one, or another"));
  for (const LutFormat format : {LutFormat::png, LutFormat::exr, LutFormat::ktx2}) {
    EXPECT_THAT(complaint(lut(), {.format = format, .bits = 12}), HasSubstr("has no 12 bits"))
        << static_cast<int>(format);
  }
  EXPECT_THAT(complaint(lut(), {.format = LutFormat::ktx2, .bits = 8, .is_float = true}),
              HasSubstr("format ktx2 has no 8 bits; expected 16 or 32"));
  EXPECT_THAT(complaint(lut(), {.format = LutFormat::c, .bits = 16}), HasSubstr("format c has one kind of numbers"));
  EXPECT_THAT(complaint(lut(), {.format = LutFormat::exr, .is_float = true}), HasSubstr("has one kind of numbers"));
  Lut four = lut();
  for (const char* name : {"x", "y"}) four.request.axes.push_back({.name = name});
  EXPECT_THAT(complaint(four, {.format = LutFormat::ktx2}), HasSubstr("holds no table of 4 axes; expected at most 3"));
  EXPECT_THAT(complaint(four, {.format = LutFormat::exr}), HasSubstr("holds no table of 4 axes; expected at most 2"));
  EXPECT_THAT(complaint(lut(), {.format = LutFormat::c, .name = "2d"}), HasSubstr("cannot name an array '2d'"));
  Lut bright = curve();
  bright.values[3] = 1.25;
  EXPECT_THAT(complaint(bright, {.format = LutFormat::png}), HasSubstr("holds values from 0 to 1, and albedo is 1.25"));
  EXPECT_THAT(complaint(bright, {.format = LutFormat::ktx2}), HasSubstr("holds values from 0 to 1"));
  bright.values[3] = 7e4;
  EXPECT_THAT(complaint(bright, {.format = LutFormat::exr, .bits = 16}),
              HasSubstr("holds no number as large as 70000; expected 32 bits, or another format"));
  EXPECT_EQ(complaint(bright, {.format = LutFormat::exr}), "taken");
  Lut white = curve();
  white.values[3] = 1 + 1e-9;
  EXPECT_EQ(as_stored(white, {.format = LutFormat::png}).values[3], 1);
}

}  // namespace
}  // namespace lobe::test
