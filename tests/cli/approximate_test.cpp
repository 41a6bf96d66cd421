#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "core/files.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

const Words kMetal{"approximate", "cook_torrance:m=0.3", "-b", "lambert",          "-b", "metal_phong:n=5",
                   "-b",          "metal_phong:n=20",    "-b", "metal_phong:n=100"};
const std::string kClassical = std::string(LOBE_STUDIES_DIRECTORY) + "/classical-families.toml";

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Json run_approximate(const Words& words) {
  const auto outcome = run_lobe(with(words, {"--json"}));
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  return Json::parse(outcome.output);
}

TEST(Approximate, PrintsCoefficientsAndWhatIsLeft) {
  const auto outcome = run_lobe(with(kMetal, {"--non-negative"}));

  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("metal_phong:n=5"), HasSubstr("0.828829"), HasSubstr("relative residual"),
                                    HasSubstr("rank"), HasSubstr("4 of 4"), HasSubstr("condition"), HasSubstr("KKT")));
  EXPECT_THAT(outcome.error, IsEmpty());
}

TEST(Approximate, AnswersForEveryLightingInJson) {
  const Json json = run_approximate(with(kMetal, {"--lighting", "point", "--lighting", "daylight", "--non-negative"}));

  EXPECT_EQ(json["schema"], "lobe.approximate/1");
  ASSERT_EQ(json["answers"].size(), 2U);
  EXPECT_NEAR(json["answers"][0]["relative_residual"]["value"].get<double>(), 0.646176256, 2e-6);
  EXPECT_NEAR(json["answers"][1]["relative_residual"]["value"].get<double>(), 0.016092008, 1e-7);
  EXPECT_EQ(json["answers"][1]["fits"][0]["coefficients"][2]["at_zero"], true);
  EXPECT_THAT(json.dump(), Not(HasSubstr("null")));
}

TEST(Approximate, TakesTablesAndFilesAsBasis) {
  const TemporaryDirectory directory;
  const std::string table = (directory.path() / "table.h5").string();
  const std::string file = (directory.path() / "file.csv").string();
  ASSERT_EQ(run_lobe({"tabulate", "ward:m=0.5", "--grid", "gauss:24x48", "-o", table}).status, 0);
  ASSERT_EQ(run_lobe({"export", "ward:m=0.5", "--format", "csv", "-o", file}).status, 0);
  const Words target{"approximate", "lambert:scale=0.2+ward:m=0.5,scale=0.7", "-b", "lambert", "-b"};

  for (const std::string& basis : {table, file}) {
    SCOPED_TRACE(basis);
    const Json json = run_approximate(with(target, {basis}));
    const Json& coefficients = json["answers"][0]["fits"][0]["coefficients"];
    EXPECT_EQ(coefficients[1]["material"], basis);
    EXPECT_NEAR(coefficients[0]["value"].get<double>(), 0.2, coefficients[0]["error"].get<double>()) << basis;
    EXPECT_NEAR(coefficients[1]["value"].get<double>(), 0.7, coefficients[1]["error"].get<double>()) << basis;
    EXPECT_FALSE(json["answers"][0].contains("material"));
  }
  const auto refused = run_lobe(with(target, {table, "-o", (directory.path() / "sum.toml").string()}));
  EXPECT_NE(refused.status, 0);
  EXPECT_THAT(refused.error, HasSubstr("lobe mix"));
}

TEST(Approximate, HasATolerancePerRoute) {
  const auto directory = TemporaryDirectory();
  const std::string rows = directory.path() / "rows.csv";
  ASSERT_EQ(run_lobe({"export", "phong:n=5", "--format", "csv", "-o", rows}).status, 0);
  const auto tolerance_of = [](const std::string& target, const Words& more) {
    return run_approximate(with({"approximate", target, "-b", "lambert"}, more))["answers"][0]["tolerance"];
  };

  EXPECT_EQ(tolerance_of("phong:n=5", {}), 1e-6);
  EXPECT_EQ(tolerance_of("phong:n=5", {"--lighting", "patch:0.5"}), 1e-5);
  EXPECT_EQ(tolerance_of(rows, {}), 5e-3);
  for (const std::string& target : {std::string("phong:n=5"), rows}) {
    EXPECT_EQ(tolerance_of(target, {"--tolerance", "0.02"}), 0.02) << target;
  }
  EXPECT_EQ(tolerance_of("phong:n=5", {"--lighting", "patch:0.5", "--tolerance", "0.02"}), 0.02);
}

TEST(Approximate, LeavesAMaterialThatEveryCommandReads) {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "fit.toml").string();

  const Json json = run_approximate(with(kMetal, {"--non-negative", "-o", path}));

  EXPECT_THAT(read_text(path), StartsWith("# lobe approximate cook_torrance:m=0.3"));
  const auto distance = run_lobe({"distance", path, "cook_torrance:m=0.3", "--json"});
  EXPECT_EQ(distance.status, 0) << distance.error;
  // The same materials, lobes and nodes: the same bits.
  EXPECT_EQ(Json::parse(distance.output)["distance"], json["answers"][0]["residual"]);
  const auto value = run_lobe({"eval", path, "--theta-in", "30", "--theta-out", "30", "--delta-phi", "180"});
  EXPECT_EQ(value.status, 0) << value.error;
}

