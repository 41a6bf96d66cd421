// Standard deviations of samples, and what they make of numbers that are computed from them.
#include "lobe/formats/measurement.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/fit/fit.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/model/material.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "metric/routes.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

BrdfFunction read(const std::string& text, const ReadOptions& options = {}) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "table.csv";
  std::ofstream(path, std::ios::binary) << text;
  return load_measured(path, options);
}

const std::string kTwoAngles =
    "theta_in_deg,theta_out_deg,delta_phi_deg,red,red_std\n"
    "0,0,0,1,0.1\n"
    "0,90,0,3,0.3\n";

TEST(MeasurementDeviations, OfAMeanOfTwoSamplesAreThoseOfUncorrelatedNoise) {
  const BrdfFunction brdf = read(kTwoAngles, {.replicates = 20000});
  ASSERT_EQ(brdf.replicates, 20000U);
  const std::vector<Directions> between{{0, 45 * kDegree, 0}};
  const BrdfValues values = brdf.at(between);
  EXPECT_DOUBLE_EQ(values.value(0, 0), 2);
  const std::vector<double> numbers(values.value.row(0).begin(), values.value.row(0).end());
  const auto deviations = measurement_deviations(brdf, numbers);
  ASSERT_EQ(deviations.size(), 1U);
  // 1 / sqrt(2 x 20000) is what a standard deviation of so many is known to.
  EXPECT_NEAR(deviations[0], std::hypot(0.1, 0.3) / 2, 4 * deviations[0] / std::sqrt(40000.0));
}

TEST(MeasurementDeviations, AreReadButNotDrawnUnlessAskedFor) {
  const BrdfFunction brdf = read(kTwoAngles);
  EXPECT_TRUE(brdf.has_deviations);
  EXPECT_EQ(brdf.replicates, 0U);
  EXPECT_THAT(brdf.channels, ElementsAre("red"));
  EXPECT_THAT(measurement_deviations(brdf, std::vector{1.0}), IsEmpty());
}

TEST(MeasurementDeviations, AreTheSameEachTime) {
  const ReadOptions options{.replicates = 30};
  const std::vector<Directions> pairs{{0, 0.3, 0}};
  EXPECT_EQ(read(kTwoAngles, options).at(pairs).value, read(kTwoAngles, options).at(pairs).value);
}

TEST(MeasurementDeviations, FollowTheLuminance) {
  const std::string text =
      "theta_in_deg,theta_out_deg,delta_phi_deg,red,green,blue,red_std,green_std,blue_std\n"
      "0,0,0,1,1,1,0.1,0.2,0.3\n";
  const BrdfFunction brdf = read(text, {.luminance = "rec709", .replicates = 20000});
  ASSERT_EQ(own_channels(brdf), 1U);
  const auto values = brdf.at(std::vector<Directions>{{0, 0, 0}}).value;
  const std::vector<double> numbers(values.row(0).begin(), values.row(0).end());
  const double expected = std::hypot(0.2126 * 0.1, 0.7152 * 0.2, 0.0722 * 0.3);
  EXPECT_NEAR(measurement_deviations(brdf, numbers)[0], expected, 4 * expected / 200);
}

TEST(MeasurementDeviations, OfScatteredSamplesAreThoseOfTheSamplesWhereTheseAre) {
  std::string text = "theta_in_deg,theta_out_deg,delta_phi_deg,red,red_std\n";
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> angle(0, 80);
  for (int k = 0; k < 200; ++k) {
    text += fmt::format("{},{},{},{},{}\n", angle(engine), angle(engine), 2 * angle(engine), 0.3, 0.01);
  }
  text += "20,50,90,0.3,0.05\n";
  const BrdfFunction brdf = read(text, {.replicates = 1000});
  const auto values = brdf.at(std::vector<Directions>{{20 * kDegree, 50 * kDegree, 90 * kDegree}}).value;
  const std::vector<double> numbers(values.row(0).begin(), values.row(0).end());
  EXPECT_NEAR(measurement_deviations(brdf, numbers)[0], 0.05, 4 * 0.05 / std::sqrt(2000.0));
}

