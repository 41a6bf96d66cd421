// One route: command, study and library give the same bits, whatever a reflectance is known by and under every
// lighting.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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
#include "lobe/core/written_form.hpp"
#include "lobe/fit/approximation.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/study/load_reflectance.hpp"
#include "lobe/study/material_file.hpp"
#include "lobe/study/study.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

const std::string kOther = "phong:n=5";
constexpr double kTolerance = 0.01;  // of all routes: the same bits, whatever they are worth
const std::vector<std::string> kLightings{"point",
                                          "daylight",
                                          "mean-albedo",
                                          "patch:0.5",
                                          "mixture:0.8=0.3,1.5=0.7",
                                          "density:1=1,2=0.5",
                                          "material:phong:n=3",
                                          "table:w.h5"};

/// A way in which a reflectance is known.
struct Kind {
  std::string name;
  std::string text = {};                  ///< a specification, or a file
  Words make = {};                        ///< the command that makes the file
  std::string content = {};               ///< else what is written into it
  std::string data = {};                  ///< else where it is below LOBE_DATA_DIR
  Route route = Route::formulas;          ///< under point light, and of mean albedos
  std::vector<std::string> refused = {};  ///< lightings that do not take it, by their first words
  bool has_known_errors = true;           ///< of its products with formulas, which studies ask for
  double domain_degrees = 90;             ///< of the products
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
  return {{.name = "isotropic_formula", .text = "ward:m=0.4"},
          {.name = "anisotropic_formula", .text = "ward_anisotropic:m_x=0.5,m_y=0.8"},
          {.name = "delta", .text = "lambert:scale=0.3+mirror:rho=0.2", .refused = {"point"}},
          {.name = "pumped", .text = "phong:n=5@pump"},
          {.name = "custom",
           .text = "custom.toml",
           .content = "model = \"custom\"\nformula = \"(n + 2) / (2 * pi) * exp(n * log_rv)\"\nn = 7\n"},
          {.name = "irreciprocal_formula", .text = "zeltner_sheen:alpha=0.5"},
          {.name = "isotropic_table",
           .text = "t.h5",
           .make = {"tabulate", "ward:m=0.5", "--grid", "gauss:16x32", "-o", "t.h5"},
           .route = Route::tables},
          {.name = "dense_table",
           .text = "t.h5",
           .make = {"tabulate", "ward_anisotropic:m_x=0.7,m_y=0.9", "--grid", "gauss:8x16", "--allow-unresolved", "-o",
                    "t.h5"},
           .route = Route::tables},
          {.name = "merl",
           .text = "m.binary",
           .make = {"export", "ward:m=0.4,scale=0.5", "--format", "merl", "-o", "m.binary"},
           .route = Route::functions},
          {.name = "rgl",
           .data = "rgl_bsdf/vch_golden_yellow_rgb.bsdf",
           .route = Route::functions,
           .refused = {"point", "daylight", "patch", "mixture", "density", "material"}},
          {.name = "rgl_up_to_80_degrees",
           .data = "rgl_bsdf/vch_golden_yellow_rgb.bsdf",
           .route = Route::functions,
           .refused = {"patch", "mixture", "density", "material", "table"},
           .domain_degrees = 80},
          {.name = "klems",
           .text = "k.xml",
           .make = {"export", "ward:m=0.5", "--format", "klems", "-o", "k.xml"},
           .route = Route::tables},
          {.name = "klems_with_delta",
           .text = "k.xml",
           .make = {"export", "lambert:scale=0.3+mirror:rho=0.2", "--format", "klems", "-o", "k.xml"},
           .route = Route::tables},
          {.name = "rows_on_a_grid",
           .text = "g.csv",
           .make = {"export", kOther, "--format", "csv", "-o", "g.csv"},
           .route = Route::functions},
          {.name = "scattered_rows", .text = "r.csv", .content = scattered_rows(), .route = Route::functions}};
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
  /// The command, under a lighting if one is named.
  [[nodiscard]] Words gram(const std::string& lighting = {}) const {
    Words words{"gram", text_, kOther, "--tolerance", "0.01", "--json"};
    if (GetParam().domain_degrees < 90) words.insert(words.end(), {"--domain-theta-max", "80"});
    if (!lighting.empty()) words.insert(words.end(), {"--lighting", lighting});
    return words;
  }
  /// By the library; none: it is refused.
  [[nodiscard]] std::optional<MetricResult> by_library(const std::string& name) const {
    try {
      return measure(device(), {reflectance(), parse_material(kOther)}, lighting(name),
                     {.tolerance = kTolerance,
                      .patch_tolerance = kTolerance,
                      .theta_max = GetParam().domain_degrees * kDegree,
                      .function_tolerance = kTolerance});
    } catch (const Error&) {
      return {};
    }
  }
  /// By a study file; none: it is refused. A tabulated lighting, which files do not name, joins what is read.
  [[nodiscard]] std::optional<StudyResult> by_study(const std::vector<std::string>& names) const {
    std::string lightings;
    for (const std::string& name : names) {
      if (!name.starts_with("table:")) lightings += (lightings.empty() ? "\"" : ", \"") + name + '"';
    }
    std::string text = "[study]\ntolerance = 0.01\npatch_tolerance = 0.01\nfunction_tolerance = 0.01\n";
    if (GetParam().domain_degrees < 90) text += "domain_theta_max = 80\n";
    text += "lightings = [" + (lightings.empty() ? "\"daylight\"" : lightings) + "]\n";
    const Reflectance first = reflectance();
    if (const Material* formula = first.formula()) {
      text += table_of_study(*formula);
    } else {
      text += "channels = [";
      for (std::size_t c = 0; c < first.channels(); ++c) text += (c > 0 ? ", \"c" : "\"c") + std::to_string(c) + '"';
      text += "]\n[[measured]]\nfile = \"" + path().string() + "\"\n";
    }
    std::ofstream(file("s.toml")) << text << table_of_study(parse_material(kOther));
    try {
      Study study = load_study(file("s.toml"));
      if (lightings.empty()) study.lightings.clear();
      for (const std::string& name : names) {
        if (name.starts_with("table:")) study.lightings.push_back(lighting(name));
      }
      return run_study(device(), study);
    } catch (const Error& error) {
      refusal_ = error.what();
      return {};
    }
  }
  /// A material as a table of a study file.
  [[nodiscard]] static std::string table_of_study(const Material& material) {
    std::string text = material_toml(material);
    const std::string terms = "[[terms]]";
    for (std::size_t at = text.find(terms); at != std::string::npos; at = text.find(terms, at + terms.size())) {
      text.replace(at, terms.size(), "[[material.terms]]");
    }
    return "[[material]]\n" + text;
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

/// Every notation for lightings is among those asked for here.
TEST(Routes, AreAskedUnderEveryLighting) {
  for (const WrittenForm& form : lighting_forms()) {
    EXPECT_TRUE(std::ranges::any_of(kLightings, [&](const std::string& name) { return name.starts_with(form.word); }))
        << form.word;
  }
}

/// The lightings that a kind is asked under: all of them, or half, the other half for the next kind.
std::vector<std::string> lightings_of(const Kind& kind) {
  if (full_scale()) return kLightings;
  const auto all = kinds();
  const auto place = std::ranges::find(all, kind.name, &Kind::name) - all.begin();
  std::vector<std::string> part = kLightings;
  if (place % 2 == 1) part.erase(part.begin());
  return swept_of(part, 2);
}

TEST_P(EveryKind, HasTheSameProductsByCommandStudyAndLibrary) {
  Words words = gram();
  std::vector<MetricResult> expected;
  std::vector<std::string> names;  // of those that the study takes, too
  for (const std::string& name : lightings_of(GetParam())) {
    SCOPED_TRACE(name);
    const auto library = by_library(name);
    ASSERT_EQ(library.has_value(), std::ranges::count(GetParam().refused, name.substr(0, name.find(':'))) == 0);
    if (!library) {
      EXPECT_NE(run(gram(name)).status, 0);
      EXPECT_FALSE(by_study({name}));
      continue;
    }
    if (name == "point" || name == "mean-albedo") {
      EXPECT_EQ(library->route, GetParam().route) << to_string(library->route);
    }
    words.insert(words.end(), {"--lighting", name});
    expected.push_back(*library);
    // Studies cluster what they measure, and refuse distances whose errors are unknown.
    if (library->combined.distance_error.allFinite()) {
      names.push_back(name);
    } else {
      EXPECT_FALSE(by_study({name}));
    }
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

  ASSERT_EQ(names.empty(), !GetParam().has_known_errors);
  if (names.empty()) return;
  const auto study = by_study(names);
  ASSERT_TRUE(study) << refusal_;
  ASSERT_EQ(study->metrics.size(), names.size());
  for (const MetricResult& found : study->metrics) {
    SCOPED_TRACE("study, " + found.lighting.name());
    const auto library =
        std::ranges::find(expected, found.lighting.name(), [](const auto& one) { return one.lighting.name(); });
    ASSERT_NE(library, expected.end());
    EXPECT_EQ(found.route, library->route);
    EXPECT_EQ(found.grid ? found.grid->name() : "none", library->grid ? library->grid->name() : "none");
    expect_same(found.combined.gram, library->combined.gram, "gram");
    expect_same(found.combined.gram_error, library->combined.gram_error, "gram_error");
    expect_same(found.combined.distance, library->combined.distance, "distance");
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
