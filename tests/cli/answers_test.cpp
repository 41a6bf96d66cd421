// Output of the commands when all is well.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <ostream>
#include <string>
#include <tuple>

#include "cli/process.hpp"
#include "interface/exit_code.hpp"
#include "lobe/model/model.hpp"
#include "support/names.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using Json = nlohmann::ordered_json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

Json run_json(Words arguments) {
  arguments.emplace_back("--json");
  const auto outcome = run_lobe(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  return Json::parse(outcome.output);
}

struct AnswerCase {
  std::string name;
  Words arguments;
};

/// GoogleTest shows a case by its name.
std::ostream& operator<<(std::ostream& stream, const AnswerCase& answer) {
  return stream << answer.name;
}

const std::vector<AnswerCase>& answer_cases() {
  static const std::vector<AnswerCase> kCases{
      {"models", {"models"}},
      {"devices", {"devices"}},
      {"eval", {"eval", "phong:n=20", "--theta-in", "30", "--theta-out", "30", "--delta-phi", "180"}},
      {"albedo", {"albedo", "lambert", "--theta", "0,60", "--mean"}},
      {"sample", {"sample", "phong:n=3", "--theta", "30", "--count", "3"}},
      {"check", {"check", "lambert:scale=0.5", "phong:n=3"}},
      {"distance", {"distance", "lambert", "phong:n=3"}},
      {"product", {"product", "lambert", "phong:n=3"}},
      {"norm", {"norm", "phong:n=3"}},
      {"angle", {"angle", "lambert", "phong:n=3"}},
      {"gram", {"gram", "lambert", "phong:n=3"}},
      {"distance-matrix", {"distance-matrix", "lambert", "phong:n=3"}},
      {"approximate", {"approximate", "phong:n=2", "--basis", "lambert", "--basis", "phong:n=9"}},
      {"fit", {"fit", "phong:n=2", "--family", "lambert+phong"}},
      {"compose", {"compose", "lambert", "phong:n=3", "--grid", "gauss:8x16"}},
      {"self-compose", {"self-compose", "lambert", "--grid", "gauss:8x16"}},
      {"mean-albedo", {"mean-albedo", "lambert", "phong:n=3"}},
      {"pump", {"pump", "phong:n=3", "--correction", "g1"}},
      {"balance", {"balance", "phong:n=3,scale=1.2", "--grid", "gauss:8x16"}},
      {"normalise", {"normalise", "phong:n=3", "--grid", "gauss:8x16"}},
      {"symmetrise", {"symmetrise", "phong:n=3", "--grid", "gauss:8x16"}}};
  return kCases;
}

class Answer : public ::testing::TestWithParam<AnswerCase> {};

TEST_P(Answer, IsTextOnStandardOutputAlone) {
  const auto outcome = run_lobe(GetParam().arguments);

  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, Not(IsEmpty()));
  EXPECT_THAT(outcome.error, IsEmpty());
}

TEST_P(Answer, IsJsonThatBeginsWithItsSchema) {
  const Json answer = run_json(GetParam().arguments);

  EXPECT_EQ(answer.begin().key(), "schema");
  EXPECT_EQ(answer.begin().value(), "lobe." + GetParam().name + "/1");
}

TEST_P(Answer, HasNoNullInJson) {
  EXPECT_THAT(run_json(GetParam().arguments).dump(), Not(HasSubstr("null")));
}

INSTANTIATE_TEST_SUITE_P(Commands, Answer, ::testing::ValuesIn(answer_cases()), ByName{});

TEST(Models, ExplainsEachModelWithAnExampleThatWorks) {
  for (const auto& model : catalogue()) {
    SCOPED_TRACE(model.name);
    const Json entry = run_json({"models", std::string(model.name)})["models"].at(0);
    if (model.traits.has_delta) continue;  // no values to print
    const auto outcome = run_lobe(
        {"eval", entry["example"].get<std::string>(), "--theta-in", "30", "--theta-out", "30", "--delta-phi", "180"});

    EXPECT_EQ(entry["name"], model.name);
    EXPECT_EQ(entry["parameters"].size(), model.parameters.size());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
  }
}