TEST(Approximate, WritesAFilePerLighting) {
  const TemporaryDirectory directory;

  const auto outcome = run_lobe({"approximate", "ward:m=0.3", "-b", "lambert", "--lighting", "point", "--lighting",
                                 "daylight", "-o", (directory.path() / "fit.toml").string()});

  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_TRUE(fs::exists(directory.path() / "fit.point.toml"));
  EXPECT_TRUE(fs::exists(directory.path() / "fit.daylight.toml"));
}

TEST(Approximate, KeepsFilesThatExist) {
  const TemporaryDirectory directory;
  const std::string path = (directory.path() / "fit.toml").string();
  const Words words{"approximate", "ward:m=0.3", "-b", "lambert", "-o", path};
  EXPECT_EQ(run_lobe(words).status, 0);

  const auto again = run_lobe(words);

  EXPECT_EQ(again.status, 3);
  EXPECT_THAT(again.error, HasSubstr("exists; use --force"));
  EXPECT_EQ(run_lobe(with(words, {"--force"})).status, 0);
}

TEST(Approximate, DrawsTargetApproximationAndRest) {
  const TemporaryDirectory directory;

  const Json json = run_approximate({"approximate", "ward:m=0.3", "-b", "lambert", "-b", "phong:n=10", "--plot",
                                     (directory.path() / "plots").string()});

  std::vector<std::string> names;
  for (const auto& picture : json["answers"][0]["pictures"]) {
    const fs::path path(picture.get<std::string>());
    EXPECT_GT(fs::file_size(path), 10000U) << path;
    names.push_back(path.filename().string());
  }
  EXPECT_THAT(names, ElementsAre("approximation.point.slices.png", "approximation.point.albedo.png"));
}

TEST(Approximate, ChoosesFromAFamilyOfAStudy) {
  const Json json = run_approximate({"approximate", "ward:m=0.25", "-b", kClassical + "#Phong", "--greedy", "2"});

  const Json& answer = json["answers"][0];
  ASSERT_EQ(answer["steps"].size(), 2U);
  EXPECT_EQ(answer["fits"][0]["coefficients"].size(), 2U);
  EXPECT_EQ(answer["fits"][0]["coefficients"][0]["material"], answer["steps"][0]["material"]);
  EXPECT_LT(answer["steps"][1]["residual"]["value"], answer["steps"][0]["residual"]["value"]);
  EXPECT_GT(json["basis"].size(), 2U);
}

TEST(Approximate, TakesAWholeStudyAsBasis) {
  const Json json = run_approximate({"approximate", "ward:m=0.25", "-b", kClassical + "#", "--greedy", "1"});

  EXPECT_EQ(json["basis"].size(), 64U);
}

TEST(Approximate, StatesTheEnergy) {
  const Json json = run_approximate({"approximate", "ward:m=0.3,scale=3", "-b", "phong:n=20", "--energy"});

  EXPECT_EQ(json["answers"][0]["fits"][0]["at_energy_bound"], true);
  EXPECT_NEAR(json["answers"][0]["fits"][0]["energy"].get<double>(), 1, 1e-9);
}

struct Refused {
  std::string name;
  Words arguments;
  int status = 2;
  std::string message;
};

class ApproximateRefuses : public ::testing::TestWithParam<Refused> {};

TEST_P(ApproximateRefuses, InOneLine) {
  const auto outcome = run_lobe(with({"approximate"}, GetParam().arguments));

  EXPECT_EQ(outcome.status, GetParam().status) << outcome.error;
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_THAT(outcome.error, AllOf(StartsWith("lobe: error: "), HasSubstr(GetParam().message), HasSubstr("; ")));
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1);
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, ApproximateRefuses,
    ::testing::Values(
        Refused{"no_basis", {"lambert"}, 2, "needs --basis"},
        Refused{"dependent", {"ward:m=0.3", "-b", "lambert", "-b", "lambert:scale=0.5"}, 5, "'lambert:scale=0.5'"},
        Refused{"unknown_family", {"lambert", "-b", kClassical + "#Fong"}, 2, "did you mean 'Phong'?"},
        Refused{"missing_study", {"lambert", "-b", "absent.toml#Phong"}, 3, "cannot read absent.toml"},
        Refused{"unknown_lighting", {"lambert", "-b", "lambert", "--lighting", "pont"}, 2, "did you mean 'point'?"},
        Refused{"lighting_twice",
                {"lambert", "-b", "lambert", "--lighting", "point", "--lighting", "point"},
                2,
                "--lighting point is given twice"},
        Refused{"greedy_nothing", {"lambert", "-b", "lambert", "--greedy", "0"}, 2, "--greedy 0 is out of range"},
        Refused{"output_of_another_kind", {"lambert", "-b", "lambert", "-o", "x.h5"}, 2, "expected FILE.toml"},
        Refused{"black_target", {"lambert:scale=0", "-b", "lambert"}, 5, "norm 0"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace lobe::test
