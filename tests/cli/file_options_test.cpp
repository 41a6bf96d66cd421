// Options for reading files, wherever they stand: in brackets behind its name, by options, in studies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class FileOptions : public CommandTest {
 protected:
  /// Red rises from 0.1 at the normal to 0.2 at 60 and 0.5 at 90 degrees of the viewer, linearly; green and blue are
  /// 0.2 and 0.1.
  void SetUp() override {
    std::ofstream csv(file("paint.csv"));
    csv << "theta_in_deg,theta_out_deg,delta_phi_deg,red,green,blue\n";
    for (const auto* in : {"0", "90"}) {
      for (const auto* row : {"0,0,0.1", "60,0,0.2", "90,0,0.5"}) csv << in << ',' << row << ",0.2,0.1\n";
    }
  }

  [[nodiscard]] std::vector<double> at(const Words& material, const std::string& theta_out) const {
    Words words{"eval", "--theta-in", "30", "--theta-out", theta_out, "--delta-phi", "0"};
    words.insert(words.end(), material.begin(), material.end());
    return json(words)["values"][0]["brdf"].get<std::vector<double>>();
  }
};

TEST_F(FileOptions, StandInBracketsBehindItsName) {
  EXPECT_THAT(at({"paint.csv"}, "75"), ElementsAre(::testing::DoubleNear(0.35, 1e-12), 0.2, 0.1));
  EXPECT_THAT(at({"paint.csv[channels=green]"}, "75"), ElementsAre(0.2));
  EXPECT_THAT(at({"paint.csv[theta_max=60,channels=1,blue]"}, "75"),
              ElementsAre(::testing::DoubleNear(0.2, 1e-12), 0.1));
  EXPECT_NEAR(at({"paint.csv[luminance=rec709]"}, "0").at(0), 0.2126 * 0.1 + 0.7152 * 0.2 + 0.0722 * 0.1, 1e-12);
}

TEST_F(FileOptions, AreThoseOfTheCommandForAllItsFiles) {
  EXPECT_THAT(at({"paint.csv", "--channels", "green"}, "75"), ElementsAre(0.2));
  EXPECT_THAT(at({"paint.csv", "--channels", "red", "--theta-max", "60"}, "75"),
              ElementsAre(::testing::DoubleNear(0.2, 1e-12)));
  EXPECT_THAT(at({"paint.csv[channels=blue]", "--channels", "red"}, "75"), ElementsAre(0.1));
  const Json found = json({"distance", "paint.csv", "lambert:scale=0.3", "--channels", "green"});
  EXPECT_EQ(found["a"]["channel_names"], Json::parse(R"(["green"])"));
  expect_refusal({"norm", "lambert", "--luminance", "rec709"}, ExitCode::usage,
                 "--luminance is an option of files, and none is given");
  expect_refusal({"norm", "paint.csv", "--channels", "purple"}, ExitCode::usage, "has no channel 'purple'");
}

TEST_F(FileOptions, HoldInEveryCommand) {
  const std::string green = "paint.csv[channels=green]";
  // A Lambertian surface of albedo 0.2 pi.
  const double albedo = 0.62831853;
  EXPECT_NEAR(json({"albedo", green, "--theta", "20"})["albedos"][0]["albedo"][0]["value"].get<double>(), albedo, 1e-4);
  EXPECT_NEAR(json({"mean-albedo", green})["materials"][0]["mean_albedo"][0]["value"].get<double>(), albedo, 1e-4);
  EXPECT_NEAR(json({"distance", green, "paint.csv[channels=blue]"})["distance"]["value"].get<double>(),
              0.1 * 3.14159265, 1e-4);
  EXPECT_EQ(json({"info", green, "--header-only"})["channel_names"], Json::parse(R"(["green"])"));
  EXPECT_EQ(json({"info", "paint.csv", "--channels", "2", "--header-only"})["channel_names"],
            Json::parse(R"(["green"])"));
  make({"import", green, "--grid", "gauss:4x8", "-o", "green.h5"});
  make({"transpose", "paint.csv", "--channels", "green", "-o", "again.h5"});
  EXPECT_NEAR(json({"mean-albedo", "again.h5"})["materials"][0]["mean_albedo"][0]["value"].get<double>(), albedo, 1e-4);
  make({"export", green, "--format", "csv", "-o", "green.csv"});
  const auto sampled = make({"sample", green, "--theta", "30", "-n", "3"});
  EXPECT_THAT(sampled.output, HasSubstr("weight "));
}

