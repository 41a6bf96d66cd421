// Every verb takes a reflectance of any kind and gives the answer of what that is known as: its formulas prepared, a
// function, or a table.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "energy/albedo.hpp"
#include "energy/known_as.hpp"
#include "energy/plausibility.hpp"
#include "energy/prepare.hpp"
#include "energy/repair.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/direction_pairs.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/formats/measured_export.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/composition.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/render/preview.hpp"
#include "lobe/sampling/sampling.hpp"
#include "lobe/study/material_curves.hpp"
#include "model/delta.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"
#include "support/tables.hpp"
#include "support/temporary_directory.hpp"
#include "table/as_function.hpp"
#include "table/evaluate.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

/// A reflectance as a user has it, and what verbs know it as.
struct Subject {
  Reflectance given;
  Reflectance known;
};

struct Kind {
  std::string name;
  std::function<Subject(const std::filesystem::path& folder)> make;

  friend void PrintTo(const Kind& kind, std::ostream* stream) { *stream << kind.name; }
};

Subject formulas(const std::string& text) {
  const Material material = parse_material(text);
  return {material, prepare(device(), material)};
}

Subject custom() {
  const Material material{"custom",
                          "",
                          {{.model = std::string(kCustomModel),
                            .values = {7},
                            .weight = {1},
                            .formula = Formula{.text = "(n + 2) / (2 * pi) * exp(n * log_rv)", .parameters = {"n"}}}}};
  return {material, prepare(device(), material)};
}

Subject table(const std::string& text, TableForm form) {
  const BrdfTable made = table_of(text, "gauss:8x16", form);
  return {made, made};
}

Subject file(const std::filesystem::path& path) {
  const BrdfFunction function = load_measured(path);
  if (function.cells) return {function, *function.cells};
  return {function, function};
}

Subject written(const std::filesystem::path& folder, const std::string& text, const std::string& format) {
  save_measured(device(), parse_material(text), format, folder / "written");
  return file(folder / "written");
}

/// Rows at directions that form no grid.
Subject scattered(const std::filesystem::path& folder) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> theta(0, 85);
  std::uniform_real_distribution<double> phi(0, 180);
  std::ofstream rows(folder / "rows.csv");
  rows << "theta_in_deg,theta_out_deg,delta_phi_deg,value\n";
  for (int k = 0; k < 300; ++k) {
    const double in = theta(engine);
    const double out = theta(engine);
    rows << in << ',' << out << ',' << phi(engine) << ',' << 0.2 + 0.1 * std::cos(in * pi / 180) << '\n';
  }
  rows.close();
  return file(folder / "rows.csv");
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"isotropic_formula", [](const auto&) { return formulas("lambert:scale=0.3+ward:m=0.4,scale=0.5"); }},
      {"channels", [](const auto&) { return formulas("lambert:scale=0.5/0.3/0.2+ward:m=0.5,scale=0.3"); }},
      {"anisotropic_formula", [](const auto&) { return formulas("ward_anisotropic:m_x=0.5,m_y=0.8"); }},
      {"delta", [](const auto&) { return formulas("lambert:scale=0.3+mirror:rho=0.2"); }},
      {"pumped", [](const auto&) { return formulas("phong:n=5,scale=0.8@pump"); }},
      {"normalised", [](const auto&) { return formulas("ward:m=0.4@normalise"); }},
      {"custom", [](const auto&) { return custom(); }},
      {"isotropic_table", [](const auto&) { return table("ward:m=0.5", TableForm::isotropic); }},
      {"dense_table", [](const auto&) { return table("ward:m=0.5", TableForm::general); }},
      {"table_with_delta", [](const auto&) { return table("lambert:scale=0.3+mirror:rho=0.2", TableForm::isotropic); }},
      {"rows", [](const auto& folder) { return written(folder, "ward:m=0.5", "csv"); }},
      {"scattered_rows", [](const auto& folder) { return scattered(folder); }},
      {"utia", [](const auto& folder) { return written(folder, "ward_anisotropic:m_x=0.5,m_y=0.8", "utia"); }},
      {"klems", [](const auto& folder) { return written(folder, "ward:m=0.5", "klems"); }},
      {"klems_with_delta",
       [](const auto& folder) { return written(folder, "lambert:scale=0.3+mirror:rho=0.2", "klems"); }}};
  return all;
}

