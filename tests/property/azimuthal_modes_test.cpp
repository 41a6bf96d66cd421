// Azimuthal modes: closed forms, errors that hold at kinks and jumps, and what they are for: sums give back values, and
// the mode of no azimuth the albedo.
#include "lobe/reflectance/azimuthal_modes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "reference/models.hpp"
#include "support/device.hpp"
#include "support/functions.hpp"
#include "support/materials.hpp"
#include "support/measured_data.hpp"
#include "support/random_materials.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

AzimuthalModes modes_of(const Reflectance& reflectance, const std::vector<double>& cosines, std::size_t count,
                        const AzimuthalModesOptions& options = {}) {
  return azimuthal_modes(device(), reflectance, cosines, cosines, count, options);
}

TEST(AzimuthalModes, OfLambertAreItsAlbedoOverPiAndNothing) {
  const AzimuthalModes found = modes_of(parse_material("lambert:scale=0.3"), {0.2, 0.7, 1}, 4);

  ASSERT_EQ(found.values.size(), 4U * 9);
  for (std::size_t m = 0; m < 4; ++m) {
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_NEAR(found.values[m * 9 + k], m == 0 ? 0.3 / pi : 0, found.errors[m * 9 + k]) << m << " " << k;
      EXPECT_LE(found.errors[m * 9 + k], 1e-14) << m << " " << k;
    }
  }
  EXPECT_LE(found.left_out.at(0), 1e-7);
  EXPECT_EQ(found.one_sided.at(0), 0);
}

// With x = cos_i cos_o and y = sin_i sin_o, L.V = x + y cos(phi).
TEST(AzimuthalModes, OfAPolynomialOfTheAngleBetweenTheDirectionsAreInClosedForm) {
  const double a = 0.1;
  const double b = 0.04;
  const double c = 0.07;
  const BrdfFunction f = function_of([=](const Directions& pair) {
    const double between = std::cos(pair.theta_in) * std::cos(pair.theta_out) +
                           std::sin(pair.theta_in) * std::sin(pair.theta_out) * std::cos(pair.delta_phi);
    return a + b * between + c * between * between;
  });
  const std::vector<double> in{0.1, 0.5, 0.95};
  const std::vector<double> out{0.3, 1};

  const AzimuthalModes found = azimuthal_modes(device(), f, in, out, 5);

  for (std::size_t o = 0; o < out.size(); ++o) {
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double x = in[i] * out[o];
      const double y = std::sqrt((1 - in[i] * in[i]) * (1 - out[o] * out[o]));
      const double expected[] = {a + b * x + c * (x * x + y * y / 2), (b * y + 2 * c * x * y) / 2, c * y * y / 4, 0, 0};
      for (std::size_t m = 0; m < 5; ++m) {
        const std::size_t at = found.at(0, m, o, i);
        EXPECT_NEAR(found.values[at], expected[m], found.errors[at]) << m << " " << o << " " << i;
        EXPECT_LE(found.errors[at], 1e-14) << m << " " << o << " " << i;
      }
    }
  }
}

TEST(AzimuthalModes, OfDisortAreThoseOfPiTimesTheValueAlongTheLight) {
  const Material material = parse_material("phong:n=20");
  const AzimuthalModes brdf = modes_of(material, {0.3, 0.6}, 4);

  const AzimuthalModes disort = modes_of(material, {0.3, 0.6}, 4, {.convention = ModeConvention::disort});

  const double factors[] = {pi, -2 * pi, 2 * pi, -2 * pi};
  for (std::size_t m = 0; m < 4; ++m) {
    const std::size_t at = brdf.at(0, m, 1, 0);
    EXPECT_NEAR(disort.values[at], factors[m] * brdf.values[at], 1e-15) << m;
    EXPECT_NEAR(disort.errors[at], std::abs(factors[m]) * brdf.errors[at], 1e-18) << m;
    EXPECT_GT(disort.values[at], 0) << m;  // a highlight about the mirror direction, where this azimuth is 0
  }
}

