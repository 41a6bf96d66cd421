// lobe agreement: distances against what people see.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;

/// Lambertian fits of materials of albedo 0.2, 0.4 and 0.8.
class Agreement : public CommandTest {
 protected:
  void SetUp() override {
    write("study.toml",
          "[study]\n[[material]]\nname = \"dark\"\nmodel = \"lambert\"\nscale = 0.2\n"
          "[[material]]\nname = \"grey\"\nmodel = \"lambert\"\nscale = 0.4\n"
          "[[material]]\nname = \"light\"\nmodel = \"lambert\"\nscale = 0.8\n"
          "[[family]]\nname = \"Fit\"\nmodel = \"lambert\"\ncolumns = [\"name\", \"scale\"]\nscale = \"$scale\"\n"
          "rows = [[\"dark\", 0.3], [\"grey\", 0.42], [\"light\", 0.75]]\n");
    write("judged.csv",
          "\"METHOD\";\"BRDF\";\"DISTANCE\"\n\"FIT\";\"dark\";0.9\n\"FIT\";\"grey\";0.1\n\"FIT\";\"light\";0.2\n"
          "\"OTHER\";\"dark\";0.5\n");
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream stream(file(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(Agreement, CorrelatesWhatIsJudgedAndComputed) {
  const Json answer =
      json({"agreement", "judged.csv", "study.toml", "--metric", "cube-root-l2", "--lighting", "daylight"});

  EXPECT_EQ(answer["schema"], "lobe.agreement/1");
  EXPECT_EQ(answer["judged_pairs"], 4);
  EXPECT_EQ(answer["pairs"], 3);
  EXPECT_EQ(answer["materials"], 3);
  EXPECT_EQ(answer["methods"][1]["method"], "OTHER");
  EXPECT_EQ(answer["methods"][1]["pairs"], 0);
  ASSERT_EQ(answer["metrics"].size(), 4U);
  // Differences of albedos are 0.1, 0.02 and 0.05, in the order of what is judged.
  for (const Json& metric : answer["metrics"]) {
    EXPECT_EQ(metric["spearman"]["value"], 1) << metric;
    EXPECT_NEAR(metric["kendall"]["value"].get<double>(), 1, 1e-15) << metric;
  }
}

TEST_F(Agreement, WritesTheDistancesOfEveryPair) {
  make({"agreement", "judged.csv", "study.toml", "--metric", "cube-root-l2", "-o", "pairs.csv"});

  const std::string text = read("pairs.csv");
  std::istringstream lines(text);
  std::string header;
  std::string line;
  std::getline(lines, header);
  std::getline(lines, line);
  EXPECT_EQ(header, "method,brdf,judged,metric,distance,distance_error,relative,relative_error");
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  ASSERT_EQ(fields.size(), 8U);
  const double expected = std::cbrt(0.3 / std::numbers::pi) - std::cbrt(0.2 / std::numbers::pi);
  EXPECT_NEAR(std::stod(fields[4]), expected, std::stod(fields[5]) + 1e-12);
  EXPECT_NEAR(std::stod(fields[6]), expected / std::cbrt(0.2 / std::numbers::pi), std::stod(fields[7]) + 1e-12);
}

TEST_F(Agreement, TakesReferencesFromAFolder) {
  write("fits.toml",
        "[[family]]\nname = \"Fit\"\nmodel = \"lambert\"\ncolumns = [\"name\", \"scale\"]\nscale = \"$scale\"\n"
        "rows = [[\"dark\", 0.3], [\"grey\", 0.42], [\"light\", 0.75]]\n");
  std::filesystem::create_directory(file("measured"));
  for (const auto& [name, scale] : {std::pair("dark", "0.2"), std::pair("grey", "0.4"), std::pair("light", "0.8")}) {
    make({"tabulate", "lambert:scale=" + std::string(scale), "--grid", "gauss:8x16", "-o",
          "measured/" + std::string(name) + ".h5"});
  }
  const Json answer = json({"agreement", "judged.csv", "fits.toml", "--references", "measured", "--metric", "low-log"});

  EXPECT_EQ(answer["pairs"], 3);
  EXPECT_EQ(answer["metrics"][0]["spearman"]["value"], 1);
}

TEST_F(Agreement, IsTextAndATableToo) {
  EXPECT_THAT(make({"agreement", "judged.csv", "study.toml", "--metric", "low-log"}).output,
              HasSubstr("3 of 4 judged pairs, of 3 materials: FIT 3\n"));
  EXPECT_THAT(make({"agreement", "judged.csv", "study.toml", "--metric", "low-log", "--csv"}).output,
              HasSubstr("\nlow-log,relative,1,"));
}

TEST_F(Agreement, RefusesWhatItCannotCompute) {
  expect_refusal({"agreement", "judged.csv", "lambert"}, ExitCode::usage, "0 of the 4 judged pairs of judged.csv");
  expect_refusal({"agreement", "judged.csv", "study.toml", "--lighting", "patch:0.1"}, ExitCode::usage,
                 "takes tables; expected point, daylight or mean-albedo");
  expect_refusal({"agreement", "judged.csv", "study.toml", "--metric", "cube-root-l3"}, ExitCode::usage,
                 "did you mean 'cube-root-l2'?");
  expect_refusal({"agreement", "study.toml", "study.toml"}, ExitCode::file,
                 "cannot read study.toml: line 1: no column");
  expect_refusal({"agreement", "none.csv", "study.toml"}, ExitCode::file, "none.csv");
  expect_refusal({"agreement", "judged.csv", "study.toml", "--references", "none"}, ExitCode::file, "none");
}

}  // namespace
}  // namespace lobe::test
