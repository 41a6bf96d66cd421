// lobe lut: tables for renderers, and what it says of somebody else's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class LookupTables : public CommandTest {};

const Words kGgx{"lut", "ggx:alpha=0.5,f0=1", "--axis", "alpha:count=3,from=0.1", "--axis", "cos_theta:count=4"};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(LookupTables, AreWrittenWithTheirErrors) {
  const Json answer = json(with(kGgx, {"-o", "e.h"}));
  EXPECT_EQ(answer["schema"], "lobe.lut/1");
  EXPECT_EQ(answer["columns"], Json::array({"albedo"}));
  EXPECT_EQ(answer["axes"][0]["from"], 0.1);
  EXPECT_LT(answer["errors"]["entries"]["largest"], 2e-6);
  EXPECT_GT(answer["errors"]["between"]["largest"], 1e-3);
  std::ifstream file(this->file("e.h"));
  std::ostringstream content;
  content << file.rdbuf();
  EXPECT_THAT(content.str(), HasSubstr("static const float e[3][4] = {{"));
  EXPECT_THAT(content.str(), HasSubstr("// made by lobe "));
}

TEST_F(LookupTables, OfSomebodyElseAreHeldAgainstTheTruth) {
  make(with(kGgx, {"-o", "e.csv"}));
  const Json good = json(with(kGgx, {"--compare", "e.csv"}));
  EXPECT_LT(good["errors"]["entries"]["largest"], 2e-6);
  std::ofstream(file("wrong.csv")) << "0.9,0.9,0.9,0.9\n0.9,0.9,0.9,0.9\n0.9,0.9,0.9,0.9\n";
  const auto outcome = make(with(kGgx, {"--compare", "wrong.csv"}));
  EXPECT_THAT(outcome.output, HasSubstr("0.9 instead of 0."));
  EXPECT_THAT(outcome.error, IsEmpty());
}

TEST_F(LookupTables, AreCheckedInEveryFormatThatIsWritten) {
  for (const char* name : {"e.h5", "e.exr", "e.ktx2", "e.png", "e.h", "e.glsl", "e.npy"}) {
    const Json made = json(with(kGgx, {"-o", name}));
    const Json checked = json(with(kGgx, {"--compare", name}));
    EXPECT_EQ(made["errors"], checked["errors"]) << name;
  }
}

TEST_F(LookupTables, AreDescribedAsTheirFilesDescribeThem) {
  const auto outcome = make(with(kGgx, {"-o", "e.h"}));
  std::ifstream file(this->file("e.h"));
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "// directional albedo of ggx:alpha=0.5,f0=1");
  EXPECT_THAT(outcome.output, HasSubstr("quantity          directional albedo of ggx:alpha=0.5,f0=1\n"));
  EXPECT_THAT(outcome.output, HasSubstr("axis              cos_theta from 0 to 1, 4 cell centres\n"));
  make(with(kGgx, {"-o", "e.h5"}));
  const Json described = json({"info", "e.h5"});
  EXPECT_EQ(described["attributes"]["material"], "ggx:alpha=0.5,f0=1");
  EXPECT_EQ(described["datasets"][1]["name"], "cos_theta");
  EXPECT_EQ(described["datasets"][1]["shape"], Json::array({4}));
}

const Words kTerms{"lut",     "ggx:alpha=0.5,f0=1",
                   "--axis",  "alpha:count=5,from=0.1,map=sqrt",
                   "--axis",  "cos_theta:count=6,entries=nodes",
                   "--split", "f0"};