/// The part of a cosine above a threshold, or where it is above it: seen from one side, or turned by an angle.
struct Threshold {
  double at;
  bool is_jump;
  double turn;
};

double value(const Threshold& one, double azimuth) {
  const double above = std::cos(azimuth - one.turn) - one.at;
  return above <= 0 ? 0 : one.is_jump ? 1 : above;
}

/// Of what is left where both sides are averaged.
double known_mode(const Threshold& one, std::size_t mode) {
  const double a = std::acos(one.at);
  const auto m = static_cast<double>(mode);
  const double side = std::cos(m * one.turn);
  if (one.is_jump) return side * (mode == 0 ? a / pi : std::sin(m * a) / (m * pi));
  if (mode == 0) return side * (std::sin(a) - one.at * a) / pi;
  const double cosines = mode == 1 ? a / 2 + std::sin(2 * a) / 4
                                   : std::sin((m + 1) * a) / (2 * (m + 1)) + std::sin((m - 1) * a) / (2 * (m - 1));
  return side * (cosines - one.at * std::sin(m * a) / m) / pi;
}

class ModesOfThresholds : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(calibrated, ModesOfThresholds, ::testing::Values(1U));
INSTANTIATE_TEST_SUITE_P(held_back, ModesOfThresholds, ::testing::Values(2U, 3U));

TEST_P(ModesOfThresholds, HaveErrorsThatHoldAndAreNotMuchTooLarge) {
  Dice dice(GetParam());
  std::vector<double> excess;
  double largest = 0;
  for (int k = 0; k < 200; ++k) {
    const Threshold one{dice.uniform(-0.95, 0.95), k % 2 == 0, k % 4 < 2 ? 0 : dice.uniform(-pi, pi)};
    BrdfFunction f = function_of([one](const Directions& pair) { return value(one, pair.delta_phi); });
    f.is_bilateral = one.turn == 0;

    const AzimuthalModes found = modes_of(f, {0.5}, 6, {.tolerance = 1e-3});

    double worst = 0;
    for (std::size_t m = 0; m < 6; ++m) {
      const double off = std::abs(found.values[m] - known_mode(one, m));
      EXPECT_LE(off, found.errors[m]) << "threshold " << one.at << ", jump " << one.is_jump << ", turned by "
                                      << one.turn << ", mode " << m;
      worst = std::max(worst, off);
    }
    excess.push_back(found.errors[0] / worst);
    largest = std::max(largest, worst / found.errors[0]);
    EXPECT_LE(found.errors[0], 1e-3) << one.at;
  }
  std::ranges::sort(excess);
  EXPECT_LE(excess[excess.size() / 2], 12);
  EXPECT_GE(largest, 0.4);
}

// Of a direction with a value of its own every rule takes its share, which halves with the step and no sooner.
TEST(AzimuthalModes, BoundTheShareOfASingleDirection) {
  const BrdfFunction f = function_of([](const Directions& pair) { return pair.delta_phi == 0 ? 0.0 : 1.0; });
  for (const double tolerance : {1e-2, 1e-3}) {
    const AzimuthalModes found = modes_of(f, {0.5}, 1, {.tolerance = tolerance});
    EXPECT_LE(1 - found.values[0], found.errors[0]) << tolerance;
    EXPECT_LE(found.errors[0], tolerance) << tolerance;
    EXPECT_LE(found.errors[0], 3 * (1 - found.values[0])) << tolerance;
  }
}

// Where the kink lies at a quarter of a step, two rules agree by chance.
TEST(AzimuthalModes, DoNotTrustTwoRulesThatAgreeByChance) {
  const double step = 2 * pi / 128;
  for (int k = 5; k < 25; ++k) {
    const Threshold one{std::cos((k + 0.25) * step), false, 0};
    BrdfFunction f = function_of([one](const Directions& pair) { return value(one, pair.delta_phi); });
    f.is_bilateral = true;

    const AzimuthalModes found = modes_of(f, {0.5}, 1, {.tolerance = 1e-2});

    EXPECT_LE(std::abs(found.values[0] - known_mode(one, 0)), found.errors[0]) << k;
  }
}

