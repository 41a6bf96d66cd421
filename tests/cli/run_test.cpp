// `lobe run`: what it leaves, and what it does not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/process.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

constexpr const char* kStudy = R"(
[study]
name = "three"
lightings = ["point", "daylight"]
tolerance = 1e-4

[[material]]
name = "matt"
model = "lambert"

[[material]]
name = "gloss"
model = "phong"
n = 20

[[material]]
name = "metal"
model = "ward"
m = 0.2
)";

/// A directory with a small study in it.
class Run : public ::testing::Test {
 protected:
  Run() { write("three.toml", kStudy); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(path() / name) << text; }
  [[nodiscard]] const fs::path& path() const { return directory_.path(); }
  [[nodiscard]] Outcome run(std::vector<std::string> arguments, Surroundings surroundings = {}) const {
    arguments.insert(arguments.begin(), "run");
    surroundings.directory = path();
    return run_lobe(arguments, surroundings);
  }
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(path())) {
      if (entry.path().filename() != "three.toml") names.push_back(fs::relative(entry.path(), path()).string());
    }
    return names;
  }
  static void expect_one_line(const Outcome& outcome, int status) {
    EXPECT_EQ(outcome.status, status) << outcome.error;
    EXPECT_THAT(outcome.error, StartsWith("lobe: error: "));
    EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
    EXPECT_THAT(outcome.output, IsEmpty());
  }

 private:
  TemporaryDirectory directory_;
};

constexpr const char* kPublished = R"(
[[published]]
title = "Table 1"
quantity = "reflectance"
at = [[0, 0, 0]]
model = "lambert"
scale = "$a"
columns = ["a", "printed", "corrected"]
rows = [[1, "0.318", ""], [0.5, "0.160", "0.159"], [0.25, "0.081", "%s"]]
)";

std::string published(const std::string& last_correction) {
  std::string text = kPublished;
  return text.replace(text.find("%s"), 2, last_correction);
}

TEST_F(Run, ChecksPublishedFigures) {
  write("three.toml", published("0.080"));
  const auto outcome = run({"three.toml", "-o", "out"});

  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("out/three.published.md\n"));
  EXPECT_THAT(outcome.output, HasSubstr("1 of 3 agree with the values computed, 3 of 3 are as expected\n"));
  EXPECT_THAT(files(),
              UnorderedElementsAre("out", "out/three.h5", "out/three.published.csv", "out/three.published.md"));
  EXPECT_EQ(run({"three.toml", "-o", "out"}).status, 3) << "files that exist are kept";
}

TEST_F(Run, FailsWhereAPublishedFigureIsMissed) {
  write("three.toml", published(""));
  const auto outcome = run({"three.toml", "-o", "out"});

  EXPECT_EQ(outcome.status, 1) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("missed: Table 1, a = 0.25: printed 0.081, computed 0.0795774715"));
  const auto json = run({"three.toml", "-o", "out", "-f", "--json"});
  EXPECT_EQ(json.status, 1);
  const auto answer = nlohmann::json::parse(json.output);
  EXPECT_EQ(answer.at("published").size(), 3U);
  EXPECT_FALSE(answer.at("published").at(2).at("as_expected").get<bool>());
}

TEST_F(Run, DrawsCharts) {
  write("three.toml", R"([[chart]]
name = "2.3"
quantity = "mirror-radiance"
x = [0, 60]
unit = {model = "phong", n = 20}
curves = [{label = "Phong, n = 20", model = "phong", n = 20}]
)");
  const auto outcome = run({"three.toml", "-o", "out"});

  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("out/three.chart.2.3.png\n"));
  EXPECT_THAT(files(), UnorderedElementsAre("out", "out/three.h5", "out/three.chart.2.3.csv", "out/three.chart.2.3.dat",
                                            "out/three.chart.2.3.gp", "out/three.chart.2.3.png"));
  std::ifstream table(path() / "out/three.chart.2.3.csv");
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "curve,theta_in_deg,value,error");
  std::getline(table, line);
  EXPECT_THAT(line, StartsWith("\"Phong, n = 20\",0,1,"));
  std::getline(table, line);
  EXPECT_THAT(line, StartsWith("\"Phong, n = 20\",60,0."));
  EXPECT_EQ(run({"three.toml", "-o", "out"}).status, 3) << "files that exist are kept";
}

TEST_F(Run, ListsTheFilesItLeaves) {
  const auto outcome = run({"three.toml", "-o", "deep/out"});

  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("deep/out/three.h5\n"));
  EXPECT_THAT(outcome.output, HasSubstr("deep/out/three.daylight.distance.csv\n"));
  EXPECT_THAT(outcome.output, HasSubstr("deep/out/three.point.medoids.csv\n"));
  std::istringstream lines(outcome.output);
  for (std::string line; std::getline(lines, line) && !line.empty();) EXPECT_TRUE(fs::exists(path() / line)) << line;
}