TEST(MeasurementDeviations, RefuseWhatIsNoDeviation) {
  EXPECT_THAT([] { read("theta_in_deg,theta_out_deg,delta_phi_deg,red,red_std\n0,0,0,1,-0.1\n"); },
              ::testing::ThrowsMessage<IoError>(HasSubstr("line 2: a standard deviation of -0.1; expected 0 or more")));
  EXPECT_THAT(
      [] { read("theta_in_deg,theta_out_deg,delta_phi_deg,red,green,red_std\n0,0,0,1,1,0.1\n"); },
      ::testing::ThrowsMessage<IoError>(HasSubstr("channel 'green' has no column 'green_std'; expected standard "
                                                  "deviations for all channels or none")));
  EXPECT_THAT(
      [] {
        (void)measurement_deviations(read(kTwoAngles), std::vector{1.0, 2.0});
      },
      ::testing::ThrowsMessage<ArgumentError>(HasSubstr("expected one for each of the 1 channels")));
}

/// One sample: the same value everywhere, so that all numbers are known functions of it.
std::string one_sample(double value, double deviation) {
  return fmt::format("theta_in_deg,theta_out_deg,delta_phi_deg,red,red_std\n0,0,0,{},{}\n", value, deviation);
}

MetricResult measured(const std::vector<BrdfFunction>& functions, const Lighting& lighting = Lighting::point()) {
  return measure_functions(functions, lighting, {.tolerance = 0.1});
}

constexpr double kKnown = 4 * 0.07;  // four standard deviations of one that is known by 100 replicates

TEST(MetricDeviations, OfAScaledReflectanceFollowItsScale) {
  const auto functions = aligned_replicates(
      std::vector{read(one_sample(0.2, 0.01), {.replicates = kReplicates}), read(one_sample(0.1, 0))});
  const MetricDeviations found = metric_deviations(measured(functions), 1);

  // |f| = pi f for a constant f, and products and distances of constants likewise.
  EXPECT_NEAR(found.combined.norm(0), pi * 0.01, kKnown * pi * 0.01);
  EXPECT_LT(found.combined.norm(1), 1e-12);
  EXPECT_NEAR(found.combined.gram(0, 1), pi * pi * 0.1 * 0.01, kKnown * pi * pi * 0.1 * 0.01);
  EXPECT_NEAR(found.combined.distance(0, 1), found.combined.norm(0), 1e-6);
  EXPECT_NEAR(found.combined.gram(0, 1), pi * 0.1 * found.combined.norm(0), 1e-6);
  EXPECT_LT(found.combined.angle(0, 1), 1e-6);
  EXPECT_THAT(found.channels, IsEmpty());
}

TEST(MetricDeviations, OfTwoMeasurementsAddAsThoseOfIndependentOnes) {
  const auto functions = aligned_replicates(std::vector{read(one_sample(0.2, 0.01), {.replicates = kReplicates}),
                                                        read(one_sample(0.1, 0.01), {.replicates = kReplicates})});
  const MetricDeviations found = metric_deviations(measured(functions), 1);

  // The same noise in both would leave 0.
  const double expected = pi * std::hypot(0.01, 0.01);
  EXPECT_NEAR(found.combined.distance(0, 1), expected, kKnown * expected);
}

TEST(MetricDeviations, OfOneMeasurementTwiceHaveTheSameNoise) {
  const BrdfFunction brdf = read(one_sample(0.2, 0.01), {.replicates = kReplicates});
  const auto functions = aligned_replicates(std::vector{brdf, brdf}, std::vector<std::size_t>{0, 0});

  EXPECT_EQ(metric_deviations(measured(functions), 1).combined.distance(0, 1), 0);
}