TEST(Models, AreListedByChapterOfTheDissertationWithTheirEquations) {
  const std::string list = run_lobe({"models"}).output;
  const auto at = [&](const std::string& text) { return list.find(text); };

  EXPECT_LT(at("\n1 Introduction\n"), at("\nlambert "));
  EXPECT_LT(at("\nlambert "), at("\n2 Reflectance Models by"));
  EXPECT_LT(at("\n4 Reflectance Models with"), at("\nbasic_patch "));
  EXPECT_LT(at("\nbasic_patch "), at("\n5 Central Concepts"));
  EXPECT_LT(at("\nBeyond the dissertation\n"), at("\nggx "));
  EXPECT_THAT(list, ContainsRegex("basic_patch +R +eq. 4.2 and 4.7 +isotropic, reciprocal, conserves energy\n"));
  EXPECT_THAT(list, ContainsRegex("disney_diffuse +rough +Burley 2012, section 5.3 +isotropic, reciprocal\n"));
  EXPECT_EQ(run_json({"models", "blinn_metal"})["models"].at(0)["chapter"], 3);
  EXPECT_FALSE(run_json({"models", "ggx"})["models"].at(0).contains("chapter"));
}

TEST(Eval, CombinesListsOfAngles) {
  const Json answer =
      run_json({"eval", "lambert", "--theta-in", "0,30", "--theta-out", "0,45,60", "--delta-phi", "0,-90"});

  EXPECT_EQ(answer["values"].size(), 12U);
  EXPECT_EQ(answer["values"][11]["theta_in_deg"], 30);
  EXPECT_EQ(answer["values"][11]["theta_out_deg"], 60);
  EXPECT_EQ(answer["values"][11]["delta_phi_deg"], -90);
}

TEST(Eval, TakesTheAzimuthOfTheLight) {
  const Json answer = run_json({"eval", "ward_anisotropic:m_x=0.1,m_y=0.4", "--theta-in", "30", "--theta-out", "40",
                                "--delta-phi", "180", "--phi-in", "0,90,180"});

  ASSERT_EQ(answer["values"].size(), 3U);
  EXPECT_EQ(answer["values"][1]["phi_in_deg"], 90);
  EXPECT_LT(answer["values"][0]["brdf"][0].get<double>(), 0.8 * answer["values"][1]["brdf"][0].get<double>());
  EXPECT_NEAR(answer["values"][0]["brdf"][0], answer["values"][2]["brdf"][0], 1e-12);
}

TEST(Eval, PrintsNumbersThatReadBackAsTheSame) {
  const Words arguments{"eval", "phong:n=3", "--theta-in", "20", "--theta-out", "30", "--delta-phi", "100"};
  const double value = run_json(arguments)["values"][0]["brdf"][0];

  const std::string text = run_lobe(arguments).output;

  EXPECT_EQ(std::stod(text.substr(text.find_last_of(' '))), value);
}

TEST(Eval, TakesAMaterialFile) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "half.toml";
  std::ofstream(path) << "name = \"half\"\nmodel = \"lambert\"\nscale = 0.5\n";

  const Json answer = run_json({"eval", path.string(), "--theta-in", "0", "--theta-out", "0", "--delta-phi", "0"});

  EXPECT_EQ(answer["material"]["name"], "half");
  EXPECT_NEAR(answer["values"][0]["brdf"][0].get<double>(), 0.5 / std::numbers::pi, 1e-15);
}

TEST(Eval, TakesFactorsAndValuesByChannel) {
  const Json answer = run_json({"eval", "ward:m=0.1/0.2,scale=1/0.5*cos_max:p=0.5", "--theta-in", "30", "--theta-out",
                                "30", "--delta-phi", "180"});

  ASSERT_EQ(answer["values"][0]["brdf"].size(), 2U);
  const double cosine = std::cos(std::numbers::pi / 6);
  for (const auto& [channel, m, scale] : {std::tuple{0, 0.1, 1.0}, std::tuple{1, 0.2, 0.5}}) {
    SCOPED_TRACE(channel);
    const double expected = scale / (4 * std::numbers::pi * m * m * cosine) / std::sqrt(cosine);  // (3.35), N = H
    EXPECT_NEAR(answer["values"][0]["brdf"][static_cast<std::size_t>(channel)].get<double>(), expected,
                1e-12 * expected);
  }
}