TEST_F(Run, NamesTheMedoidsAfterTheFiles) {
  const auto outcome = run({"three.toml"});

  const std::string after = outcome.output.substr(outcome.output.find("\n\n") + 2);
  EXPECT_THAT(after, StartsWith("point: 2 clusters by silhouette, mean silhouette 0."));
  EXPECT_THAT(after, HasSubstr("; medoids: "));
  EXPECT_THAT(after, HasSubstr("\ndaylight: 2 clusters"));
  EXPECT_THAT(after, HasSubstr("\ndaylight: ranks pairs most as point does, Spearman "));
  EXPECT_EQ(std::ranges::count(after, '\n'), 4);
}

TEST_F(Run, TakesTheNumberOfClustersOfTheStudy) {
  std::string study = kStudy;
  study.replace(study.find("tolerance"), 0, "clusters = 3\nneighbours = 1\n");
  write("three.toml", study);

  const auto outcome = run({"three.toml", "--json"});

  const auto answer = nlohmann::ordered_json::parse(outcome.output);
  const auto& clusters = answer["lightings"][0]["clusters"];
  EXPECT_EQ(clusters["count"], 3);
  EXPECT_EQ(clusters["chosen_by"], "study");
  EXPECT_EQ(clusters["medoids"][2]["material"], "metal");
  EXPECT_EQ(clusters["medoids"][2]["materials"], 1);
}

TEST_F(Run, ReportsWhatElseTheStudyAsksFor) {
  std::string study = kStudy;
  study.replace(study.find("tolerance"), 0,
                "comparison_metrics = [\"low-log\"]\ncomparison_tolerance = 1e-2\napproximations = [\"linear\"]\n");
  write("three.toml", study);

  const auto outcome = run({"three.toml"});
  const auto forced = run({"three.toml", "--force", "--json"});

  EXPECT_EQ(outcome.status, 0) << outcome.error;
  for (const char* file : {"three.low-log.distance.csv", "three.low-log.distance.png", "three.agreement.csv",
                           "three.agreement.png", "three.daylight.linear-residuals.csv"}) {
    EXPECT_THAT(outcome.output, HasSubstr(std::string(file) + "\n"));
    EXPECT_GT(fs::file_size(path() / file), 0U) << file;
  }
  EXPECT_THAT(outcome.output, HasSubstr("\npoint: materials of other families best represented (linear) by "));
  EXPECT_THAT(outcome.output, HasSubstr("\nlow-log: ranks pairs most as "));
  const auto answer = nlohmann::ordered_json::parse(forced.output);
  EXPECT_EQ(answer["comparison_metrics"][0]["metric"], "low-log");
  EXPECT_EQ(answer["lightings"][1]["approximations"][0]["approximation"], "linear");
  std::size_t targets = answer["lightings"][1]["approximations"][0]["undecided"];
  for (const auto& family : answer["lightings"][1]["approximations"][0]["families"])
    targets += family["materials"].get<std::size_t>();
  EXPECT_EQ(targets, 3U);
  EXPECT_EQ(answer["agreement"].size(), 3U);
  EXPECT_EQ(answer["agreement"][2]["metric"], "low-log");
  EXPECT_EQ(answer["agreement"][2]["other"], "daylight");
  const double rho = answer["agreement"][2]["all_pairs"]["spearman"];
  EXPECT_LE(std::abs(rho), 1);
}

TEST_F(Run, WarnsAgainstThePatchToleranceInUse) {
  std::string study = kStudy;
  study.replace(study.find("lightings"), 0, "patch_tolerance = 0.02\n");
  study.replace(study.find("\"point\", \"daylight\""), 19, "\"patch:0.5\"");
  write("three.toml", study);

  const auto outcome = run({"three.toml"});

  // At 1e-4, the tolerance of the others, products would not be resolved.
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.error, Not(HasSubstr("reaches a relative error")));
}

TEST_F(Run, RefusesToReplaceATableOfAComparison) {
  std::string study = kStudy;
  study.replace(study.find("tolerance"), 0, "comparison_metrics = [\"low-log\"]\n");
  write("three.toml", study);
  write("three.low-log.distance.csv", "mine");

  const auto outcome = run({"three.toml"});

  expect_one_line(outcome, 3);
  EXPECT_THAT(outcome.error, HasSubstr("three.low-log.distance.csv exists"));
}

TEST_F(Run, NamesThePlaceOfAnUnknownComparisonMetric) {
  write("typo.toml",
        "[study]\ncomparison_metrics = [\"cube-rot\"]\n\n[[material]]\nname = \"m\"\nmodel = \"lambert\"\n");

  const auto outcome = run({"typo.toml"});

  expect_one_line(outcome, 2);
  EXPECT_THAT(outcome.error, HasSubstr("typo.toml:2:"));
  EXPECT_THAT(outcome.error, HasSubstr("did you mean 'cube-root'?"));
}