TEST_F(FileOptions, ChooseChannelsOfTables) {
  make({"import", "paint.csv", "--grid", "gauss:4x8", "-o", "paint.h5"});
  EXPECT_THAT(at({"paint.h5[channels=blue,2]"}, "30"),
              ElementsAre(::testing::DoubleNear(0.1, 1e-12), ::testing::DoubleNear(0.2, 1e-12)));
  EXPECT_NEAR(at({"paint.h5[luminance=rec709]"}, "30").at(0), 0.2126 * at({"paint.h5"}, "30").at(0) + 0.15026, 1e-9);
  expect_refusal({"norm", "paint.h5[theta_max=80]"}, ExitCode::usage, "is a table; expected no choice but that of");
}

TEST_F(FileOptions, ThatAreMistakenAreShownInTheirPlace) {
  expect_refusal({"norm", "paint.csv[chanels=1]"}, ExitCode::usage,
                 "'paint.csv[chanels=1]', character 11: unknown option 'chanels' of a file; did you mean 'channels'?");
  expect_refusal({"norm", "lambert[theta_max=80]"}, ExitCode::usage, "'lambert' in 'lambert[theta_max=80]' is no file");
  expect_refusal({"norm", "none.csv[theta_max=80]"}, ExitCode::file, "there is no such file");
  make({"fit", "lambert", "--family", "lambert", "-o", "grey.toml"});
  expect_refusal({"norm", "grey.toml[theta_max=80]"}, ExitCode::usage, "is a material file; expected no options");
}

TEST_F(FileOptions, AreFollowedByAdjustmentsOfMaterialFiles) {
  std::ofstream(file("gloss.toml")) << "name = \"gloss\"\nmodel = \"lambert\"\nscale = 0.5\n";
  const auto mean = [&](const std::string& text) { return json({"mean-albedo", text})["materials"][0]; };
  const Json found = mean("gloss.toml@normalise");
  EXPECT_EQ(found["name"], "gloss@normalise");
  EXPECT_EQ(found["mean_albedo"], mean("lambert:scale=0.5@normalise")["mean_albedo"]);
  EXPECT_NE(found["mean_albedo"], mean("gloss.toml")["mean_albedo"]);
  std::ofstream(file("study.toml")) << "[study]\nlightings = [\"material:gloss.toml@normalise\"]\n"
                                       "[[material]]\nname = \"grey\"\nmodel = \"lambert\"\n";
  // Of the pattern 1 / pi, that of gloss.toml alone makes a quarter; rounding adds less.
  EXPECT_NEAR(json({"gram", "study.toml"}).at("lightings").at(0).at("gram").at(0).at(0).get<double>(), 1, 1e-9);
  expect_refusal({"norm", "gloss.toml@normalize"}, ExitCode::usage, "did you mean 'normalise'?");
  expect_refusal({"norm", "none.toml@normalise"}, ExitCode::file, "cannot read none.toml: No such file");
  expect_refusal({"norm", "paint.csv@normalise"}, ExitCode::usage, "'@normalise' behind paint.csv adjusts a formula");
  for (const auto* text : {"gloss.toml", "gloss.toml@normalise"}) {
    expect_refusal({"info", text}, ExitCode::usage,
                   "'gloss.toml' is a text of materials or of a study, which holds no values");
  }
  expect_refusal({"info", "paint.csv@normalise"}, ExitCode::usage, "'@normalise' behind paint.csv adjusts a formula");
}