TEST(Albedo, OfAFormulaIsThatOfTheSameModel) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "mine.toml";
  std::ofstream(path) << "model = \"custom\"\nformula = \"(n + 2) / (2 * pi) * exp(n * log_rv)\"\nn = 7\n";

  const Json mine = run_json({"albedo", path.string(), "--theta", "60"})["albedos"][0]["albedo"][0];
  const Json model = run_json({"albedo", "phong:n=7", "--theta", "60"})["albedos"][0]["albedo"][0];

  EXPECT_NEAR(mine["value"].get<double>(), model["value"].get<double>(),
              mine["error"].get<double>() + model["error"].get<double>());
}

TEST(Albedo, OfAnAdjustedMaterialIsThatOfTheResult) {
  const Json albedo =
      run_json({"albedo", "minnaert:k=1,scale=0.25@normalise", "--theta", "0"})["albedos"][0]["albedo"][0];

  EXPECT_NEAR(albedo["value"].get<double>(), 1, 1e-6);
}

/// A reflectance with edges that are too many for the rules of quadrature to follow.
class Edged : public ::testing::Test {
 protected:
  Edged() { std::ofstream(file_) << "model = \"custom\"\nformula = \"(2 + floor(40 * cos_lv) / 40) / pi\"\n"; }
  static void expect_warning(const Outcome& outcome, const std::string& text) {
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_THAT(outcome.error, StartsWith("lobe: warning: "));
    EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
    EXPECT_THAT(outcome.error, HasSubstr(text));
  }
  static void expect_refusal(Words words, const std::string& text) {
    words.emplace_back("--strict");
    const auto outcome = run_lobe(words);
    EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::numeric)) << outcome.error;
    EXPECT_THAT(outcome.output, IsEmpty());
    EXPECT_THAT(outcome.error, HasSubstr(text));
  }
  [[nodiscard]] std::string path() const { return file_.string(); }

 private:
  TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_.path() / "edged.toml";
};

// 1 - 1 and rounding.
TEST_F(Edged, AlbedosThatMissTheToleranceAreStatedWithTheirErrors) {
  const Words words{"albedo", "phong:n=20+lambert:scale=-1", "--theta", "0,45"};
  expect_warning(run_lobe(words), "instead of 1e-06");
  expect_refusal(words, "albedo at 0 degrees of ");
  const Json answer = run_json(words);
  EXPECT_EQ(answer["reached_tolerance"], false);
  EXPECT_EQ(answer["albedos"][0]["reached_tolerance"], false);
  const Json albedo = answer["albedos"][0]["albedo"][0];
  EXPECT_NEAR(albedo["value"].get<double>(), 0, albedo["error"].get<double>());
  EXPECT_LT(albedo["error"].get<double>(), 1e-6);
  EXPECT_EQ(answer["albedos"][1]["reached_tolerance"], true);
}

TEST_F(Edged, MeanAlbedosSayWhichMissTheTolerance) {
  const Json phong = run_json({"mean-albedo", "phong:n=20", "--tolerance", "1e-9"});
  const auto mean = phong["materials"][0]["mean_albedo"][0]["value"].get<double>();
  const std::string cancelling = "phong:n=20+lambert:scale=" + std::to_string(-mean);
  const Words words{"mean-albedo", "lambert", cancelling};
  expect_warning(run_lobe(words), "mean albedo of ");
  expect_refusal(words, "mean albedo of ");
  const Json answer = run_json(words);
  EXPECT_EQ(answer["materials"][0]["reached_tolerance"], true);
  EXPECT_EQ(answer["materials"][1]["reached_tolerance"], false);
}

TEST_F(Edged, NormsThatMissTheToleranceWarnInOneLine) {
  const Words words{"norm", path(), "--tolerance", "1e-7"};
  expect_warning(run_lobe(words), "point: the product of 'edged' and 'edged' reaches a relative error of ");
  expect_refusal(words, "the product of 'edged' and 'edged'");
}

TEST(Composition, AtDirectionsThatMissesTheToleranceIsStatedWithItsError) {
  // 1 - 1 and rounding.
  const Words words{"compose", "phong:n=20+lambert:scale=-1", "lambert", "--at", "0,0,0", "--at", "60,0,0"};
  const Json answer = run_json(words);
  EXPECT_EQ(answer["values"][0]["reached_tolerance"], false);
  EXPECT_EQ(answer["values"][1]["reached_tolerance"], true);
  EXPECT_LT(answer["values"][0]["brdf_error"][0].get<double>(), 1e-11);
  EXPECT_NEAR(answer["values"][0]["brdf"][0].get<double>(), 0, answer["values"][0]["brdf_error"][0].get<double>());
  auto strict = words;
  strict.emplace_back("--strict");
  EXPECT_EQ(run_lobe(strict).status, static_cast<int>(ExitCode::numeric));
}

