// The studies that come with lobe: error estimates are held against a far finer run; published fits are transcribed as
// published, and resolved to the tolerance although their lobes are fractions of a degree wide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <regex>
#include <string>
#include <vector>

#include "lobe/metric/metric.hpp"
#include "lobe/study/study.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"
#include "support/names.hpp"
#include "support/options.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

struct EstimateCase {
  Lighting lighting;
  double tolerance;
  std::string name;
};

/// Metric of the classical families.
Metric classical_metric(const Lighting& lighting, double tolerance) {
  static const Study study = load_study(LOBE_STUDIES_DIR "/classical-families.toml");
  return measure(device(), formulas(study), lighting, with_tolerance(tolerance)).combined;
}

const Metric& classical_truth(const Lighting& lighting) {
  static std::map<std::string, Metric> truths;
  const auto found = truths.find(lighting.name());
  if (found != truths.end()) return found->second;
  return truths.emplace(lighting.name(), classical_metric(lighting, 1e-9)).first->second;
}

class EstimateOfTheFamilies : public ::testing::TestWithParam<EstimateCase> {};
INSTANTIATE_TEST_SUITE_P(property, EstimateOfTheFamilies,
                         ::testing::Values(EstimateCase{Lighting::point(), 1e-3, "point_1e3"},
                                           EstimateCase{Lighting::point(), 1e-5, "point_1e5"},
                                           EstimateCase{Lighting::point(), 1e-6, "point_1e6"},
                                           EstimateCase{Lighting::point(), 1e-7, "point_1e7"},
                                           EstimateCase{Lighting::daylight(), 1e-3, "daylight_1e3"},
                                           EstimateCase{Lighting::daylight(), 1e-5, "daylight_1e5"},
                                           EstimateCase{Lighting::daylight(), 1e-6, "daylight_1e6"},
                                           EstimateCase{Lighting::daylight(), 1e-7, "daylight_1e7"}),
                         [](const auto& test) { return test.param.name; });

/// Largest |value - truth| / (error + error of the truth) off the zeros.
double worst_ratio(const Eigen::MatrixXd& value, const Eigen::MatrixXd& error, const Eigen::MatrixXd& truth,
                   const Eigen::MatrixXd& truth_error) {
  const Eigen::ArrayXXd deviation = (value - truth).array().abs();
  const Eigen::ArrayXXd allowed = error.array() + truth_error.array();
  return (deviation > 0).select(deviation / allowed, 0.0).maxCoeff();
}

TEST_P(EstimateOfTheFamilies, IsNeverBelowTheTrueError) {
  const Metric& truth = classical_truth(GetParam().lighting);

  const Metric metric = classical_metric(GetParam().lighting, GetParam().tolerance);

  const double gram = worst_ratio(metric.gram, metric.gram_error, truth.gram, truth.gram_error);
  const double distance = worst_ratio(metric.distance, metric.distance_error, truth.distance, truth.distance_error);
  RecordProperty("gram", std::to_string(gram));
  RecordProperty("distance", std::to_string(distance));
  EXPECT_LE(gram, 1);
  EXPECT_LE(distance, 1);
}

const Study& study() {
  static const Study loaded = load_study(LOBE_STUDIES_DIR "/merl-fits.toml");
  return loaded;
}

class MerlFits : public ::testing::TestWithParam<Lighting> {};
INSTANTIATE_TEST_SUITE_P(property, MerlFits, ::testing::Values(Lighting::point(), Lighting::daylight()),
                         [](const auto& test) { return test_name(test.param.name()); });

TEST_P(MerlFits, EveryProductReachesTheTolerance) {
  const MetricOptions options = with_channel_weights(study().channel_weights);
  // Some of all families, widths and materials: all take a minute and a half.
  const std::size_t step = full_scale() ? 1 : GetParam() == Lighting::daylight() ? 7 : 3;
  std::vector<Material> materials;
  for (std::size_t k = 0; k < study().materials.size(); k += step) materials.push_back(*study().materials[k].formula());

  const auto result = measure(device(), materials, GetParam(), options);

  EXPECT_TRUE(result.unresolved.empty());
  const double worst = (result.combined.gram_error.array() / result.combined.gram.array()).maxCoeff();
  RecordProperty("worst_relative_error", std::to_string(worst));
  EXPECT_LE(worst, options.tolerance);
  EXPECT_TRUE(result.combined.distance.allFinite());
}

/// Numbers of "key = 1.5" or "key = [1, 2, 3]", the occurrence-th time it stands in a line.
std::vector<double> figures(const std::string& line, const std::string& key, std::size_t occurrence = 0) {
  const std::regex pattern(key + R"( = (\[[^\]]*\]|[-+.eE0-9]+))");
  auto match = std::sregex_iterator(line.begin(), line.end(), pattern);
  std::advance(match, occurrence);
  const std::string text = (*match)[1];
  std::vector<double> values;
  const std::regex number(R"([-+]?[0-9.]+([eE][-+]?[0-9]+)?)");
  for (auto it = std::sregex_iterator(text.begin(), text.end(), number); it != std::sregex_iterator(); ++it) {
    values.push_back(std::stod(it->str()));
  }
  return values;
}

