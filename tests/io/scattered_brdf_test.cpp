// Interpolation of scattered samples: of models at the geometries of a goniometer, against the models themselves.
#include "io/scattered_brdf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "lobe/error.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

constexpr double kDegree = pi / 180;

using Model = std::function<double(const Directions&)>;

/// Ward's model with the half-vector h: exp(-tan^2 theta_h (cos^2/m_x^2 + sin^2/m_y^2)) / (4 pi m_x m_y sqrt(NL NV)).
double ward(const Directions& pair, double m_x, double m_y) {
  const double phi_out = pair.phi_in + pair.delta_phi;
  const double nl = std::cos(pair.theta_in);
  const double nv = std::cos(pair.theta_out);
  const double x = std::sin(pair.theta_in) * std::cos(pair.phi_in) + std::sin(pair.theta_out) * std::cos(phi_out);
  const double y = std::sin(pair.theta_in) * std::sin(pair.phi_in) + std::sin(pair.theta_out) * std::sin(phi_out);
  const double exponent = (x * x / (m_x * m_x) + y * y / (m_y * m_y)) / ((nl + nv) * (nl + nv));
  return std::exp(-exponent) / (4 * pi * m_x * m_y * std::sqrt(nl * nv));
}

double glossy(const Directions& pair) {
  return 0.3 / pi + 0.2 * ward(pair, 0.15, 0.15);
}

double brushed(const Directions& pair) {
  return 0.1 / pi + 0.3 * ward(pair, 0.15, 0.4);
}

/// Oren and Nayar's simple form, sigma = 30 degrees, albedo 0.8.
double rough(const Directions& pair) {
  const double square = std::pow(30 * kDegree, 2);
  const double a = 1 - 0.5 * square / (square + 0.33);
  const double b = 0.45 * square / (square + 0.09);
  const double alpha = std::max(pair.theta_in, pair.theta_out);
  const double beta = std::min(pair.theta_in, pair.theta_out);
  return 0.8 / pi * (a + b * std::max(0.0, std::cos(pair.delta_phi)) * std::sin(alpha) * std::tan(beta));
}

/// Like Cornell's: eight angles of incidence, viewers on rings, half of their azimuths.
std::vector<Directions> goniometer(std::size_t azimuths_of_light) {
  std::vector<Directions> pairs;
  for (std::size_t turn = 0; turn < azimuths_of_light; ++turn) {
    const double phi_in = 2 * pi * static_cast<double>(turn) / static_cast<double>(azimuths_of_light);
    const int step = azimuths_of_light > 1 ? 20 : 10;
    for (int in = 10; in <= 80; in += step) {
      for (int ring = 0; ring < 10; ++ring) {
        const double out = 8.7 * ring * kDegree;
        const int azimuths = azimuths_of_light > 1 ? 1 + 2 * ring : 2 + 3 * ring;
        for (int k = 0; k <= azimuths; ++k) pairs.push_back({in * kDegree, out, -pi * k / azimuths, phi_in});
        if (azimuths_of_light == 1) continue;
        for (int k = 1; k < azimuths; ++k) pairs.push_back({in * kDegree, out, pi * k / azimuths, phi_in});
      }
    }
  }
  return pairs;
}

/// Anywhere within the angles of the goniometer, uniform in the sines.
std::vector<Directions> random_pairs(std::size_t count) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Directions> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    pairs.push_back({std::asin(unit(engine) * std::sin(78 * kDegree)), std::asin(unit(engine) * std::sin(78 * kDegree)),
                     2 * pi * unit(engine), 2 * pi * unit(engine)});
  }
  return pairs;
}

ScatteredSamples samples_of(const std::vector<Model>& models, std::vector<Directions> pairs, bool is_isotropic) {
  ScatteredSamples samples{std::move(pairs), {}, is_isotropic};
  samples.values.resize(static_cast<Eigen::Index>(samples.pairs.size()), static_cast<Eigen::Index>(models.size()));
  for (std::size_t c = 0; c < models.size(); ++c) {
    for (std::size_t i = 0; i < samples.pairs.size(); ++i) {
      samples.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = models[c](samples.pairs[i]);
    }
  }
  return samples;
}

const FileBytes& no_file() {
  static const FileBytes file = FileBytes::copy("samples", "");
  return file;
}

BrdfFunction function_of(const ScatteredSamples& samples) {
  BrdfFunction brdf;
  for (Eigen::Index c = 0; c < samples.values.cols(); ++c) brdf.channels.push_back(std::to_string(c));
  (void)interpolate(no_file(), samples, {}, brdf);
  return brdf;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

struct Case {
  std::string name;
  Model model;
  bool is_isotropic;
  double deviation;  ///< relative, median, as measured and rounded up
  double stated;     ///< the same of stated errors
};

class Scattered : public ::testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] static ScatteredSamples samples() {
    return samples_of({GetParam().model}, goniometer(GetParam().is_isotropic ? 1 : 12), GetParam().is_isotropic);
  }
  /// Made once for each model.
  [[nodiscard]] static const BrdfFunction& brdf() {
    static std::map<std::string, BrdfFunction> functions;
    const auto found = functions.find(GetParam().name);
    if (found != functions.end()) return found->second;
    return functions.emplace(GetParam().name, function_of(samples())).first->second;
  }
};