// In the catalogue: half_cosine has alpha in [-1, 2], hapke b in [0, 0.99] and c in [-1, 1].
TEST(Models, StatesBoundsOfEitherSign) {
  EXPECT_THAT(run_lobe({"models", "half_cosine"}).output, HasSubstr("alpha from -1 to 2 (default -1)"));
  const std::string hapke = run_lobe({"models", "hapke"}).output;
  EXPECT_THAT(hapke, HasSubstr("c from -1 to 1 (default 0)"));
  EXPECT_THAT(hapke, HasSubstr("b from 0 to 0.99 (default 0)"));
}

TEST(Models, ExplainsAFactor) {
  const auto outcome = run_lobe({"models", "cos_max"});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, HasSubstr("1 / max(N.L, N.V)^p"));
  EXPECT_EQ(run_json({"models", "cos_max"})["factors"].size(), 1U);
  EXPECT_THAT(run_lobe({"models", "lacquer"}).output, HasSubstr("lacquer (factor on a model)"));  // after the model
}

TEST(Albedo, TakesTheAzimuthOfTheLight) {
  const Json answer =
      run_json({"albedo", "ggx_anisotropic:alpha_x=0.2,alpha_y=0.6", "--theta", "70,80", "--azimuth", "0,90"});

  ASSERT_EQ(answer["albedos"].size(), 4U);
  EXPECT_EQ(answer["albedos"][2]["theta_deg"], 70);
  EXPECT_EQ(answer["albedos"][2]["phi_deg"], 90);
  EXPECT_GT(std::abs(answer["albedos"][0]["albedo"][0]["value"].get<double>() -
                     answer["albedos"][2]["albedo"][0]["value"].get<double>()),
            0.01);
}

TEST(Albedo, OfLambertIsOneWithinItsError) {
  const Json answer = run_json({"albedo", "lambert", "--theta", "0,60,89", "--mean"});

  ASSERT_EQ(answer["albedos"].size(), 3U);
  for (const auto& entry :
       {answer["albedos"][0]["albedo"][0], answer["albedos"][2]["albedo"][0], answer["mean_albedo"][0]}) {
    SCOPED_TRACE(entry);
    EXPECT_NEAR(entry["value"].get<double>(), 1, std::max(1e-12, entry["error"].get<double>()));
  }
}

TEST(Check, SaysWhatIsWrongAndEndsWithOne) {
  const auto outcome = run_lobe({"check", "lambert", "ward:m=0.1", "lambert:scale=-1", "--tolerance", "1e-3"});

  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, StartsWith("lambert: plausible\n"));
  EXPECT_THAT(outcome.output, HasSubstr("ward:m=0.1: implausible: more light than it gets\n"));
  EXPECT_THAT(outcome.output, ContainsRegex("grows as \\(N.L\\)\\^-p towards grazing incidence, p = 0.(5|499)"));
  EXPECT_THAT(outcome.output, HasSubstr("lambert:scale=-1: implausible: negative values\n"));
  EXPECT_THAT(outcome.error, IsEmpty());
}

TEST(Check, HasItsNumbersInJson) {
  const auto outcome = run_lobe({"check", "ward:m=0.1", "basic_patch:R=0.5", "--tolerance", "1e-3", "--json"});
  const Json materials = Json::parse(outcome.output)["materials"];

  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(materials[0]["is_plausible"], false);
  EXPECT_NEAR(materials[0]["channels"][0]["growth_exponent"]["value"].get<double>(), 0.5, 0.01);
  EXPECT_EQ(materials[1]["is_plausible"], true);
  EXPECT_FALSE(materials[1]["channels"][0].contains("growth_exponent"));
  EXPECT_EQ(materials[1]["edges"][0]["radius"], 0.5);
}

TEST(Distance, IsOneLineWithItsError) {
  const auto outcome = run_lobe({"distance", "lambert", "phong:n=3"});

  EXPECT_THAT(outcome.output, ::testing::MatchesRegex("0\\.8198109[0-9]* ± [0-9.e-]+\n"));
}