constexpr std::array<double, 3> kVerbAngles{0.0, 0.6, 1.2};
const std::vector<Directions> kPairs{{0.3, 0.5, pi, 0.1}, {0.9, 0.2, 1.0, 2.0}, {1.2, 1.1, 3.0, -1.0}};

void expect_same(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  ASSERT_EQ(found.rows(), expected.rows());
  ASSERT_EQ(found.cols(), expected.cols());
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    if (std::isnan(expected(i))) {
      EXPECT_TRUE(std::isnan(found(i))) << i;
    } else {
      EXPECT_EQ(found(i), expected(i)) << i;
    }
  }
}

void expect_same(const Estimate& found, const Estimate& expected) {
  EXPECT_EQ(found.value, expected.value);
  if (std::isnan(expected.error)) {
    EXPECT_TRUE(std::isnan(found.error));
  } else {
    EXPECT_EQ(found.error, expected.error);
  }
}

template <typename Value>
void expect_same(const std::vector<Value>& found, const std::vector<Value>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) expect_same(found[k], expected[k]);
}

void expect_same(const BrdfTable& found, const BrdfTable& expected) {
  EXPECT_EQ(found.grid, expected.grid);
  EXPECT_EQ(found.form, expected.form);
  EXPECT_EQ(found.values, expected.values);
  EXPECT_EQ(found.mirror, expected.mirror);
}

/// What a table or a function is where the verb takes tables.
BrdfTable own_table(const Reflectance& known) {
  return known.table() != nullptr ? *known.table() : natural_table(*known.function());
}

class Verbs : public ::testing::TestWithParam<Kind> {
 protected:
  /// Made once.
  static const Subject& subject_of(const Kind& kind, const std::filesystem::path& folder) {
    static auto& known = *new std::map<std::string, Subject>;
    const auto found = known.find(kind.name);
    return found != known.end() ? found->second : known.emplace(kind.name, kind.make(folder)).first->second;
  }

  TemporaryDirectory directory_;
  const Subject& subject_ = subject_of(GetParam(), directory_.path());
};

TEST_P(Verbs, EvaluateGivesTheValuesOfItsKind) {
  const BrdfValues found = evaluate(device(), subject_.given, kPairs);
  const Reflectance& known = subject_.given.function() != nullptr ? subject_.given : subject_.known;
  if (const Material* formula = known.formula()) {
    expect_same(found.value, evaluate(device(), smooth_part(*formula), kPairs));
    EXPECT_EQ(found.error.size(), 0);
  } else if (const BrdfFunction* function = known.function()) {
    expect_same(found.value, function->at(kPairs).value);
    expect_same(found.error, function->at(kPairs).error);
  } else {
    expect_same(estimates(found), evaluate(*known.table(), kPairs));
  }
}

TEST_P(Verbs, EvaluateRefusesDirectionsBelowTheHorizon) {
  const std::vector<Directions> below{{0.3, 2, 0}};
  EXPECT_THROW((void)evaluate(device(), subject_.given, below), ArgumentError);
}

TEST_P(Verbs, AlbedoIsThatOfItsKind) {
  const auto found = albedo(device(), subject_.given, kVerbAngles);
  expect_same(found, known_as(device(), subject_.known,
                              Cases{[](const Material& own) { return albedo(device(), own, kVerbAngles); },
                                    [](const BrdfFunction& own) { return albedo(own, kVerbAngles); },
                                    [](const BrdfTable& own) { return albedo(own, kVerbAngles); }}));
}