TEST_F(FileOptions, AreOfFilesThatAreNoTerms) {
  std::filesystem::copy_file(file("paint.csv"), file("a+paint.csv"));
  EXPECT_THAT(at({"a+paint.csv[channels=green]"}, "60"), ElementsAre(0.2));
  const std::string advice = ": sums and factors are those of formulas, and paint.csv is a file; 'lobe mix' adds files";
  expect_refusal({"norm", "paint.csv+lambert"}, ExitCode::usage, "'paint.csv+lambert', character 10" + advice);
  expect_refusal({"norm", "paint.csv[channels=red]+lambert"}, ExitCode::usage, "character 24" + advice);
  expect_refusal({"norm", "lambert + paint.csv"}, ExitCode::usage, "character 9" + advice);
  expect_refusal({"albedo", "paint.csv*cos_max", "--theta", "0"}, ExitCode::usage, "character 10" + advice);
  expect_refusal({"norm", "ggx:alpha=0.8@kulla_conty+lambert"}, ExitCode::usage,
                 "adjustment 'kulla_conty' is followed by '+'; adjustments come last");
  expect_refusal({"tabulate", "paint.csv", "-o", "t.h5"}, ExitCode::usage,
                 "'paint.csv' is a measured file; 'lobe import' makes a table of it");
}

TEST_F(FileOptions, LeaveAFileOfTheWholeNameAlone) {
  std::filesystem::copy_file(file("paint.csv"), file("b[channels=red].csv[channels=blue]"));
  EXPECT_THAT(at({"b[channels=red].csv[channels=blue]"}, "60"),
              ElementsAre(::testing::DoubleNear(0.2, 1e-12), 0.2, 0.1));
  EXPECT_THAT(at({"b[channels=red].csv[channels=blue][channels=green]"}, "60"), ElementsAre(0.2));
}

TEST_F(FileOptions, ArePartOfWhatAStudySaysOfItsFiles) {
  make({"import", "paint.csv", "--grid", "gauss:4x8", "-o", "paint.h5"});
  std::ofstream(file("study.toml")) << "[study]\nlightings = [\"daylight\", \"mean-albedo\"]\n"
                                       "[[measured]]\nname = \"green paint\"\nfile = \"paint.csv\"\nchannels = [2]\n"
                                       "[[measured]]\nname = \"blue paint\"\nfile = \"paint.csv[channels=blue]\"\n"
                                       "[[measured]]\nname = \"table\"\nfile = \"paint.h5\"\nchannels = [\"green\"]\n";
  const Json found = json({"distance-matrix", "study.toml"});
  EXPECT_EQ(found["materials"][0]["name"], "green paint");
  EXPECT_EQ(found["materials"][1]["name"], "blue paint");
  EXPECT_EQ(found["materials"][2]["name"], "table");
  // The study's lightings, unless others are given.
  ASSERT_EQ(found["lightings"].size(), 2U);
  EXPECT_EQ(found["lightings"][0]["lighting"], "daylight");
  EXPECT_EQ(found["lightings"][1]["lighting"], "mean-albedo");
  EXPECT_NEAR(found["lightings"][0]["distance"][0][1].get<double>(), 0.1 * std::pow(std::numbers::pi, 1.5), 1e-3);
  EXPECT_NEAR(found["lightings"][0]["distance"][0][2].get<double>(), 0, 1e-3);
  EXPECT_EQ(json({"distance-matrix", "study.toml", "--lighting", "point"})["lightings"].size(), 1U);
}

TEST_F(FileOptions, NameTheColumnsOfValues) {
  const Words where{"--theta-in", "0", "--theta-out", "0", "--delta-phi", "0"};
  const auto heading = [&](const std::string& material) {
    Words words{"eval", material};
    words.insert(words.end(), where.begin(), where.end());
    const std::string text = make(words).output;
    return text.substr(0, text.find('\n'));
  };
  EXPECT_THAT(heading("paint.csv"), HasSubstr("red/sr^-1"));
  EXPECT_THAT(heading("paint.csv[channels=blue,red]"), ::testing::ContainsRegex("blue/sr.-1 +red/sr.-1"));
  EXPECT_THAT(heading("paint.csv[channels=blue]"), HasSubstr("brdf/sr^-1"));
  EXPECT_THAT(heading("lambert:scale=0.1/0.2"), ::testing::ContainsRegex("brdf_1/sr.-1 +brdf_2/sr.-1"));
}

