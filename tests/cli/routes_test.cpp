// One route: command, study and library give the same bits, whatever a reflectance is known by and under every
// lighting.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command_test.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/fit/approximation.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "lobe/study/study.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"

namespace lobe::test {
namespace {

const std::string kOther = "phong:n=5";
constexpr double kTolerance = 0.01;  // of all routes: the same bits, whatever they are worth
constexpr std::array kLightings{
    "point", "daylight", "mean-albedo", "patch:0.5", "mixture:0.8=0.3,1.5=0.7", "density:1=1,2=0.5", "table:w.h5"};

/// A way in which a reflectance is known.
struct Kind {
  std::string name;
  std::string text;               ///< a specification, or a file
  Words make = {};                ///< the command that makes the file
  std::string content;            ///< else what is written into it
  std::string data;               ///< else where it is below LOBE_DATA_DIR
  Route route = Route::formulas;  ///< under point light
};

/// A file of rows at directions that form no grid.
std::string scattered_rows() {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> theta(0, 85);
  std::uniform_real_distribution<double> phi(0, 180);
  std::ostringstream rows;
  rows << "theta_in_deg,theta_out_deg,delta_phi_deg,value\n";
  for (int k = 0; k < 300; ++k) {
    const double in = theta(engine);
    rows << in << ',' << theta(engine) << ',' << phi(engine) << ',' << 0.2 + 0.1 * std::cos(in * kDegree) << '\n';
  }
  return rows.str();
}

std::vector<Kind> kinds() {
  return {{"isotropic_formula", "ward:m=0.4", {}, {}, {}, Route::formulas},
          {"anisotropic_formula", "ward_anisotropic:m_x=0.5,m_y=0.8", {}, {}, {}, Route::formulas},
          {"delta", "lambert:scale=0.3+mirror:rho=0.2", {}, {}, {}, Route::formulas},
          {"pumped", "phong:n=5@pump", {}, {}, {}, Route::formulas},
          {"custom",
           "custom.toml",
           {},
           "model = \"custom\"\nformula = \"(n + 2) / (2 * pi) * exp(n * log_rv)\"\nn = 7\n",
           {},
           Route::formulas},
          {"isotropic_table",
           "t.h5",
           {"tabulate", "ward:m=0.5", "--grid", "gauss:16x32", "-o", "t.h5"},
           {},
           {},
           Route::tables},
          {"dense_table",
           "t.h5",
           {"tabulate", "ward_anisotropic:m_x=0.7,m_y=0.9", "--grid", "gauss:8x16", "--allow-unresolved", "-o", "t.h5"},
           {},
           {},
           Route::tables},
          {"merl",
           "m.binary",
           {"export", "ward:m=0.4,scale=0.5", "--format", "merl", "-o", "m.binary"},
           {},
           {},
           Route::functions},
          {"rgl", "", {}, {}, "rgl_bsdf/vch_golden_yellow_rgb.bsdf", Route::functions},
          {"klems", "k.xml", {"export", "ward:m=0.5", "--format", "klems", "-o", "k.xml"}, {}, {}, Route::tables},
          {"klems_with_delta",
           "k.xml",
           {"export", "lambert:scale=0.3+mirror:rho=0.2", "--format", "klems", "-o", "k.xml"},
           {},
           {},
           Route::tables},
          {"rows_on_a_grid", "g.csv", {"export", kOther, "--format", "csv", "-o", "g.csv"}, {}, {}, Route::functions},
          {"scattered_rows", "r.csv", {}, scattered_rows(), {}, Route::functions}};
}

class EveryKind : public CommandTest, public ::testing::WithParamInterface<Kind> {
 protected:
  void SetUp() override {
    const Kind& kind = GetParam();
    text_ = kind.text;
    if (!kind.data.empty()) {
      text_ = measured_data(kind.data).string();
      if (text_.empty()) GTEST_SKIP() << kNoData;
    }
    if (!kind.make.empty()) make(kind.make);
    if (!kind.content.empty()) std::ofstream(file(kind.text)) << kind.content;
    make({"tabulate", "lambert:scale=0.4", "--grid", "gauss:12x24", "-o", "w.h5"});
  }

