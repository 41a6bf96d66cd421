// The study of published fits: transcribed as published, and resolved to the tolerance although its lobes are fractions
// of a degree wide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <string>
#include <vector>

#include "lobe/metric.hpp"
#include "lobe/study.hpp"
#include "support/device.hpp"
#include "support/options.hpp"

namespace lobe::test {
namespace {

const Study& study() {
  static const Study loaded = load_study(LOBE_STUDIES_DIR "/merl-fits.toml");
  return loaded;
}

class MerlFits : public ::testing::TestWithParam<Lighting> {};
INSTANTIATE_TEST_SUITE_P(property, MerlFits, ::testing::Values(Lighting::point, Lighting::daylight),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST_P(MerlFits, EveryProductReachesTheTolerance) {
  const MetricOptions options = with_channel_weights(study().channel_weights);

  const auto result = measure(device(), study().materials, GetParam(), options);

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
  const char* data = std::getenv("LOBE_DATA_DIR");
  const auto path = std::filesystem::path(data != nullptr ? data : "") / "merl_fits" / (GetParam().file + ".fit");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there; set LOBE_DATA_DIR";
  std::ifstream file(path);
  std::size_t fits = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    ++fits;
    const std::string name = GetParam().family + " " + line.substr(0, line.find(' '));
    const auto& materials = study().materials;
    const auto found = std::find_if(materials.begin(), materials.end(), [&](const auto& m) { return m.name == name; });
    ASSERT_NE(found, materials.end()) << name;
    ASSERT_EQ(found->terms.size(), 2U) << name;

    EXPECT_EQ(found->terms[0].weight, figures(line, "albedo", 0)) << name;
    const auto glossy = figures(line, "albedo", 1);
    for (std::size_t c = 0; c < glossy.size(); ++c) {
      EXPECT_DOUBLE_EQ(found->terms[1].weight.at(c), GetParam().factor * glossy[c]) << name;
    }
    for (std::size_t p = 0; p < GetParam().parameters.size(); ++p) {
      EXPECT_EQ(found->terms[1].values.at(p), figures(line, GetParam().parameters[p]).at(0)) << name;
    }
  }
  EXPECT_EQ(fits, 86U);
}

}  // namespace
}  // namespace lobe::test