TEST(MetricDeviations, OfChannelsTogetherFollowTheirWeights) {
  const BrdfFunction brdf =
      read("theta_in_deg,theta_out_deg,delta_phi_deg,red,green,red_std,green_std\n0,0,0,0.3,0.1,0.02,0\n",
           {.replicates = kReplicates});
  const auto functions = aligned_replicates(std::vector{brdf});
  const std::vector<double> weights{0.25, 0.75};
  const MetricDeviations found = metric_deviations(measured(functions), 2, weights);

  ASSERT_EQ(found.channels.size(), 2U);
  EXPECT_NEAR(found.channels[0].norm(0), pi * 0.02, kKnown * pi * 0.02);
  EXPECT_LT(found.channels[1].norm(0), 1e-12);
  // d sqrt(w r^2 + v g^2) = w r dr / norm
  const double slope = 0.25 * 0.3 / std::sqrt(0.25 * 0.09 + 0.75 * 0.01);
  EXPECT_NEAR(found.combined.norm(0), slope * found.channels[0].norm(0), 0.05 * found.combined.norm(0));
}

TEST(MetricDeviations, RefuseWhatHasNoReplicates) {
  const std::vector<BrdfFunction> functions{read(one_sample(0.2, 0.01))};
  EXPECT_THROW((void)metric_deviations(measured(functions), 1), ArgumentError);
  EXPECT_THROW((void)aligned_replicates(functions, std::vector<std::size_t>{0, 1}), ArgumentError);
}

TEST(FitDeviations, AreThoseOfMembersOfTheFamilyThatReplicatesAre) {
  constexpr std::size_t kCopies = 30;
  constexpr double kScale = 0.4;
  constexpr double kExponent = 8;
  std::mt19937_64 engine(8);
  std::normal_distribution<double> normal;
  std::vector<BrdfFunction> members;
  std::vector<double> scales;
  std::vector<double> exponents;
  for (std::size_t k = 0; k <= kCopies; ++k) {
    scales.push_back(kScale * (1 + (k == 0 ? 0 : 0.003 * normal(engine))));
    exponents.push_back(kExponent * (1 + (k == 0 ? 0 : 0.005 * normal(engine))));
    members.push_back(
        as_function(device(), parse_material(fmt::format("phong:n={},scale={}", exponents.back(), scales.back()))));
  }
  BrdfFunction target = members.front();
  target.channels.assign(1 + kCopies, "value");
  target.replicates = kCopies;
  target.at = [&members](std::span<const Directions> pairs) {
    BrdfValues values{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), 1 + kCopies), {}};
    for (std::size_t k = 0; k <= kCopies; ++k) {
      values.value.col(static_cast<Eigen::Index>(k)) = members[k].at(pairs).value;
    }
    return values;
  };
  FitResult result;
  for (const double value : {kScale, kExponent}) {
    result.values.emplace_back();
    result.values.back().value = value;
  }

  const auto deviations = fit_deviations(device(), target, parse_family("phong"), result);

  const auto expected = [](std::vector<double> values) {
    values.erase(values.begin());
    double mean = 0;
    for (const double x : values) mean += x / kCopies;
    double squares = 0;
    for (const double x : values) squares += (x - mean) * (x - mean);
    return std::sqrt(squares / (kCopies - 1));
  };
  ASSERT_EQ(deviations.size(), 2U);
  // To first order: noise and steps are so small that the rest is some percent.
  EXPECT_NEAR(deviations[0], expected(scales), 0.04 * expected(scales));
  EXPECT_NEAR(deviations[1], expected(exponents), 0.04 * expected(exponents));
}

TEST(FitDeviations, RefuseWhatTheyCannotFollow) {
  const BrdfFunction target = read(one_sample(0.2, 0.01), {.replicates = 20});
  const Family family = parse_family("lambert");
  FitResult result;
  EXPECT_THROW((void)fit_deviations(device(), read(one_sample(0.2, 0.01)), family, result), ArgumentError);
  FitOptions options;
  options.lighting = Lighting::patch(0.5);
  EXPECT_THROW((void)fit_deviations(device(), target, family, result, options), ArgumentError);
  result.objective = FitObjective::log;
  EXPECT_THROW((void)fit_deviations(device(), target, family, result), ArgumentError);
}

/// Sums over directions as albedos at 30 degrees and norms have them: pairs and weights, in equal steps.
struct Sums {
  std::vector<Directions> pairs;
  std::vector<double> weights;
};