  [[nodiscard]] bool is_file() const { return text_.find(':') == std::string::npos; }
  [[nodiscard]] std::filesystem::path path() const {
    return GetParam().data.empty() ? file(text_) : std::filesystem::path(text_);
  }
  [[nodiscard]] Reflectance reflectance() const {
    return is_file() ? load_reflectance(path()) : Reflectance(parse_material(text_));
  }
  [[nodiscard]] Lighting lighting(const std::string& name) const {
    return name == "table:w.h5" ? Lighting::table(load_table(file("w.h5")), "w.h5") : parse_lighting(name);
  }
  /// By the library; none: it is refused.
  [[nodiscard]] std::optional<MetricResult> by_library(const std::string& name) const {
    try {
      return measure(device(), {reflectance(), parse_material(kOther)}, lighting(name),
                     {.tolerance = kTolerance, .patch_tolerance = kTolerance, .function_tolerance = kTolerance});
    } catch (const Error&) {
      return {};
    }
  }
  [[nodiscard]] std::optional<MetricResult> by_study(const std::string& name) const {
    Study study;
    study.name = "s";
    study.lightings = {lighting(name)};
    study.tolerance = study.patch_tolerance = study.function_tolerance = kTolerance;
    const Reflectance first = reflectance();
    if (const Material* formula = first.formula()) {
      study.materials = {*formula, parse_material(kOther)};
    } else {
      Material named;
      named.name = "first";
      study.materials = {named, parse_material(kOther)};
      study.files = {MaterialFile{path(), text_, {}}, std::nullopt};
      for (std::size_t c = 0; c < first.channels(); ++c) study.channels.push_back("channel " + std::to_string(c));
    }
    try {
      return run_study(device(), study).metrics.front();
    } catch (const Error& error) {
      refusal_ = error.what();
      return {};
    }
  }