TEST_P(Scattered, StatedErrorsHold) {
  const auto& brdf = Scattered::brdf();
  const auto pairs = random_pairs(2000);
  const auto found = brdf.at(pairs);
  double covered = 0;
  std::vector<double> deviations;
  std::vector<double> stated;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double exact = GetParam().model(pairs[i]);
    const double error = std::abs(found.value(row, 0) - exact);
    if (error <= found.error(row, 0)) ++covered;
    deviations.push_back(error / exact);
    stated.push_back(found.error(row, 0) / exact);
  }
  EXPECT_GE(covered, 0.9 * static_cast<double>(pairs.size()));
  EXPECT_LT(median_of(deviations), GetParam().deviation);
  EXPECT_LT(median_of(stated), GetParam().stated);
}

TEST_P(Scattered, LightAndViewerMayChangePlaces) {
  const auto& brdf = Scattered::brdf();
  const auto pairs = random_pairs(200);
  std::vector<Directions> swapped;
  std::vector<Directions> mirrored;
  for (const Directions& pair : pairs) {
    swapped.push_back({pair.theta_out, pair.theta_in, -pair.delta_phi, pair.phi_in + pair.delta_phi});
    mirrored.push_back({pair.theta_in, pair.theta_out, -pair.delta_phi, -pair.phi_in});
  }
  const auto values = brdf.at(pairs).value;
  const auto others = brdf.at(swapped).value;
  const auto sides = brdf.at(mirrored).value;
  EXPECT_EQ(brdf.is_isotropic, GetParam().is_isotropic);
  EXPECT_EQ(brdf.is_bilateral, GetParam().is_isotropic);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    EXPECT_NEAR(others(i, 0), values(i, 0), 1e-12 * values(i, 0));
    if (brdf.is_bilateral) {
      EXPECT_EQ(sides(i, 0), values(i, 0));
    }
  }
}

TEST_P(Scattered, SamplesAreKept) {
  const auto given = samples();
  const auto found = brdf().at(given.pairs).value;
  // Models are the same for samples that count as one, but for their distance of 0.001.
  EXPECT_LT(((found - given.values).array() / given.values.array()).abs().maxCoeff(), 1e-9);
}

TEST_P(Scattered, BeyondTheSamplesValuesAreBoundedByNearOnes) {
  const auto given = samples();
  const auto& brdf = Scattered::brdf();
  for (const double theta : {0.0, 40 * kDegree, 85 * kDegree, 89.99 * kDegree}) {
    const auto found =
        brdf.at(std::vector<Directions>{{theta, 89.9 * kDegree, 1, 0.3}, {89.9 * kDegree, theta, pi, 0}});
    EXPECT_GE(found.value.minCoeff(), 0);
    EXPECT_LE(found.value.maxCoeff(), 1.5 * given.values.maxCoeff());
    EXPECT_GT(found.error(0, 0), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Scattered,
                         ::testing::Values(Case{"glossy", glossy, true, 2e-4, 1e-3},
                                           Case{"rough", rough, true, 5e-4, 4e-3},
                                           Case{"brushed", brushed, false, 5e-3, 4e-2}),
                         [](const auto& one) { return one.param.name; });

TEST(ScatteredSamples, OfWhiteAreWhiteWithoutError) {
  const auto brdf = function_of(samples_of({[](const Directions&) { return 0.25; }}, goniometer(1), true));
  const auto found = brdf.at(random_pairs(50));
  EXPECT_LT((found.value.array() - 0.25).abs().maxCoeff(), 1e-12);
  EXPECT_LT(found.error.maxCoeff(), 1e-12);
}

TEST(ScatteredSamples, ThatCoincideAreAveragedAndCounted) {
  auto given = samples_of({rough}, goniometer(1), true);
  const std::size_t count = given.pairs.size();
  // The first twenty once more, from the other side and 10 % brighter.
  given.values.conservativeResize(static_cast<Eigen::Index>(count + 20), 1);
  for (std::size_t i = 0; i < 20; ++i) {
    const Directions& pair = given.pairs[7 + i];
    given.pairs.push_back({pair.theta_out, pair.theta_in, pair.delta_phi, 0});
    given.values(static_cast<Eigen::Index>(count + i), 0) = 1.1 * rough(pair);
  }
  given.values(900, 0) = -0.001;
  BrdfFunction brdf;
  (void)interpolate(no_file(), given, {}, brdf);
  EXPECT_THAT(brdf.remarks, ::testing::Contains(HasSubstr("1 of 1340 values are negative, and kept")));
  EXPECT_THAT(brdf.remarks, ::testing::Contains(HasSubstr("36 of 1340 samples are at the place of another one")));
  const auto found = brdf.at(std::vector<Directions>{given.pairs[7], given.pairs[900]});
  EXPECT_NEAR(found.value(0, 0), 1.05 * rough(given.pairs[7]), 1e-9);
  EXPECT_GT(found.error(0, 0), 0.04 * rough(given.pairs[7]));
  EXPECT_NEAR(found.value(1, 0), -0.001, 1e-12);
}

TEST(ScatteredSamples, AreTooFew) {
  auto pairs = goniometer(1);
  pairs.resize(7);
  BrdfFunction brdf;
  try {
    (void)interpolate(no_file(), samples_of({rough}, pairs, true), {}, brdf);
    FAIL() << "not refused";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("7 samples; expected at least 8"));
  }
  // The same pair over and over.
  const std::vector<Directions> same(5000, pairs[3]);
  (void)interpolate(no_file(), samples_of({rough}, same, true), {}, brdf);
  EXPECT_THAT(brdf.remarks, ::testing::Contains(HasSubstr("samples at 1 different pairs of directions")));
  const auto found = brdf.at(random_pairs(3));
  EXPECT_NEAR(found.value(2, 0), rough(pairs[3]), 1e-12);
  EXPECT_TRUE(std::isnan(found.error(2, 0)));
}

}  // namespace
}  // namespace lobe::test
