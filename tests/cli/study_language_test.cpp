// Values set from outside a study, and the origins that its results state.
#include <fstream>
#include <sstream>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A study of two files.
class StudyLanguage : public CommandTest {
 protected:
  StudyLanguage() {
    std::filesystem::create_directory(file("families"));
    write("families/gloss.toml",
          "[study]\ntolerance = 1e-3\n[[family]]\nname = \"Phong\"\nmodel = \"phong\"\nn = [1, 5]\n");
    write(
        "main.toml",
        "include = [\"families/gloss.toml\"]\n[study]\nlightings = [\"daylight\"]\ncomparison_metrics = [\"low-l2\"]\n"
        "[[material]]\nname = \"matt\"\nmodel = \"lambert\"\n[[published]]\ntitle = \"T\"\nquantity = \"albedo\"\n"
        "theta = 0\nmodel = \"lambert\"\nlabel = \"white\"\nprinted = \"1.00\"\n[[chart]]\nname = \"c\"\n"
        "quantity = \"albedo\"\nx = [0, 60]\ncurves = [{label = \"w\", model = \"lambert\"}]\n");
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(file(name)).rdbuf();
    return text.str();
  }
};

TEST_F(StudyLanguage, IsInTheResultsAndRepeatsThem) {
  const Words words{"run",   "main.toml", "-o", "out", "--set", "family.Phong.n=[2, 3]", "--set=study.name=named",
                    "--json"};
  const auto outcome = run(words);
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const Json answer = Json::parse(outcome.output);
  EXPECT_EQ(answer.at("tolerance"), 1e-3);
  EXPECT_EQ(answer.at("lightings").at(0).at("origin"), "main.toml:3");
  EXPECT_EQ(answer.at("comparison_metrics").at(0).at("origin"), "main.toml:4");
  EXPECT_EQ(answer.at("published").at(0).at("origin"), "main.toml:8");
  EXPECT_EQ(answer.at("origins").at("charts").at(0).at("origin"), "main.toml:15");
  EXPECT_EQ(answer.at("origins").at("materials").at(1),
            Json({{"material", "Phong n=3"}, {"origin", "families/gloss.toml:3 (n=3), --set family.Phong.n"}}));
  EXPECT_THAT(read("out/named.published.csv"), HasSubstr(",yes,yes,main.toml:8\n"));

  const Json info = json({"info", "out/named.h5"});
  EXPECT_EQ(info.at("materials").at(0), Json({{"material", "Phong n=2"},
                                              {"origin", "families/gloss.toml:3 (n=2), --set family.Phong.n"},
                                              {"family", "Phong"}}));
  EXPECT_EQ(info.at("metrics").at(1), Json({{"metric", "low-l2"}, {"origin", "main.toml:4"}}));
  EXPECT_EQ(info.at("published").at(0), Json({{"figure", "T, white"}, {"origin", "main.toml:8"}}));
  EXPECT_EQ(info.at("charts").at(0), Json({{"chart", "c"}, {"origin", "main.toml:15"}}));
  EXPECT_EQ(info.at("provenance").at("set"), Json({"family.Phong.n=[2, 3]", "study.name=named"}));
  ASSERT_EQ(info.at("files").size(), 2U);
  EXPECT_EQ(info.at("files").at(0).at("text"), read("main.toml"));
  EXPECT_EQ(info.at("files").at(1).at("name"), "families/gloss.toml");
  const std::string text = make({"info", "out/named.h5"}).output;
  EXPECT_THAT(text, HasSubstr("\nset from outside  family.Phong.n=[2, 3]\n"));
  EXPECT_THAT(text, HasSubstr("\nmatt       main.toml:5\n"));

  expect_refusal({"run", "out/named.h5"}, ExitCode::usage, "which 'lobe info out/named.h5 --study' prints");

  // From the result alone, elsewhere.
  std::filesystem::create_directory(file("elsewhere"));
  write("elsewhere/again.toml", make({"info", "out/named.h5", "--study"}).output);
  const auto again = run({"run", "elsewhere/again.toml", "-o", "elsewhere"});
  ASSERT_EQ(again.status, 0) << again.error;
  for (const char* table : {"named.daylight.distance.csv", "named.low-l2.distance.csv", "named.chart.c.csv"}) {
    EXPECT_EQ(read(std::string("elsewhere/") + table), read(std::string("out/") + table)) << table;
    EXPECT_FALSE(read(std::string("out/") + table).empty()) << table;
  }
}

TEST_F(StudyLanguage, IsTakenByCommandsOnTheMaterialsOfAStudy) {
  const Json answer = json({"gram", "main.toml", "--set", "family.Phong.n=[2, 3, 4]", "--tolerance", "1e-2"});
  ASSERT_EQ(answer.at("materials").size(), 4U);
  EXPECT_THAT(answer.at("materials").at(2).dump(), HasSubstr("Phong n=4"));
  EXPECT_EQ(json({"gram", "main.toml#Phong", "main.toml#Lambert", "--set", "family.Phong.n=2"}).at("materials").size(),
            2U);
  expect_refusal({"gram", "main.toml", "families/gloss.toml", "--set", "family.Phong.n=2"}, ExitCode::usage,
                 "--set family.Phong.n=2 changes a study file, and 2 are given; expected one");
  expect_refusal({"gram", "lambert", "--set", "family.Phong.n=2"}, ExitCode::usage,
                 "--set family.Phong.n=2 changes a study file, and none are given; expected one");
}

TEST_F(StudyLanguage, ComplainsInOneLineAndLeavesNothing) {
  const auto refuse = [&](const Words& set, const std::string& message) {
    Words words{"run", "main.toml", "-o", "out"};
    words.insert(words.end(), set.begin(), set.end());
    expect_refusal(words, ExitCode::usage, message);
    EXPECT_FALSE(std::filesystem::exists(file("out")));
  };
  refuse({"--set", "family.Phnog.n=2"},
         "--set family.Phnog.n=2: there is no [[family]] 'Phnog' in main.toml; did you mean 'Phong'?");
  refuse({"--set", "family.Phong.n=-1"}, "--set family.Phong.n=-1: parameter 'n' of model 'phong' is -1; expected");
  refuse({"--set"}, "option --set needs a value");
  write("families/gloss.toml", "[[family]]\nname = \"Phong\"\nmodel = \"phong\"\nn = [1, \"5\"]\n");
  refuse({}, "families/gloss.toml:4:9: an entry of 'n' is a text; expected a number");
  expect_refusal({"info", "main.toml", "--study"}, ExitCode::usage, "'main.toml' is a text of materials or of a study");
}

}  // namespace
}  // namespace lobe::test
