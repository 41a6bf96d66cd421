#include "cli/command_test.hpp"
#include "core/files.hpp"

namespace lobe::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

const Words kPaint{"fit", "lambert:scale=0.3+ward:m=0.17,scale=0.4", "--family", "lambert+ward"};

Words joined_with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class FitCommand : public CommandTest {};

TEST_F(FitCommand, PrintsASpecificationAndWhatIsLeft) {
  const auto outcome = make(kPaint);

  EXPECT_THAT(outcome.output, AllOf(StartsWith("lambert:scale="), HasSubstr("+ward:m="), HasSubstr("1.scale"),
                                    HasSubstr("residual (point)"), HasSubstr("relative residual"), HasSubstr("±")));
  EXPECT_THAT(outcome.error, IsEmpty());
}

TEST_F(FitCommand, AnswersInJson) {
  const Json answer = json({"fit", "cook_torrance:m=0.3", "--family", "ward", "--start", "m=0.3"});

  EXPECT_EQ(answer["schema"], "lobe.fit/1");
  EXPECT_EQ(answer["objective"], "l2");
  EXPECT_EQ(answer["metric"], "point");
  ASSERT_EQ(answer["values"].size(), 2U);
  EXPECT_EQ(answer["values"][1]["label"], "m");
  EXPECT_EQ(answer["correlation"][0][0], 1);
  EXPECT_NEAR(answer["correlation"][0][1].get<double>(), answer["correlation"][1][0].get<double>(), 1e-12);
  EXPECT_EQ(answer["converged"], true);
  EXPECT_THAT(answer.dump(), Not(HasSubstr("null")));
}

TEST_F(FitCommand, LeavesAMaterialThatEveryCommandReads) {
  const Json answer = json(joined_with(kPaint, {"-o", "fit.toml"}));

  EXPECT_THAT(read_text(file("fit.toml")), StartsWith("# lobe fit lambert:scale=0.3"));
  EXPECT_EQ(json({"distance", "fit.toml", kPaint[1]})["distance"], answer["residual"]);
}

// The mirror has a norm under patch light, and none under point light, by which searches begin; its product with the
// diffuse reflectance is that of the latter with itself. Anisotropic targets become tables; the residual of
// `lobe approximate`, by functions, is 0.0491709 ± 3.1e-6.
TEST_F(FitCommand, TakesMirrorsAndAnisotropicTargetsUnderPatchLight) {
  const Json mirror = json({"fit", "mirror:scale=0.1+lambert:scale=0.5", "--family", "lambert", "--lighting", "patch:1",
                            "--tolerance", "1e-2"});
  EXPECT_NEAR(mirror["values"][0]["value"].get<double>(), 0.6, 0.6 * 1e-2);
  const Json bent = json({"fit", "ward_anisotropic:m_x=0.7,m_y=0.9", "--family", "lambert", "--lighting", "patch:1",
                          "--tolerance", "1e-2"});
  EXPECT_NEAR(bent["residual"]["value"].get<double>(), 0.0491709, 0.0491709 * 1e-2);
}

TEST_F(FitCommand, StatesTheLargestErrorsOfAPerceptualFit) {
  const Json answer = json({"fit", "cook_torrance:m=0.3", "--family", "ggx", "--objective", "perceptual", "--start",
                            "alpha=0.3", "--floor", "0.01"});

  EXPECT_EQ(answer["largest_errors"]["floor"], 0.01);
  EXPECT_GT(answer["largest_errors"]["radiance"]["value"].get<double>(), 0);
  EXPECT_TRUE(answer["largest_errors"]["albedo"].contains("theta_in_deg"));
  EXPECT_FALSE(answer.contains("covariance"));
}

TEST_F(FitCommand, TakesATable) {
  make({"tabulate", "ward:m=0.3", "--grid", "16x32", "-o", "ward.h5"});

  const Json answer = json({"fit", "ward.h5", "--family", "ward", "--plot", "."});

  EXPECT_NEAR(answer["values"][1]["value"].get<double>(), 0.3, 1e-6);
  EXPECT_EQ(answer["target"]["table"], "ward.h5");
  EXPECT_THAT(files(), AllOf(Contains("fit.l2.slices.png"), Contains("fit.l2.albedo.png")));
}

TEST_F(FitCommand, WarnsOfAParameterAtItsBound) {
  const auto outcome = make({"fit", "ward:m=0.2", "--family", "ward", "--range", "m=0.01:0.1"});

  EXPECT_THAT(outcome.error, HasSubstr("'m' is at its bound 0.1"));
}

TEST_F(FitCommand, RefusesWhatItCannotRead) {
  const auto refused = [&](const Words& more, const std::string& message) {
    expect_refusal(joined_with({"fit", "ward:m=0.2", "--family"}, more), cli::ExitCode::usage, message);
  };
  refused({"wart"}, "did you mean 'ward'");
  refused({"ward", "--range", "m=0.1"}, "expected PARAMETER=LOWEST:HIGHEST");
  refused({"ward", "--range", "n=1:2"}, "no free parameter 'n'");
  refused({"ward", "--start", "m"}, "expected PARAMETER=VALUE");
  refused({"ward", "--start", "m=-1"}, "expected a value in");
  refused({"ward", "--metric", "low-log"}, "--objective log");
  refused({"ward", "--objective", "log", "--metric", "cube-root"}, "scalar product");
  refused({"ward", "--objective", "perceptual", "--floor", "0"}, "expected a number above 0");
  refused({"ward", "-o", "fit.h5"}, "expected FILE.toml");
}

TEST_F(FitCommand, KeepsAFileThatExists) {
  make(joined_with(kPaint, {"-o", "fit.toml"}));

  expect_refusal(joined_with(kPaint, {"-o", "fit.toml"}), cli::ExitCode::file, "--force");
}

TEST_F(FitCommand, LogarithmsOfAnisotropicMaterialsAreFittedAsTables) {
  const Json fit = json({"fit", "ward_anisotropic:m_x=0.5,m_y=0.8", "--family", "ward_anisotropic", "--objective",
                         "log", "--range", "m_x=0.3:1", "--range", "m_y=0.3:1"});

  EXPECT_NEAR(fit["values"][1]["value"], 0.5, 1e-6);
  EXPECT_NEAR(fit["values"][2]["value"], 0.8, 1e-6);
}

}  // namespace
}  // namespace lobe::test