TEST(AzimuthalModes, SayHowMuchIsOneSided) {
  const Threshold turned{0.2, false, 0.8};
  const AzimuthalModes found =
      modes_of(function_of([=](const Directions& pair) { return value(turned, pair.delta_phi); }), {0.5}, 3);

  const Threshold straight{0.2, false, 0};
  const double expected = 2 * std::max(std::abs(known_mode(straight, 1) * std::sin(0.8)),
                                       std::abs(known_mode(straight, 2) * std::sin(1.6)));
  EXPECT_NEAR(found.one_sided.at(0), expected, 1e-4);
}

double sum_at(const AzimuthalModes& modes, std::size_t out, std::size_t in, double azimuth) {
  double sum = 0;
  for (std::size_t m = 0; m < modes.count; ++m) {
    sum += (m == 0 ? 1 : 2) * modes.values[modes.at(0, m, out, in)] * std::cos(static_cast<double>(m) * azimuth);
  }
  return sum;
}

TEST(AzimuthalModes, AddUpToTheValueButForWhatTheyLeaveOut) {
  const std::vector<double> cosines{0.2, 0.6, 0.9};
  constexpr int kAzimuths = 1 << 14;
  for (const char* text : {"phong:n=30", "ggx:alpha=0.3", "hapke_isotropic:g=0.5", "oren_nayar:sigma=0.5"}) {
    const Material material = parse_material(text);
    for (const std::size_t count : {3U, 40U}) {
      const AzimuthalModes found = modes_of(material, cosines, count);
      double missed = 0;
      double all = 0;
      for (std::size_t out = 0; out < cosines.size(); ++out) {
        for (std::size_t in = 0; in < cosines.size(); ++in) {
          std::vector<Directions> pairs;
          for (int k = 0; k < kAzimuths; ++k) {
            pairs.push_back({std::acos(cosines[in]), std::acos(cosines[out]), (k + 0.5) * 2 * pi / kAzimuths, 0});
          }
          const Eigen::MatrixXd values = evaluate(device(), material, pairs).value;
          for (int k = 0; k < kAzimuths; ++k) {
            missed += std::pow(values(k, 0) - sum_at(found, out, in, pairs[static_cast<std::size_t>(k)].delta_phi), 2);
            all += std::pow(values(k, 0), 2);
          }
        }
      }
      const double expected = std::sqrt(missed / all);
      EXPECT_NEAR(found.left_out.at(0), expected, 1e-3 * expected + 1e-7) << text << ", " << count << " modes";
    }
  }
}

TEST(AzimuthalModes, WithoutAzimuthGiveTheAlbedo) {
  const CosineRule rule = cosine_rule(48);
  for (const char* text : {"hapke_isotropic:g=5", "rpv:rho=0.1,k=0.9,asymmetry=0.1", "phong:n=3"}) {
    const Material material = parse_material(text);
    const std::vector<double> in{0.6};
    const AzimuthalModes found = azimuthal_modes(device(), material, in, rule.cosines, 1);
    double sum = 0;
    for (std::size_t o = 0; o < rule.cosines.size(); ++o) {
      sum += 2 * pi * rule.weights[o] * rule.cosines[o] * found.values[found.at(0, 0, o, 0)];
    }
    const std::vector<double> angle{std::acos(0.6)};
    const Estimate albedo = lobe::albedo(device(), material, angle)[0][0];
    // Gauss nodes over the cosine converge more slowly where the model has a root at the horizon.
    EXPECT_NEAR(sum, albedo.value, albedo.error + 1e-5) << text;
  }
}