Sums midpoint_sums() {
  constexpr int kThetas = 12;
  constexpr int kAzimuths = 24;
  Sums sums;
  for (int i = 0; i < kThetas; ++i) {
    const double theta = (i + 0.5) * pi / 2 / kThetas;
    for (int j = 0; j < kAzimuths; ++j) {
      sums.pairs.push_back({30 * kDegree, theta, (j + 0.5) * 2 * pi / kAzimuths});
      sums.weights.push_back(std::sin(theta) * std::cos(theta) * pi / 2 / kThetas * 2 * pi / kAzimuths);
    }
  }
  return sums;
}

/// Perturbed copies of a file, many to a table, and how often 1.96 standard deviations of an albedo and of a norm, as
/// each copy alone states them, reach what the file itself has. LOBE_COVERAGE_COPIES set: a thousand copies instead of
/// 200.
class Coverage : public MeasuredData {
 protected:
  Coverage() : MeasuredData("") {}

  /// \param noise of each sample, relative
  void expect_coverage(const std::string& file, double noise) {
    const std::size_t copies_wanted = std::getenv("LOBE_COVERAGE_COPIES") == nullptr ? 200 : 1000;
    constexpr std::size_t kAtOnce = 100;
    constexpr std::size_t kDrawn = 60;  // replicates of each copy
    const BrdfFunction truth = load_measured(data_ / file);
    const Sums sums = midpoint_sums();
    std::vector<double> thetas;
    for (double theta = 0; theta < 90; theta += 15) thetas.push_back(theta);
    std::mt19937_64 engine(5);
    std::normal_distribution<double> normal;
    std::size_t of_albedo = 0;
    std::size_t of_norm = 0;
    for (std::size_t batch = 0; batch < copies_wanted / kAtOnce; ++batch) {
      std::string text = "theta_in_deg,theta_out_deg,delta_phi_deg,exact,exact_std";
      for (std::size_t k = 0; k < kAtOnce; ++k) text += fmt::format(",c{0},c{0}_std", k);
      text += '\n';
      for (const double in : thetas) {
        for (const double out : thetas) {
          for (double phi = 0; phi <= 180; phi += 30) {
            const double f =
                truth.at(std::vector<Directions>{{in * kDegree, out * kDegree, phi * kDegree}}).value(0, 0);
            text += fmt::format("{},{},{},{},0", in, out, phi, f);
            for (std::size_t k = 0; k < kAtOnce; ++k) {
              text += fmt::format(",{:.9g},{:.4g}", f + noise * f * normal(engine), noise * f);
            }
            text += '\n';
          }
        }
      }
      const BrdfFunction copies = read(text, {.replicates = kDrawn});
      const Eigen::MatrixXd values = copies.at(sums.pairs).value;
      const Eigen::Map<const Eigen::RowVectorXd> weights(sums.weights.data(), values.rows());
      const Eigen::RowVectorXd albedos = weights * values;
      const Eigen::RowVectorXd norms = (weights * values.cwiseAbs2()).cwiseSqrt();
      of_albedo += covered(copies, albedos);
      of_norm += covered(copies, norms);
    }
    // 1000 copies count to 0.7 %, 200 to 1.5 %; deviations of 60 replicates cost 0.6 % of coverage.
    const double tolerance = copies_wanted == 1000 ? 0.02 : 0.045;
    const auto wanted = static_cast<double>(copies_wanted);
    EXPECT_NEAR(static_cast<double>(of_albedo) / wanted, 0.95, tolerance) << file;
    EXPECT_NEAR(static_cast<double>(of_norm) / wanted, 0.95, tolerance) << file;
  }

 private:
  /// How many of the copies reach the first channel, which has no noise.
  static std::size_t covered(const BrdfFunction& copies, const Eigen::RowVectorXd& numbers) {
    const auto deviations = measurement_deviations(copies, std::vector<double>(numbers.begin(), numbers.end()));
    EXPECT_LT(deviations[0], 1e-12);  // of sums that round
    std::size_t count = 0;
    for (std::size_t k = 1; k < deviations.size(); ++k) {
      const double off = numbers[static_cast<Eigen::Index>(k)] - numbers[0];
      if (std::abs(off) <= 1.96 * deviations[k]) ++count;
    }
    return count;
  }
};