struct FitFile {
  std::string file;
  std::string family;
  std::vector<std::string> parameters;  ///< keys of the file in the order of the model's parameters
  double factor;                        ///< constant between the file's convention and the model's
};

class Transcription : public ::testing::TestWithParam<FitFile> {};
INSTANTIATE_TEST_SUITE_P(
    property, Transcription,
    ::testing::Values(FitFile{"ngan_ward", "Ward", {"roughness"}, 1},
                      FitFile{"ngan_blinnphong", "Blinn-Phong", {"sharpness"}, 1},
                      FitFile{"ngan_cooktorrance", "Cook-Torrance", {"roughness", "eta"}, 4 / std::numbers::pi},
                      FitFile{"ngan_lafortune", "Lafortune", {"Cxy", "Cz", "sharpness"}, 1}),
    [](const auto& test) { return test.param.file; });

TEST_P(Transcription, HasEveryFigureAsPublished) {
  const auto path = measured_data("merl_fits/" + GetParam().file + ".fit");
  if (path.empty()) GTEST_SKIP() << kNoData;
  std::ifstream file(path);
  std::size_t fits = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    ++fits;
    const std::string name = GetParam().family + " " + line.substr(0, line.find(' '));
    const auto& materials = study().materials;
    const auto found =
        std::find_if(materials.begin(), materials.end(), [&](const auto& m) { return m.name() == name; });
    ASSERT_NE(found, materials.end()) << name;
    ASSERT_EQ(found->formula()->terms.size(), 2U) << name;

    EXPECT_EQ(found->formula()->terms[0].weight, figures(line, "albedo", 0)) << name;
    const auto glossy = figures(line, "albedo", 1);
    for (std::size_t c = 0; c < glossy.size(); ++c) {
      EXPECT_DOUBLE_EQ(found->formula()->terms[1].weight.at(c), GetParam().factor * glossy[c]) << name;
    }
    for (std::size_t p = 0; p < GetParam().parameters.size(); ++p) {
      EXPECT_EQ(found->formula()->terms[1].values.at(p), figures(line, GetParam().parameters[p]).at(0)) << name;
    }
  }
  EXPECT_EQ(fits, 86U);
}

/// A file of fits, the family of perceptual-fits.toml that holds them, and the keys of its parameters: values of the
/// file in the model's order, "eta" standing for two of them.
struct MicrofacetFile {
  std::string file;
  std::string family;
  std::vector<std::string> parameters;
};

class PerceptualTranscription : public ::testing::TestWithParam<MicrofacetFile> {};
INSTANTIATE_TEST_SUITE_P(
    property, PerceptualTranscription,
    ::testing::Values(MicrofacetFile{"low_lowmicrofacet_E2", "ABC", {"\\bA", "\\bB", "\\bC", "eta"}},
                      MicrofacetFile{"bagher_sgd", "SGD", {"alpha", "\\bp", "eta", "Lambda", "\\bk", "theta0"}}),
    [](const auto& test) { return test.param.family; });

TEST_P(PerceptualTranscription, HasEveryFigureAsPublished) {
  const auto path = measured_data("merl_fits/" + GetParam().file + ".fit");
  if (path.empty()) GTEST_SKIP() << kNoData;
  static const Study fits = load_study(LOBE_STUDIES_DIR "/perceptual-fits.toml");
  std::ifstream file(path);
  std::size_t count = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    ++count;
    const std::string name = GetParam().family + " " + line.substr(0, line.find(' '));
    const auto found = std::ranges::find(fits.materials, name, &StudyMaterial::name);
    ASSERT_NE(found, fits.materials.end()) << name;
    EXPECT_EQ(found->formula()->terms.front().weight, figures(line, "albedo", 0)) << name;
    // Channels with values of their own are terms of their own.
    std::vector<std::vector<double>> expected;  // [parameter][channel]
    for (const auto& key : GetParam().parameters) {
      auto values = figures(line, key);
      if (key == "eta" && GetParam().family == "SGD") {
        const auto second = line.find("], [", line.find("eta = [["));
        values = figures("x = " + line.substr(line.find("eta = [[") + 7), "x");
        expected.push_back(values);
        values = figures("x = " + line.substr(second + 3), "x");
      }
      expected.push_back(values);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const auto in_channel = [&](const Term& term) { return term.weight.size() == 1 || term.weight.at(c) != 0; };
      const auto term = std::find_if(found->formula()->terms.begin() + 1, found->formula()->terms.end(), in_channel);
      ASSERT_NE(term, found->formula()->terms.end()) << name;
      for (std::size_t p = 0; p < expected.size(); ++p) {
        EXPECT_EQ(term->values.at(p), expected[p].at(expected[p].size() == 1 ? 0 : c)) << name << " parameter " << p;
      }
      const double scale = GetParam().family == "SGD" ? figures(line, "albedo", 1).at(c) : 1;
      EXPECT_EQ(term->weight.at(term->weight.size() == 1 ? 0 : c), scale) << name;
    }
  }
  EXPECT_EQ(count, 100U);
}

}  // namespace
}  // namespace lobe::test