TEST(AzimuthalModes, OfASharpHighlightAreThoseOfAPlainSum) {
  constexpr int kSteps = 1 << 15;
  for (const auto& [in, out] : {std::pair(0.5, 0.5), std::pair(0.5, 0.51), std::pair(0.9, 0.2)}) {
    const std::vector<double> of_light{in};
    const std::vector<double> of_viewer{out};
    const AzimuthalModes found = azimuthal_modes(device(), parse_material("phong:n=20000"), of_light, of_viewer, 3);
    for (std::size_t m = 0; m < 3; ++m) {
      reference::Real sum = 0;
      for (int k = 0; k < kSteps; ++k) {
        const double azimuth = (k + 0.5) * 2 * pi / kSteps;
        const Directions pair{std::acos(in), std::acos(out), azimuth, 0};
        sum += reference::phong(reference::light_of(pair), reference::view_of(pair), 20000) *
               std::cos(static_cast<reference::Real>(m) * azimuth);
      }
      EXPECT_NEAR(found.values[m], static_cast<double>(sum / kSteps), found.errors[m] + 1e-300) << in << out << m;
    }
  }
}

TEST(AzimuthalModes, MissTheirToleranceInOneCallForEachPair) {
  std::vector<MissedTolerance> missed;
  AzimuthalModesOptions options{.tolerance = 1e-12};
  options.missed = [&](const MissedTolerance& one) { missed.push_back(one); };
  const BrdfFunction f = function_of([](const Directions& pair) { return std::cos(pair.delta_phi) > 0.3 ? 1.0 : 0.0; });

  const AzimuthalModes found = modes_of(f, {0.25, 0.5}, 2, options);

  ASSERT_EQ(missed.size(), 4U);
  EXPECT_EQ(missed[1].quantity, "modes at cosines 0.5 and 0.25 of 'formula'");
  EXPECT_NEAR(found.values[0], std::acos(0.3) / pi, found.errors[0]);
  EXPECT_GT(missed[0].relative_error, 1e-12);
}

TEST(AzimuthalModes, ReachTheirToleranceWhereNextToNothingIsReflected) {
  std::size_t missed = 0;
  AzimuthalModesOptions options;
  options.missed = [&](const MissedTolerance&) { ++missed; };
  for (const char* text : {"phong:n=2000", "phong:n=20000", "lambert:scale=0"}) {
    (void)modes_of(parse_material(text), cosine_rule(16).cosines, 4, options);
    EXPECT_EQ(missed, 0U) << text;
  }
}

// Minnaert's f = (k + 2) / (2 pi) (cos_i cos_o)^k, the same for all azimuths: what is lost is the cosine.
TEST(AzimuthalModes, BoundTheRoundingOfGrazingCosines) {
  for (const double cosine : {0.5, 5.3e-3, 1e-3, 1e-4, 1e-6}) {
    const double expected = 2.5 / (2 * pi) * cosine;
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
      const AzimuthalModes found = modes_of(parse_material("minnaert:k=0.5"), {cosine}, 1, {.precision = precision});
      EXPECT_NEAR(found.values[0], expected, found.errors[0])
          << cosine << (precision == Precision::single_precision ? ", single" : "");
    }
  }
}

TEST(AzimuthalModes, HoldInSinglePrecision) {
  for (const char* text : {"phong:n=20", "phong:n=200", "phong:n=20000"}) {
    const AzimuthalModes exact = modes_of(parse_material(text), {0.5, 0.9, 0.99}, 3);
    const AzimuthalModes found =
        modes_of(parse_material(text), {0.5, 0.9, 0.99}, 3, {.precision = Precision::single_precision});
    for (std::size_t k = 0; k < exact.values.size(); ++k) {
      EXPECT_NEAR(found.values[k], exact.values[k], found.errors[k] + exact.errors[k]) << text << " " << k;
    }
  }
}