TEST_F(Run, SaysTheSameInJson) {
  const auto outcome = run({"three.toml", "--json", "--name", "other"});

  const auto answer = nlohmann::ordered_json::parse(outcome.output);
  EXPECT_EQ(answer.begin().key(), "schema");
  EXPECT_EQ(answer["schema"], "lobe.run/1");
  EXPECT_EQ(answer["materials"], 3);
  EXPECT_TRUE(fs::exists(path() / answer["files"]["table"].get<std::string>()));
  EXPECT_EQ(fs::path(answer["files"]["table"].get<std::string>()).filename(), "other.h5");
}

TEST_F(Run, ToldVerboselyPrintsWhereTheTimeGoes) {
  const auto outcome = run({"three.toml", "-v"});

  for (const char* part : {"share/%", "total", "Mevaluations/s"}) EXPECT_THAT(outcome.error, HasSubstr(part));
  EXPECT_THAT(outcome.output, Not(HasSubstr("share/%")));
}

TEST_F(Run, ShowsNoProgressOutsideATerminal) {
  EXPECT_THAT(run({"three.toml"}).error, Not(HasSubstr("\r")));
}

TEST_F(Run, ReplacesFilesOnlyByForce) {
  static_cast<void>(run({"three.toml"}));

  const auto refused = run({"three.toml"});
  const auto forced = run({"three.toml", "--force"});

  expect_one_line(refused, 3);
  EXPECT_THAT(refused.error, HasSubstr("three.h5 exists; use --force"));
  EXPECT_EQ(forced.status, 0);
}

TEST_F(Run, NamesThePlaceInAMalformedStudy) {
  write("broken.toml", "[study]\nname = \"x\nlightings = []\n");

  const auto outcome = run({"broken.toml"});

  expect_one_line(outcome, 2);
  EXPECT_THAT(outcome.error, HasSubstr("broken.toml:2:"));
}

TEST_F(Run, NamesThePlaceOfAnUnknownModelInAStudy) {
  write("typo.toml", "[study]\nname = \"x\"\n\n[[material]]\nname = \"m\"\nmodel = \"lambart\"\n");

  const auto outcome = run({"typo.toml"});

  expect_one_line(outcome, 2);
  EXPECT_THAT(outcome.error, HasSubstr("typo.toml:6:"));
  EXPECT_THAT(outcome.error, HasSubstr("did you mean 'lambert'?"));
}

TEST_F(Run, NamesThePlaceOfAGridThatIsTooCoarse) {
  write("sharp.toml",
        "[study]\nlightings = [\"daylight\"]\ngrid = \"gauss:8x16\"\n\n[[material]]\nname = \"sharp\"\nmodel = "
        "\"phong\"\n"
        "n = 10000\n");
  const auto outcome = run({"sharp.toml", "--strict"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.error, StartsWith("lobe: error: sharp.toml:3: grid gauss:8x16 does not resolve the lobe"));
  const auto warned = run({"sharp.toml"});
  EXPECT_EQ(warned.status, 0);
  EXPECT_THAT(warned.error, StartsWith("lobe: warning: grid gauss:8x16 does not resolve 'sharp'; errors are stated"));
}

TEST_F(Run, RefusesADirectoryThatCannotBeMade) {
  write("file", "");

  const auto outcome = run({"three.toml", "-o", "file/below"});

  expect_one_line(outcome, 3);
  EXPECT_THAT(files(), ::testing::ElementsAre("file"));
}

TEST_F(Run, RefusesAnUnwritableDirectoryBeforeItComputes) {
  const auto outcome = run({"three.toml", "-o", "/proc"});

  expect_one_line(outcome, 3);
  EXPECT_THAT(outcome.error, HasSubstr("cannot write into directory /proc"));
}

TEST_F(Run, LeavesNothingWithoutADevice) {
  const auto outcome = run({"three.toml", "-o", "new/out"}, {.environment = {{"OCL_ICD_VENDORS", "/nonexistent"}}});

  expect_one_line(outcome, 4);
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Run, LeavesNothingOnAFullDisk) {
  std::string many = kStudy;
  for (int n = 1; n <= 250; ++n) {
    many +=
        "[[material]]\nname = \"phong " + std::to_string(n) + "\"\nmodel = \"phong\"\nn = " + std::to_string(n) + "\n";
  }
  write("three.toml", many);

  // Enough for what the OpenCL runtime writes in order to build kernels, too little for the results.
  const auto outcome = run({"three.toml", "-o", "new/out"}, {.largest_file_bytes = 1'700'000});

  expect_one_line(outcome, 3);
  EXPECT_THAT(outcome.error, HasSubstr("three.h5: File too large"));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Run, StopsCleanlyOnCtrlC) {
  write("long.toml", std::string(kStudy) + "[[material]]\nname = \"sharp\"\nmodel = \"ward\"\nm = 0.001\n");
  const auto outcome =
      run({"long.toml", "-o", "new", "--tolerance", "1e-13"}, {.interrupt_after = std::chrono::milliseconds(400)});

  EXPECT_EQ(outcome.status, 130) << outcome.error;
  EXPECT_THAT(outcome.error, ::testing::StartsWith("lobe: interrupted; "));
  EXPECT_THAT(files(), ::testing::ElementsAre("long.toml"));
}

}  // namespace
}  // namespace lobe::test