TEST_P(Verbs, MeanAlbedoIsThatOfItsKind) {
  const AlbedoOptions options{.tolerance = 1e-4};
  const auto found = mean_albedo(device(), subject_.given, options);
  const Reflectance& known = subject_.known;
  expect_same(found, known.formula() != nullptr    ? mean_albedo(device(), *known.formula(), options)
                     : known.function() != nullptr ? mean_albedo(*known.function())
                                                   : row_albedos(*known.table()).mean);
}

TEST_P(Verbs, LargestAlbedoIsTheLargestOfItsAlbedosOrRefused) {
  if (!subject_.known.is_isotropic()) {
    EXPECT_THROW((void)largest_albedo(device(), subject_.given), NumericError);
    return;
  }
  const AlbedoOptions options{.tolerance = 1e-3};
  const auto peaks = largest_albedo(device(), subject_.given, 1.3, options);
  ASSERT_EQ(peaks.size(), subject_.given.channels());
  for (std::size_t c = 0; c < peaks.size(); ++c) {
    const auto there = albedo(device(), subject_.known, std::array{peaks[c].theta}, options)[c].front();
    EXPECT_NEAR(peaks[c].albedo.value, there.value, 1e-3 * there.value) << c;
    for (const double theta : kVerbAngles) {
      SCOPED_TRACE(theta);
      const auto other = albedo(device(), subject_.known, std::array{theta}, options)[c].front();
      EXPECT_GE(peaks[c].albedo.value, other.value - 2e-3) << c;
    }
  }
}