TEST(AzimuthalModes, OfTablesHaveTheErrorOfInterpolation) {
  const Material material = parse_material("phong:n=5");
  const std::vector<double> cosines{0.3, 0.6, 1};
  const AzimuthalModes exact = modes_of(material, cosines, 3);
  const AzimuthalModes found = modes_of(tabulate(device(), material, HemisphereGrid::gauss(16, 32)), cosines, 3);
  double tightest = 1e9;
  for (std::size_t k = 0; k < exact.values.size(); ++k) {
    const double off = std::abs(found.values[k] - exact.values[k]);
    EXPECT_LE(off, found.errors[k] + exact.errors[k]) << k;
    if (off > 0) tightest = std::min(tightest, found.errors[k] / off);
  }
  EXPECT_LE(tightest, 100);  // as wide as what the table states of its values
}

TEST(AzimuthalModes, OfLargeNumbersAreRefusedAndOfSmallOnesRight) {
  const AzimuthalModes small = modes_of(parse_material("lambert:scale=1e-200"), {0.5}, 2);
  EXPECT_NEAR(small.values[0], 1e-200 / pi, small.errors[0]);
  EXPECT_LE(std::abs(small.values[1]), small.errors[1]);
  EXPECT_THROW((void)modes_of(parse_material("lambert:scale=1e200"), {0.5}, 2), NumericError);
}

TEST(AzimuthalModes, AreRefusedWhereThereAreNone) {
  const auto refuse = [](const char* text, double cosine, std::size_t count, const std::string& complaint) {
    try {
      (void)modes_of(parse_material(text), {cosine}, count);
      FAIL() << complaint;
    } catch (const ArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(complaint), std::string::npos) << error.what();
    }
  };
  refuse("lambert:scale=0.3+mirror:scale=0.2", 0.5, 2, "has delta parts");
  refuse("ward_anisotropic:m_x=0.2,m_y=0.4", 0.5, 2, "depends on the azimuth of the light");
  refuse("lambert", 0, 2, "cosine 0 of the light; expected numbers from 1e-6 to 1");
  refuse("lambert", 1e-16, 2, "cosine 1e-16 of the light");
  refuse("lambert", 1.5, 2, "cosine 1.5 of the light");
  refuse("lambert", 0.5, 0, "0 modes; expected 1 to 512");
  refuse("lambert", 0.5, 513, "513 modes");
  EXPECT_THROW((void)modes_of(parse_material("lambert"), {}, 2), ArgumentError);
  EXPECT_THROW((void)cosine_rule(0), ArgumentError);
  EXPECT_THROW((void)parse_mode_convention("cdisort"), ArgumentError);
}

class ModesOfFiles : public MeasuredData {
 protected:
  ModesOfFiles() : MeasuredData("nbrdf") {}
};

TEST_F(ModesOfFiles, AreThoseOfAPlainSumOfValues) {
  const Reflectance file = load_reflectance(data_ / "merl" / "alum-bronze.h5");
  const std::vector<double> cosines{0.3, 0.8};
  const AzimuthalModes found = modes_of(file, cosines, 4);
  ASSERT_EQ(found.channels.size(), 3U);
  constexpr int kSteps = 1 << 14;
  for (std::size_t out = 0; out < 2; ++out) {
    for (std::size_t in = 0; in < 2; ++in) {
      std::vector<Directions> pairs;
      for (int k = 0; k < kSteps; ++k) {
        pairs.push_back({std::acos(cosines[in]), std::acos(cosines[out]), (k + 0.5) * 2 * pi / kSteps, 0});
      }
      const Eigen::MatrixXd values = evaluate(device(), file, pairs).value;
      for (std::size_t m = 0; m < 4; ++m) {
        double sum = 0;
        for (int k = 0; k < kSteps; ++k) {
          sum +=
              values(k, 1) * std::cos(static_cast<double>(m) * pairs[static_cast<std::size_t>(k)].delta_phi) / kSteps;
        }
        const std::size_t at = found.at(1, m, out, in);
        EXPECT_NEAR(found.values[at], sum, found.errors[at]) << m << out << in;
      }
    }
  }
}

}  // namespace
}  // namespace lobe::test