TEST_F(LookupTables, AreFittedByFunctions) {
  const Json answer = json(with(kTerms, {"--fit", "rational:1,2/1", "-o", "dfg.h"}));
  EXPECT_EQ(answer["schema"], "lobe.lut/1");
  EXPECT_EQ(answer["fit"]["form"], "rational:1,2/1");
  EXPECT_EQ(answer["fit"]["size"], 8);
  ASSERT_EQ(answer["fit"]["columns"].size(), 2U);
  for (const Json& column : answer["fit"]["columns"]) {
    EXPECT_EQ(column["numerator"].size(), 6U) << column["column"];
    EXPECT_EQ(column["denominator"].size(), 3U) << column["column"];
    const double largest = column["errors"]["entries"]["largest"];
    EXPECT_LE(column["bound"].get<double>(), largest) << column["column"];
    EXPECT_GT(column["bound"].get<double>(), 0.99 * largest) << column["column"];
    EXPECT_GE(column["errors"]["between"]["largest"].get<double>(), largest) << column["column"];
  }
  std::ifstream file(this->file("dfg.h"));
  std::ostringstream content;
  content << file.rdbuf();
  EXPECT_THAT(content.str(), HasSubstr("static inline float dfg_scale(float sqrt_alpha, float cos_theta) {"));
  EXPECT_THAT(content.str(), HasSubstr("// made by lobe "));
  const auto outcome = make(with(kTerms, {"--fit", "polynomial:2", "-o", "dfg.py", "--name", "terms"}));
  EXPECT_THAT(outcome.output, HasSubstr("fit          polynomial in sqrt(alpha) and cos_theta, of total degree 2: 6 "
                                        "coefficients\n"));
  EXPECT_THAT(outcome.output, HasSubstr("none of this form is below 0."));
  std::ifstream python(this->file("dfg.py"));
  std::ostringstream functions;
  functions << python.rdbuf();
  EXPECT_THAT(functions.str(), HasSubstr("def terms_bias(sqrt_alpha, cos_theta):"));
}

TEST_F(LookupTables, GradePublishedFits) {
  const Json answer = json(with(kTerms, {"--fit", "materialx"}));
  EXPECT_FALSE(answer["fit"].contains("form"));
  EXPECT_LT(answer["fit"]["columns"][0]["errors"]["entries"]["largest"], 0.06);
  EXPECT_THAT(make(with(kTerms, {"--fit", "karis"})).output, HasSubstr("fit          Karis 2014 (EnvBRDFApprox"));
}

TEST_F(LookupTables, FitsAreRefusedInOneLine) {
  const auto refused = [&](const Words& more, const std::string& complaint) {
    expect_refusal(with(kTerms, more), ExitCode::usage, complaint);
  };
  refused({"--fit", "spline"},
          "--fit takes no 'spline'; expected polynomial:DEGREES, rational:DEGREES/DEGREES, lazarov");
  refused({"--fit", "spline:3"}, "'spline:3' is no form of a fit");
  refused({"--fit", "polynomial:1,1,1"}, "has 3 degrees for 2 axes");
  refused({"--fit", "polynomial:8"}, "has 45 coefficients for 30 entries");
  refused({"--fit", "polynomial:1", "-o", "a.png"}, "no language of functions has the ending '.png'");
  refused({"--fit", "polynomial:1", "-o", "a.h", "--format", "csv"}, "unknown language 'csv'");
  refused({"--fit", "polynomial:1", "--bits", "8"}, "--bits is for a table");
  refused({"--fit", "polynomial:1", "--compare", "a.csv"}, "--compare is for a table");
  refused({"--fit", "polynomial:1", "--name", "f"}, "--name is for a file");
  refused({"--fit", "karis", "-o", "a.h"}, "leave out --output");
  refused({"-o", "a.csv", "--format", "python"}, "unknown format 'python'");
  expect_refusal(with(kGgx, {"--fit", "karis"}), ExitCode::usage, "is one of scale and bias in f0");
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(LookupTables, AreRefusedInOneLine) {
  expect_refusal({"lut", "lambert"}, ExitCode::usage, "needs at least one --axis");
  expect_refusal({"lut", "lambert", "--axis", "alpha"}, ExitCode::usage, "'lambert' has no parameter 'alpha'");
  expect_refusal(with(kGgx, {"-o", "e.tiff"}), ExitCode::usage, "no format of lookup tables has the ending '.tiff'");
  expect_refusal(with(kGgx, {"--float"}), ExitCode::usage, "--float is for a file");
  expect_refusal(with(kGgx, {"--bits", "8"}), ExitCode::usage, "--bits is for a file");
  expect_refusal(with(kGgx, {"--bits", "8", "-o", "e.h"}), ExitCode::usage, "format c has one kind of numbers");
  expect_refusal(with(kGgx, {"--compare", "nothing.csv"}), ExitCode::file, "nothing.csv");
  expect_refusal({"lut", "ggx_anisotropic:alpha_x=0.5,alpha_y=0.2,f0=1", "--axis", "cos_theta"}, ExitCode::usage,
                 "is anisotropic");
  EXPECT_THAT(files(), IsEmpty());
}

}  // namespace
}  // namespace lobe::test