/// Norms by the quadrature of functions, of copies of a file on a coarse grid, beside those of the file on that grid:
/// 40 copies, or a thousand with LOBE_COVERAGE_COPIES.
class NormCoverage : public MeasuredData {
 protected:
  NormCoverage() : MeasuredData("") {}

  /// \param noise of each sample, relative
  void expect_coverage(const std::string& file, double noise) {
    const std::size_t copies_wanted = std::getenv("LOBE_COVERAGE_COPIES") == nullptr ? 40 : 1000;
    constexpr std::size_t kAtOnce = 20;
    const BrdfFunction truth = load_measured(data_ / file);
    std::mt19937_64 engine(11);
    std::normal_distribution<double> normal;
    std::size_t covered = 0;
    for (std::size_t batch = 0; batch < copies_wanted / kAtOnce; ++batch) {
      std::string text = "theta_in_deg,theta_out_deg,delta_phi_deg,exact,exact_std";
      for (std::size_t k = 0; k < kAtOnce; ++k) text += fmt::format(",c{0},c{0}_std", k);
      text += '\n';
      for (double in = 0; in < 90; in += 20) {
        for (double out = 0; out < 90; out += 20) {
          for (double phi = 0; phi <= 180; phi += 60) {
            const double f =
                truth.at(std::vector<Directions>{{in * kDegree, out * kDegree, phi * kDegree}}).value(0, 0);
            text += fmt::format("{},{},{},{},0", in, out, phi, f);
            for (std::size_t k = 0; k < kAtOnce; ++k) {
              text += fmt::format(",{:.9g},{:.4g}", f + noise * f * normal(engine), std::abs(noise * f));
            }
            text += '\n';
          }
        }
      }
      const auto copies = aligned_replicates(std::vector{read(text, {.replicates = 30})});
      const MetricResult result = measure_functions(copies, Lighting::point(), {.tolerance = 0.1, .lobe_width = 0.3});
      const MetricDeviations deviations = metric_deviations(result, 1 + kAtOnce);
      for (std::size_t k = 1; k <= kAtOnce; ++k) {
        const double off = result.channels[k].norm(0) - result.channels[0].norm(0);
        if (std::abs(off) <= 1.96 * deviations.channels[k].norm(0)) ++covered;
      }
    }
    RecordProperty("covered", static_cast<int>(covered));
    // 40 copies count to 3.4 %, 1000 to 0.7 %; deviations of 30 replicates cost 1 % of coverage.
    const double tolerance = copies_wanted == 1000 ? 0.03 : 0.12;
    EXPECT_NEAR(static_cast<double>(covered) / static_cast<double>(copies_wanted), 0.95, tolerance) << file;
  }
};

TEST_F(NormCoverage, OfPtfeIsWhatIsStated) {
  expect_coverage("nist_ptfe/PTFE.532.coeff.csv", 0.03);
}
TEST_F(NormCoverage, OfAPaintIsWhatIsStated) {
  expect_coverage("cornell_pbrt2/garnet_red.brdf", 0.05);
}
TEST_F(NormCoverage, OfAMetalIsWhatIsStated) {
  expect_coverage("nbrdf/merl/alum-bronze.h5", 0.1);
}

TEST_F(Coverage, OfPtfeIsWhatIsStated) {
  expect_coverage("nist_ptfe/PTFE.532.coeff.csv", 0.03);
}
TEST_F(Coverage, OfAPaintIsWhatIsStated) {
  expect_coverage("cornell_pbrt2/garnet_red.brdf", 0.05);
}
TEST_F(Coverage, OfAMetalIsWhatIsStated) {
  expect_coverage("nbrdf/merl/alum-bronze.h5", 0.1);
}

}  // namespace
}  // namespace lobe::test
