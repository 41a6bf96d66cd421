// `lobe report`: the page of a study, and that the commands on it give the numbers beside them.
#include <optional>

#include "cli/command_test.hpp"
#include "core/files.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kReportedStudy = R"(
[study]
name = "some"
lightings = ["point", "daylight", "patch:0.5"]
tolerance = 1e-4
patch_tolerance = 1e-3
channels = ["r", "g"]

[[material]]
name = "paint"
family = "it's a paint"
terms = [{model = "lambert", scale = [0.3, 0.4]}, {model = "ward", m = 0.1, scale = 0.5}]

[[material]]
name = "metal"
model = "phong"
n = [20, 30]
factors = [{name = "cos_max"}]

[[material]]
name = "pumped"
model = "phong"
n = 20
adjustments = ["pump"]

[[material]]
name = "drawn"
model = "lambert"
)";

class Report : public CommandTest {
 protected:
  Report() {
    static std::string computed;  // once for all
    write_text(file("some.toml"), false, kReportedStudy);
    if (computed.empty()) {
      make({"run", "some.toml"});
      computed = read_text(file("some.h5"));
    } else {
      write_text(file("some.h5"), false, computed);
    }
    make({"report", "some.h5"});
  }

  /// What the page's script reads.
  [[nodiscard]] Json data() const {
    const std::string page = read_text(file("some.html"));
    const std::string mark = "<script id=\"data\" type=\"application/json\">";
    const std::size_t begin = page.find(mark) + mark.size();
    return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  }

  [[nodiscard]] Outcome type(const std::string& line) const {
    return run_line(line, {.directory = file("").parent_path()});
  }
};

/// Distance and error of two materials, counted from 0, first > second.
std::pair<double, double> distance_on_page(const Json& measure, std::size_t first, std::size_t second) {
  const std::size_t at = first * (first - 1) / 2 + second;
  return {measure["distance"].at(at).get<double>(), measure["distance_error"].at(at).get<double>()};
}

TEST_F(Report, StandsBesideTheStudyAndIsNamed) {
  EXPECT_THAT(files(), ::testing::IsSupersetOf({"some.h5", "some.html"}));
  EXPECT_EQ(make({"report", "some.h5", "-o", "other.html"}).output, "other.html\n");
}

TEST_F(Report, IsReplacedOnlyOnDemand) {
  expect_refusal({"report", "some.h5"}, cli::ExitCode::file, "some.html exists; use --force to replace it");
  EXPECT_EQ(make({"report", "some.h5", "--force"}).output, "some.html\n");
}

TEST_F(Report, AnswersInJson) {
  const Json answer = json({"report", "some.h5", "--force"});
  EXPECT_EQ(answer["schema"], "lobe.report/1");
  EXPECT_EQ(answer["materials"], 4);
  EXPECT_EQ(answer["file"], "some.html");
}

TEST_F(Report, RefusesWhatIsNoResult) {
  expect_refusal({"report", "some.toml"}, cli::ExitCode::usage, "some.toml is no result; compute it first");
  expect_refusal({"report", "none.h5"}, cli::ExitCode::file, "none.h5: No such file");
  make({"tabulate", "lambert", "-o", "table.h5"});
  expect_refusal({"report", "table.h5"}, cli::ExitCode::file, "its schema is 'lobe-table/1'; expected lobe-study/1");
}

TEST_F(Report, HasASphereOfEveryFormula) {
  const Json spheres = data()["spheres"];
  ASSERT_EQ(spheres.size(), 4U);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    SCOPED_TRACE(i);
    const auto sphere = spheres[i].get<std::string>();
    EXPECT_THAT(sphere, ::testing::StartsWith("data:image/png;base64,"));
    EXPECT_LT(sphere.size(), 16384U) << "no larger than the pixels themselves";
  }
}

TEST_F(Report, HasNoSpheresWhereNoneAreWanted) {
  make({"report", "some.h5", "--no-spheres", "--force"});
  EXPECT_EQ(data()["spheres"], Json::array());
}

