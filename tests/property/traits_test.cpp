// Whether the traits that the catalogue declares are what is found of its models, by a search that costs little, and
// what docs/plausibility.md says of them, by a closer one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "lobe/energy/plausibility.hpp"
#include "lobe/model/model.hpp"
#include "model/catalogue.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

/// What the page says of a property of a model, as printed.
struct Cell {
  std::string text;
  [[nodiscard]] bool is_violation() const { return text.starts_with("**"); }
  [[nodiscard]] bool is_growth() const { return text.find("(N.L)^-") != std::string::npos; }
  /// The number and its error, as printed; an exponent without its sign.
  [[nodiscard]] Estimate estimate() const {
    static const std::regex pattern(R"((?:\(N\.L\)\^-)?(-?[0-9.]+(?:e[-+][0-9]+)?)(?: ± ([-+0-9.e]+))?)");
    std::smatch found;
    if (!std::regex_search(text, found, pattern)) return {NAN, NAN};
    return {std::stod(found[1]), found[2].matched ? std::stod(found[2]) : 0};
  }
  [[nodiscard]] Material material() const {
    const auto start = text.find('`') + 1;
    return parse_material(text.substr(start, text.rfind('`') - start));
  }
};

struct Row {
  std::string model;
  Cell albedo;
  Cell value;
  Cell reciprocity;
};

std::vector<Row> page_rows() {
  std::vector<Row> rows;
  std::istringstream page(read_text(LOBE_DOCS_DIR "/plausibility.md"));
  static const std::regex pattern(R"(\| (\w+) \| (.* of `.*`) \| (.*) \| (.*) \|)");
  for (std::string line; std::getline(page, line);) {
    std::smatch cells;
    if (!std::regex_match(line, cells, pattern)) continue;
    rows.push_back({cells[1], {cells[2]}, {cells[3]}, {cells[4]}});
  }
  return rows;
}

Row row_of(const std::string& model) {
  const auto rows = page_rows();
  const auto found = std::ranges::find(rows, model, &Row::model);
  return found == rows.end() ? Row{} : *found;
}

/// Albedos to a hundredth at few angles, values as for the page; for the costliest models the materials that come
/// first.
const CatalogueOptions kLittle{
    .material =
        {.tolerance = 1e-2, .pairs = 1024, .angles = 7, .azimuths = 2, .most_nodes = 50'000, .with_mean_albedo = false},
    .random = 0,
    .nodes = 1'500'000,
    .is_pursued = false};

/// What few angles miss of the largest albedo.
constexpr double kFewAngles = 0.01;

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const Model& model : catalogue()) names.emplace_back(model.name);
  return names;
}

class CatalogueTraits : public ::testing::TestWithParam<std::string> {};

TEST_P(CatalogueTraits, AreNotDeclaredWhereThePageShowsAViolation) {
  const Row row = row_of(GetParam());
  ASSERT_EQ(row.model, GetParam()) << "write the page anew: lobe check --catalogue > docs/plausibility.md";
  const Traits& traits = find_model(GetParam()).traits;

  EXPECT_EQ(row.albedo.is_violation(), !traits.conserves_energy) << row.albedo.text;
  EXPECT_EQ(row.value.is_violation(), !traits.non_negative) << row.value.text;
  EXPECT_EQ(row.reciprocity.is_violation(), !traits.reciprocal) << row.reciprocity.text;
}

TEST_P(CatalogueTraits, AreKeptOverTheRangesOfTheParametersAndNothingIsWorseThanOnThePage) {
  const Traits& traits = find_model(GetParam()).traits;
  const Row row = row_of(GetParam());

  const ModelPlausibility found = check_model(device(), GetParam(), kLittle);

  EXPECT_TRUE(found.conserves_energy || !traits.conserves_energy) << found.albedo.material.name;
  EXPECT_TRUE(found.is_non_negative || !traits.non_negative) << found.least.material.name;
  EXPECT_TRUE(found.is_reciprocal || !traits.reciprocal) << found.reciprocity.material.name;
  const AlbedoBound& bound = found.albedo.found.albedo;
  const Estimate page = row.albedo.estimate();
  if (row.albedo.is_growth()) {
    const Estimate growth = bound.growth.value_or(Estimate{});
    EXPECT_LE(growth.value - growth.error, page.value + page.error) << found.albedo.material.name;
  } else {
    EXPECT_FALSE(bound.growth) << found.albedo.material.name;
    EXPECT_LE(bound.largest.value - bound.largest.error, page.value + page.error) << found.albedo.material.name;
  }
}