  std::string text_;
  mutable std::string refusal_;  ///< what the last run said
};

void expect_same(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected, const std::string& where) {
  ASSERT_EQ(found.rows(), expected.rows()) << where;
  for (Eigen::Index i = 0; i < found.rows(); ++i) {
    for (Eigen::Index j = 0; j < found.cols(); ++j) {
      if (std::isnan(expected(i, j)) && std::isnan(found(i, j))) continue;
      EXPECT_EQ(found(i, j), expected(i, j)) << where << " " << i << " " << j;
    }
  }
}

Eigen::MatrixXd matrix_of(const Json& json) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(json.size()), static_cast<Eigen::Index>(json[0].size()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      const Json& entry = json[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      matrix(i, j) = entry.is_number() ? entry.get<double>() : std::nan("");
    }
  }
  return matrix;
}

TEST_P(EveryKind, HasTheSameProductsByCommandStudyAndLibrary) {
  Words words{"gram", text_, kOther, "--tolerance", "0.01", "--json"};
  std::vector<MetricResult> expected;
  for (const std::string name : kLightings) {
    const auto library = by_library(name);
    const auto study = by_study(name);
    // Studies cluster what they measure, and refuse distances whose errors are unknown.
    const bool is_known = library && library->combined.distance_error.allFinite();
    ASSERT_EQ(is_known, study.has_value()) << name << ": " << refusal_;
    if (!library) {
      EXPECT_NE(run({"gram", text_, kOther, "--tolerance", "0.01", "--lighting", name}).status, 0) << name;
      continue;
    }
    if (name == "point") {
      EXPECT_EQ(library->route, GetParam().route) << to_string(library->route);
    }
    words.insert(words.end(), {"--lighting", name});
    expected.push_back(*library);
    if (!study) continue;
    EXPECT_EQ(study->route, library->route) << name;
    EXPECT_EQ(study->grid.has_value(), library->grid.has_value()) << name;
    if (library->grid && study->grid) {
      EXPECT_EQ(study->grid->name(), library->grid->name()) << name;
    }
    expect_same(study->combined.gram, library->combined.gram, name + " study");
    expect_same(study->combined.gram_error, library->combined.gram_error, name + " study");
    expect_same(study->combined.distance, library->combined.distance, name + " study");
  }
  ASSERT_FALSE(expected.empty());
  const Json answer = Json::parse(make(words).output);
  ASSERT_EQ(answer["lightings"].size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const std::string name = answer["lightings"][k]["lighting"];
    const Json& route = answer["route"];
    EXPECT_EQ(route.is_array() ? route[k] : route, to_string(expected[k].route)) << name;
    expect_same(matrix_of(answer["lightings"][k]["gram"]), expected[k].combined.gram, name + " command");
    expect_same(matrix_of(answer["lightings"][k]["gram_error"]), expected[k].combined.gram_error, name + " command");
  }
}

TEST_P(EveryKind, IsApproximatedAlikeByCommandAndLibrary) {
  const std::vector<Material> basis{parse_material("lambert"), parse_material("phong:n=20")};
  std::optional<Approximation> expected;
  try {
    expected = approximate(device(), reflectance(), basis, Lighting::daylight());
  } catch (const Error&) {
  }
  const Words words{"approximate", text_, "-b", "lambert", "-b", "phong:n=20", "--lighting", "daylight", "--json"};
  const Outcome outcome = run(words);
  ASSERT_EQ(outcome.status == 0, expected.has_value()) << outcome.error;
  if (!expected) return;
  const Json answer = Json::parse(outcome.output)["answers"][0];
  EXPECT_EQ(answer["residual"]["value"].get<double>(), expected->residual.value);
  EXPECT_EQ(answer["residual"]["error"].get<double>(), expected->residual.error);
}

INSTANTIATE_TEST_SUITE_P(routes, EveryKind, ::testing::ValuesIn(kinds()),
                         [](const auto& parameter) { return parameter.param.name; });

/// Commands on one reflectance, whatever it is known by.
class OneReflectance : public CommandTest {
 protected:
  void SetUp() override {
    make({"tabulate", "lambert:scale=0.3+mirror:rho=0.2", "--grid", "gauss:8x16", "-o", "t.h5"});
  }
};

TEST_F(OneReflectance, TablesAskForNoDevice) {
  const Surroundings nowhere{.environment = {{"LOBE_DEVICE", "no such platform"}}};
  const std::vector<Words> commands{{"albedo", "t.h5", "--theta", "30", "--mean"},
                                    {"mean-albedo", "t.h5"},
                                    {"check", "t.h5"},
                                    {"eval", "t.h5", "--theta-in", "30", "--theta-out", "10", "--delta-phi", "0"}};
  for (const Words& words : commands) EXPECT_EQ(run(words, nowhere).status, 0) << words.front();
  EXPECT_EQ(run({"albedo", "lambert", "--theta", "30"}, nowhere).status, static_cast<int>(cli::ExitCode::device));
}

TEST_F(OneReflectance, DeltaPartsHaveNoValuesInFormulasAsInTables) {
  for (const char* text : {"t.h5", "lambert:scale=0.3+mirror:rho=0.2"}) {
    SCOPED_TRACE(text);
    const auto found = run({"eval", text, "--theta-in", "30", "--theta-out", "30", "--delta-phi", "180", "--json"});
    ASSERT_EQ(found.status, 0) << found.error;
    EXPECT_THAT(found.error, ::testing::HasSubstr("has delta parts, which have no values")) << text;
    EXPECT_NEAR(Json::parse(found.output)["values"][0]["brdf"][0].get<double>(), 0.3 / std::numbers::pi, 1e-12);
  }
}

}  // namespace
}  // namespace lobe::test