TEST_F(Report, SaysThatADeviceThatIsMissingCostsTheSpheresOnly) {
  const auto outcome = run_line("lobe report some.h5 --force --device 99:0", {.directory = file("").parent_path()});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.error, ::testing::HasSubstr("the page has no spheres: "));
  EXPECT_EQ(data()["spheres"], Json::array());
}

// The commands are those that the page's script puts together; the browser's test reads them off the page.
TEST_F(Report, PrintsCommandsForPairsThatGiveTheDistancesAgain) {
  const Json page = data();
  for (const Json& measure : page["measures"]) {
    SCOPED_TRACE(measure["arguments"]);
    const auto line = "lobe distance " + page["materials"][1]["operand"].get<std::string>() + " " +
                      page["materials"][0]["operand"].get<std::string>() + " " +
                      measure["arguments"].get<std::string>() + " --json";
    const auto outcome = type(line);
    ASSERT_EQ(outcome.status, 0) << line << outcome.error;
    const Json found = Json::parse(outcome.output)["distance"];
    const auto [value, error] = distance_on_page(measure, 1, 0);
    EXPECT_NEAR(found["value"].get<double>(), value, error + found["error"].get<double>()) << line;
    EXPECT_LT(error, 1e-2 * value);
  }
}

TEST_F(Report, PrintsCommandsForMaterialsWithoutATextThatNameTheStudy) {
  const Json page = data();
  EXPECT_TRUE(page["materials"][2]["operand"].is_null()) << "pumped up";
  const Json& measure = page["measures"][0];
  const auto line = "lobe distance-matrix " + page["study_file_word"].get<std::string>() + " --family " +
                    page["family_words"][0].get<std::string>() + " --family " +
                    page["family_words"][page["materials"][2]["family"].get<std::size_t>()].get<std::string>() + " " +
                    measure["arguments"].get<std::string>() + " --json";
  const auto outcome = type(line);
  ASSERT_EQ(outcome.status, 0) << line << outcome.error;
  const Json answer = Json::parse(outcome.output);
  std::optional<std::size_t> paint;
  std::optional<std::size_t> pumped;
  for (std::size_t i = 0; i < answer["materials"].size(); ++i) {
    if (answer["materials"][i]["name"] == "paint") paint = i;
    if (answer["materials"][i]["name"] == "pumped") pumped = i;
  }
  ASSERT_TRUE(paint && pumped) << answer["materials"].dump();
  const Json& lighting = answer["lightings"][0];
  const auto [value, error] = distance_on_page(measure, 2, 0);
  EXPECT_NEAR(lighting["distance"][*pumped][*paint].get<double>(), value,
              error + lighting["distance_error"][*pumped][*paint].get<double>());
}

TEST_F(Report, PrintsCommandsForAlbedosThatGiveTheCurvesAgain) {
  const Json page = data();
  const auto line = "lobe albedo " + page["materials"][0]["curve_operand"].get<std::string>() + " " +
                    page["albedo_arguments"].get<std::string>() + " --json";
  const auto outcome = type(line);
  ASSERT_EQ(outcome.status, 0) << line << outcome.error;
  const Json found = Json::parse(outcome.output)["albedos"];
  const Json& curves = page["curves"];
  ASSERT_EQ(found.size(), curves["theta"].size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (std::size_t c = 0; c < 2; ++c) {
      SCOPED_TRACE(c);
      const Json& channel = curves["materials"][0]["channels"][c];
      const double error = channel["albedo_error"][k].get<double>() + found[k]["albedo"][c]["error"].get<double>();
      EXPECT_NEAR(found[k]["albedo"][c]["value"].get<double>(), channel["albedo"][k].get<double>(), error) << k;
      EXPECT_LT(error, 1e-3) << k;
    }
  }
}

}  // namespace
}  // namespace lobe::test