TEST(Distance, AgreesWithNormsAndProduct) {
  const Json answer = run_json({"distance", "ward:m=0.2", "phong:n=20"});
  const double a = answer["norm_a"]["value"];
  const double b = answer["norm_b"]["value"];
  const double product = answer["product"]["value"];

  EXPECT_NEAR(answer["distance"]["value"].get<double>(), std::sqrt(a * a + b * b - 2 * product), 1e-5);
  EXPECT_NEAR(std::cos(answer["angle_deg"]["value"].get<double>() * std::numbers::pi / 180), product / (a * b), 1e-5);
}

TEST(Distance, ToldVerboselyAddsNormsOnStandardErrorOnly) {
  const auto plain = run_lobe({"distance", "lambert", "phong:n=3"});
  const auto verbose = run_lobe({"distance", "lambert", "phong:n=3", "-v"});

  EXPECT_EQ(verbose.output, plain.output);
  EXPECT_THAT(verbose.error, HasSubstr("angle/deg"));
}

TEST(Domain, IsThatOfTheOptionAndSaid) {
  const double sine2 = std::pow(std::sin(80 * std::numbers::pi / 180), 2);
  const Json norm = run_json({"norm", "lambert", "--domain-theta-max", "80"});
  EXPECT_NEAR(norm["norm"]["value"].get<double>(), sine2, norm["norm"]["error"].get<double>());
  EXPECT_EQ(norm["domain_theta_max_deg"], 80);
  EXPECT_FALSE(run_json({"norm", "lambert"}).contains("domain_theta_max_deg"));
  EXPECT_THAT(run_lobe({"norm", "lambert", "--domain-theta-max", "80"}).output, HasSubstr(", up to 80 degrees\n"));
  EXPECT_THAT(run_lobe({"gram", "lambert", "--domain-theta-max", "80"}).output, StartsWith("point, up to 80 degrees"));
  EXPECT_THAT(run_lobe({"gram", "lambert", "--domain-theta-max", "80", "--csv"}).output,
              HasSubstr("point up to 80 degrees,combined,gram,"));
  // This also holds for tables, and in fits and approximations.
  EXPECT_NEAR(
      run_json({"norm", "lambert", "--grid", "gauss:8x16", "--domain-theta-max", "80"})["norm"]["value"].get<double>(),
      sine2, 1e-9);
  const Json found = run_json({"approximate", "lambert:scale=0.5", "--basis", "lambert", "--domain-theta-max", "80"});
  EXPECT_NEAR(found["answers"][0]["target_norm"]["value"].get<double>(), 0.5 * sine2, 1e-6);
}

TEST(Domain, IsRefusedWithoutMeaning) {
  for (const char* degrees : {"0", "91", "-3"}) {
    SCOPED_TRACE(degrees);
    const auto outcome = run_lobe({"norm", "lambert", "--domain-theta-max", degrees});
    EXPECT_NE(outcome.status, 0);
    EXPECT_THAT(outcome.error, HasSubstr("expected degrees above 0, at most 90"));
  }
  EXPECT_THAT(run_lobe({"norm", "lambert", "--domain-theta-max", "80", "--lighting", "patch:0.5"}).error,
              HasSubstr("expected point, daylight or mean-albedo"));
  EXPECT_THAT(run_lobe({"norm", "lambert*power_mean:p=-1"}).error,
              HasSubstr("such as 80 degrees (--domain-theta-max 80, domain_theta_max in studies)"));
}

TEST(Distance, TakesOptionsInFrontOfTheCommand) {
  const auto outcome = run_lobe({"--precision", "single", "-q", "distance", "lambert", "phong:n=3", "--json"});

  EXPECT_EQ(Json::parse(outcome.output)["precision"], "single");
}

TEST(Color, IsAbsentInAPipeAndPresentWhenDemanded) {
  EXPECT_THAT(run_lobe({"models"}).output, Not(HasSubstr("\x1b[")));
  EXPECT_THAT(run_lobe({"models", "--color", "always"}).output, StartsWith("\x1b[1m"));
  EXPECT_THAT(run_line("NO_COLOR=1 script -qec 'lobe models' /dev/null").output, Not(HasSubstr("\x1b[")));
  EXPECT_THAT(run_line("TERM=dumb script -qec 'lobe models' /dev/null").output, Not(HasSubstr("\x1b[")));
}

}  // namespace
}  // namespace lobe::test