INSTANTIATE_TEST_SUITE_P(property, CatalogueTraits, ::testing::ValuesIn(model_names()),
                         [](const auto& instance) { return instance.param; });

std::vector<std::string> models_that_violate_something() {
  std::vector<std::string> names;
  for (const Model& model : catalogue()) {
    const Traits& traits = model.traits;
    if (!(traits.conserves_energy && traits.non_negative && traits.reciprocal)) names.emplace_back(model.name);
  }
  return names;
}

class Violation : public ::testing::TestWithParam<std::string> {};

TEST_P(Violation, IsWhatThePageSaysOfTheMaterial) {
  const Row row = row_of(GetParam());
  constexpr double kTwoDigits = 0.05;
  const auto checked = [](const Cell& cell) {
    const Material material = cell.material();
    const Term& term = material.terms.front();
    PlausibilityOptions options = kLittle.material;
    // Lobes that half a turn changes may be worst on one side alone.
    if (!find_entry(term.model).shape(term.values).half_turn) options.azimuths = PlausibilityOptions{}.azimuths;
    return check_plausibility(device(), material, options).channels.at(0);
  };

  if (row.albedo.is_violation()) {
    const auto found = checked(row.albedo);
    const Estimate page = row.albedo.estimate();
    EXPECT_FALSE(found.conserves_energy);
    ASSERT_EQ(found.albedo.growth.has_value(), row.albedo.is_growth());
    const Estimate measured = found.albedo.growth.value_or(found.albedo.largest);
    EXPECT_NEAR(measured.value, page.value, measured.error + page.error + kFewAngles * page.value);
  }
  if (row.value.is_violation()) {
    const auto found = checked(row.value);
    EXPECT_FALSE(found.is_non_negative);
    EXPECT_NEAR(found.least.value.value / row.value.estimate().value, 1, kTwoDigits);
  }
  if (row.reciprocity.is_violation()) {
    const auto found = checked(row.reciprocity);
    EXPECT_FALSE(found.is_reciprocal);
    EXPECT_NEAR(found.reciprocity.relative / row.reciprocity.estimate().value, 1, kTwoDigits);
  }
}

INSTANTIATE_TEST_SUITE_P(property, Violation, ::testing::ValuesIn(models_that_violate_something()),
                         [](const auto& instance) { return instance.param; });

TEST(PlausibilityPage, HasNoOtherModelsThanTheCatalogue) {
  std::vector<std::string> on_page;
  for (const Row& row : page_rows()) on_page.push_back(row.model);

  EXPECT_EQ(on_page, model_names());
}

TEST(CheckedMaterials, AreWithinTheRangesAndReachTheirEnds) {
  for (const Model& model : catalogue()) {
    if (!model.traits.isotropic) continue;  // drawn-out lobes are left out
    const auto materials = checked_materials(model.name, 5);
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      const Parameter& parameter = model.parameters[i];
      std::vector<double> values;
      for (const auto& material : materials) values.push_back(material.terms.at(0).values.at(i));
      const auto [least, largest] = std::ranges::minmax(values);
      EXPECT_EQ(least, parameter.minimum) << model.name << " " << parameter.name;
      const double end = std::isinf(parameter.maximum) ? std::max(parameter.minimum, 1e6) : parameter.maximum;
      EXPECT_EQ(largest, end) << model.name << " " << parameter.name;
    }
  }
}

TEST(CheckedMaterials, AreAsManyMoreAsAskedForAtRandomAndTheSameAgain) {
  const auto few = checked_materials("exponential_patch_anisotropic", 0);
  const auto more = checked_materials("exponential_patch_anisotropic", 4);
  const auto again = checked_materials("exponential_patch_anisotropic", 4);

  ASSERT_EQ(more.size(), few.size() + 4);
  EXPECT_EQ(more.back().name, again.back().name);
}

}  // namespace
}  // namespace lobe::test