TEST_P(Verbs, PlausibilityIsThatOfItsKind) {
  const PlausibilityOptions options{
      .tolerance = 1e-3, .pairs = 256, .angles = 7, .azimuths = 2, .most_nodes = 100'000, .with_mean_albedo = false};
  const Plausibility found = check_plausibility(device(), subject_.given, options);
  const Reflectance& known = subject_.known;
  const Plausibility expected = known.formula() != nullptr    ? check_plausibility(device(), *known.formula(), options)
                                : known.function() != nullptr ? check_plausibility(*known.function(), options)
                                                              : check_plausibility(*known.table());
  EXPECT_EQ(found.grid.has_value(), known.formula() == nullptr);
  ASSERT_EQ(found.channels.size(), expected.channels.size());
  EXPECT_EQ(found.is_plausible(), expected.is_plausible());
  for (std::size_t c = 0; c < found.channels.size(); ++c) {
    expect_same(found.channels[c].least.value, expected.channels[c].least.value);
    expect_same(found.channels[c].albedo.largest, expected.channels[c].albedo.largest);
    EXPECT_EQ(found.channels[c].reciprocity.relative, expected.channels[c].reciprocity.relative) << c;
  }
}

TEST_P(Verbs, SamplesAreThoseOfItsFormulasOrItsTable) {
  const Reflectance own = subject_.known.formula() != nullptr ? subject_.known : Reflectance(own_table(subject_.known));
  const auto found = sample(device(), subject_.given, {0.5, 0.2}, 64);
  const auto expected = sample(device(), own, {0.5, 0.2}, 64);
  expect_same(found.weights, expected.weights);
  expect_same(found.density, expected.density);
  EXPECT_EQ(found.grid.has_value(), subject_.known.formula() == nullptr);
  const auto mean = sampled_albedo(device(), subject_.given, {0.5, 0.2}, 64);
  expect_same(mean.albedo, sampled_albedo(device(), own, {0.5, 0.2}, 64).albedo);
  const std::vector<std::array<double, 3>> directions{{0, 0, 1}, {0.6, 0, 0.8}};
  expect_same(sampling_density(device(), subject_.given, {0.5, 0.2}, directions),
              sampling_density(device(), own, {0.5, 0.2}, directions));
}

TEST_P(Verbs, SphereIsThatOfItsKind) {
  const SphereOptions options{.size = 4, .tolerance = 0.05};
  const SphereImage found = render_sphere(device(), subject_.given, three_point_lights(), options);
  expect_same(found.radiance, render_sphere(device(), subject_.known, three_point_lights(), options).radiance);
  EXPECT_GT(found.radiance.maxCoeff(), 0);
}

TEST_P(Verbs, TableIsThatOfItsKind) {
  const auto grid = HemisphereGrid::gauss(6, 12);
  const TabulateOptions options{.allow_unresolved = true};
  const BrdfTable found = tabulate(device(), subject_.given, grid, options);
  const Reflectance& known = subject_.known;
  expect_same(found, known.formula() != nullptr    ? tabulate(device(), *known.formula(), grid, options)
                     : known.function() != nullptr ? tabulate(*known.function(), grid, options)
                                                   : resample(*known.table(), grid));
  if (known.table() == nullptr) return;
  expect_same(tabulate(device(), subject_.given, natural_grid(subject_.given)), *known.table());
}

TEST_P(Verbs, FunctionIsThatOfItsKind) {
  const Reflectance& known = subject_.given.function() != nullptr ? subject_.given : subject_.known;
  if (known.has_delta() && known.function() == nullptr) {
    EXPECT_THROW((void)as_function(device(), subject_.given), ArgumentError);
    return;
  }
  const BrdfFunction found = as_function(device(), subject_.given);
  const BrdfFunction expected = known.formula() != nullptr ? as_function(device(), *known.formula())
                                : known.table() != nullptr ? as_function(*known.table())
                                                           : *known.function();
  EXPECT_EQ(found.channels, expected.channels);
  expect_same(found.at(kPairs).value, expected.at(kPairs).value);
}

TEST_P(Verbs, PairsHaveTheValuesOfEvaluate) {
  std::ofstream(directory_.path() / "pairs.csv") << "theta_in_rad,theta_out_rad,delta_phi_rad\n0.3,0.5,3\n";
  std::string text;
  const PairSummary summary = evaluate_pairs(device(), subject_.given, directory_.path() / "pairs.csv", text);
  EXPECT_EQ(summary.pairs, 1U);
  const Directions pair{0.3, 0.5, 3};
  const BrdfValues expected = evaluate(device(), subject_.given, {&pair, 1});
  const std::string row = text.substr(text.find('\n') + 1);
  std::istringstream words(row);
  std::vector<double> numbers;
  for (std::string word; std::getline(words, word, ',');) numbers.push_back(std::stod(word));
  ASSERT_EQ(numbers.size(), static_cast<std::size_t>(3 + expected.value.cols() + expected.error.cols()));
  // Nodes of formulas are made several at a time, right to four ulps (NodeMaking), which models multiply.
  const double share = subject_.given.formula() != nullptr ? 1e-14 : 0;
  for (Eigen::Index c = 0; c < expected.value.cols(); ++c) {
    EXPECT_NEAR(numbers[static_cast<std::size_t>(3 + c)], expected.value(0, c), share * std::abs(expected.value(0, c)))
        << c;
  }
}

TEST_P(Verbs, CurvesAreThoseOfWhatItIsKnownAs) {
  const CurveAngles angles{.theta = {0, 1}, .theta_in = {0.5}, .theta_out = {-0.5, 0.5}};
  const MaterialCurves found = material_curves(device(), subject_.given, angles);
  const MaterialCurves expected = material_curves(device(), subject_.known, angles);
  expect_same(found.albedo, expected.albedo);
  EXPECT_EQ(found.has_delta, subject_.known.has_delta());
}

TEST_P(Verbs, RepairsAreThoseOfItsTable) {
  const auto grid = HemisphereGrid::gauss(6, 12);
  const RepairGrid where{.grid = grid, .tabulation = {.allow_unresolved = true}};
  const BrdfTable own = tabulate(device(), subject_.known, grid, where.tabulation);
  expect_same(normalise(device(), subject_.given, where), normalise(own));
  const BrdfTable symmetric = symmetrise(device(), subject_.given, where);
  expect_same(symmetric, symmetrise(own));
  expect_same(scale_symmetrically(device(), symmetric).table, scale_symmetrically(symmetrise(own)).table);
  EXPECT_EQ(displacement(device(), symmetric, symmetric).absolute.value, 0);
}

TEST_P(Verbs, PumpingUpMakesFormulasOfIsotropicFormulasAndTablesOfTheRest) {
  const RepairGrid where{.grid = HemisphereGrid::gauss(6, 12), .tabulation = {.allow_unresolved = true}};
  const PumpOptions options{.theta_in = {0.5}, .table = where};
  const Pumped pumped = pump(device(), subject_.given, Correction::g1, options);
  EXPECT_EQ(pumped.result.formula() != nullptr, subject_.known.formula() != nullptr && subject_.known.is_isotropic());
  ASSERT_EQ(pumped.steps.size(), 2U);
  ASSERT_EQ(pumped.steps.front().albedo.front().size(), pumped.theta_in.size());
  const auto before = pumped.steps.front().albedo.front().front();
  const auto after = pumped.steps.back().albedo.front().front();
  EXPECT_GE(after.value, before.value - before.error - after.error);
}

TEST_P(Verbs, IsExportedWithItsValuesOrRefused) {
  const auto path = directory_.path() / "exported.csv";
  if (subject_.known.has_delta()) {
    EXPECT_THROW(save_measured(device(), subject_.given, "csv", path), ArgumentError);
    return;
  }
  save_measured(device(), subject_.given, "csv", path);
  const auto own = directory_.path() / "own.csv";
  save_measured(device(), subject_.known, "csv", own);
  EXPECT_EQ(deviation(device(), load_measured(path), load_measured(own)).rms, 0);
  constexpr double kCoarse = 0.2;  // between samples, and across the steps of cells
  EXPECT_LT(deviation(device(), subject_.known, load_measured(path)).median, kCoarse);
}

TEST_P(Verbs, ProductsAndCompositionsTakeItUnprepared) {
  const Reflectance grey = parse_material("lambert:scale=0.5");
  const auto found = scalar_product(device(), subject_.given, grey, Lighting::daylight(), {.tolerance = 1e-3});
  EXPECT_GT(found.value, 0);
  if (subject_.known.has_delta()) return;
  const Directions pair{0.3, 0.5, 3};
  const auto composed = composition_at(device(), subject_.given, grey, {&pair, 1}, {.tolerance = 1e-3}).front().front();
  // Behind a Lambertian reflectance everything is its albedo.
  const double expected = albedo(device(), subject_.known, std::array{0.3}).front().front().value * 0.5 / pi;
  EXPECT_NEAR(composed.value, expected, 0.02 * expected + composed.error);
}

INSTANTIATE_TEST_SUITE_P(OfEveryKind, Verbs, ::testing::ValuesIn(kinds()),
                         [](const auto& kind) { return kind.param.name; });

/// Files that lobe does not write.
class VerbsOfMeasuredFiles : public ::testing::Test {};

TEST_F(VerbsOfMeasuredFiles, TakeAnRglFile) {
  const auto path = measured_data("rgl_bsdf/vch_golden_yellow_rgb.bsdf");
  if (path.empty()) GTEST_SKIP() << kNoData;
  const Subject rgl = file(path);
  expect_same(evaluate(device(), rgl.given, kPairs).value, rgl.known.function()->at(kPairs).value);
  expect_same(albedo(device(), rgl.given, kVerbAngles), albedo(*rgl.known.function(), kVerbAngles));
  const auto samples = sample(device(), rgl.given, {0.5, 0.2}, 64);
  expect_same(samples.weights, sample(device(), own_table(rgl.known), {0.5, 0.2}, 64).weights);
  EXPECT_EQ(check_plausibility(device(), rgl.given).is_plausible(),
            check_plausibility(*rgl.known.function()).is_plausible());
}

}  // namespace
}  // namespace lobe::test