TEST_F(FileOptions, AreToldByHelpAndCompletion) {
  EXPECT_THAT(make({"albedo", "--help"}).output, HasSubstr("FILE[theta_max=80,luminance=rec709]"));
  EXPECT_THAT(make({"help", "files"}).output, HasSubstr("theta_max=DEGREES"));
  EXPECT_THAT(make({"models", "--help"}).output, Not(HasSubstr("--luminance")));
  EXPECT_THAT(make({"__complete", "norm", "paint.csv[theta_max=80,ch"}).output,
              HasSubstr("paint.csv[theta_max=80,channels="));
}

// Values at lists of pairs of directions.

TEST_F(FileOptions, HoldForListsOfPairsOfDirections) {
  std::ofstream(file("pairs.csv")) << "theta_in,theta_out,delta_phi\n30,0,0\n30,75,10\n";
  EXPECT_EQ(make({"eval", "paint.csv[theta_max=60,channels=green,blue]", "--pairs", "pairs.csv"}).output,
            "theta_in_deg,theta_out_deg,delta_phi_deg,green,blue\n30,0,0,0.2,0.1\n30,75,10,0.2,0.1\n");
}

TEST_F(FileOptions, LeaveListsOfPairsTheSameInFilesAsOneByOne) {
  std::ofstream(file("pairs.csv")) << "30,20,180,\n30,40,180\n";
  expect_refusal({"eval", "lambert", "--pairs", "pairs.csv"}, ExitCode::file,
                 "pairs.csv: line 1: '' in column phi_out_deg is no finite number");
  std::ofstream(file("pairs.csv")) << "30,20,180\n30,40,180\n";
  for (const auto* material : {"ward:m=0.2", "paint.h5", "ward_anisotropic:m_x=0.1,m_y=0.3"}) {
    const bool is_file = std::string(material) == "paint.h5";
    if (is_file) make({"import", "paint.csv", "--grid", "gauss:8x16", "-o", "paint.h5"});
    const double share = is_file ? 0 : 1e-14;  // nodes of formulas are made several at a time
    const Json one = json({"eval", material, "--theta-in", "30", "--theta-out", "20,40", "--delta-phi", "180"});
    std::istringstream rows(make({"eval", material, "--pairs", "pairs.csv"}).output);
    std::string row;
    std::getline(rows, row);
    for (const Json& expected : one["values"]) {
      std::getline(rows, row);
      std::istringstream cells(row);
      std::string cell;
      for (int i = 0; i < 3; ++i) std::getline(cells, cell, ',');
      for (const auto* kind : {"brdf", "brdf_error"}) {
        if (!expected.contains(kind)) continue;
        for (const Json& number : expected[kind]) {
          std::getline(cells, cell, ',');
          const double alone = number.get<double>();
          EXPECT_NEAR(std::stod(cell), alone, share * std::abs(alone)) << material << " " << kind;
        }
      }
      EXPECT_FALSE(std::getline(cells, cell, ',')) << material;
    }
  }
}

TEST_F(FileOptions, OfListsOfPairsAreRefusedBesideOthers) {
  std::ofstream(file("pairs.csv")) << "30,20,180\n";
  expect_refusal({"eval", "lambert"}, ExitCode::usage, "needs --theta-in, or all directions by --pairs");
  expect_refusal({"eval", "lambert", "--pairs", "pairs.csv", "--theta-in", "3"}, ExitCode::usage, "choose one");
  expect_refusal({"eval", "lambert", "--theta-in", "1", "--theta-out", "1", "--delta-phi", "1", "-o", "x.csv"},
                 ExitCode::usage, "--output belongs to --pairs");
  expect_refusal({"eval", "lambert", "--pairs", "pairs.csv", "--json"}, ExitCode::usage, "give a file by --output");
  expect_refusal({"eval", "lambert", "--pairs", "pairs.csv", "-o", "x.txt"}, ExitCode::usage, "FILE.npy or FILE.h5");
  expect_refusal({"eval", "lambert", "--pairs", "none.csv"}, ExitCode::file, "none.csv");
  const Json written = json({"eval", "lambert", "--pairs", "pairs.csv", "-o", "x.npy"});
  EXPECT_EQ(written["pairs"], 1);
  EXPECT_EQ(written["values"], Json::parse(R"(["brdf"])"));
  expect_refusal({"eval", "lambert", "--pairs", "pairs.csv", "-o", "x.npy"}, ExitCode::file, "exists");
}

}  // namespace
}  // namespace lobe::test
