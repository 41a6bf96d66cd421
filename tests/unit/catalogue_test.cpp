#include "model/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "model/constants.hpp"
#include "reference/models.hpp"

namespace lobe::test {
namespace {

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const auto& model : catalogue()) names.emplace_back(model.name);
  return names;
}

TEST(Catalogue, IsInAlphabeticalOrderWithoutDuplicates) {
  const auto names = model_names();
  const std::set<std::string> sorted(names.begin(), names.end());

  EXPECT_EQ(names, std::vector<std::string>(sorted.begin(), sorted.end()));
}

class CatalogueModel : public ::testing::TestWithParam<std::string> {};

TEST_P(CatalogueModel, IsFoundByItsName) {
  EXPECT_EQ(find_model(GetParam()).name, GetParam());
}

TEST_P(CatalogueModel, StatesFamilyFormulaAndSource) {
  const auto& model = find_model(GetParam());

  EXPECT_FALSE(model.family.empty());
  EXPECT_FALSE(model.formula.empty());
  EXPECT_THAT(std::string(model.source), ::testing::ContainsRegex("[12][0-9][0-9][0-9]")) << "no year in the source";
}

TEST_P(CatalogueModel, HasParametersWithUnitRangeAndDescription) {
  for (const auto& parameter : find_model(GetParam()).parameters) {
    SCOPED_TRACE(parameter.name);
    EXPECT_FALSE(parameter.unit.empty());
    EXPECT_FALSE(parameter.description.empty());
    EXPECT_LT(parameter.minimum, parameter.maximum);
    EXPECT_NE(parameter.name, "scale") << "reserved for the factor of a term";
    if (parameter.default_value) {
      EXPECT_GE(*parameter.default_value, parameter.minimum);
      EXPECT_LE(*parameter.default_value, parameter.maximum);
    }
  }
}

TEST_P(CatalogueModel, HasTypicalValuesWithinItsRanges) {
  const auto& entry = find_entry(GetParam());

  ASSERT_EQ(entry.typical.size(), entry.model.parameters.size());
  for (std::size_t k = 0; k < entry.typical.size(); ++k) {
    EXPECT_GE(entry.typical[k], entry.model.parameters[k].minimum) << entry.model.parameters[k].name;
    EXPECT_LE(entry.typical[k], entry.model.parameters[k].maximum) << entry.model.parameters[k].name;
  }
}

TEST_P(CatalogueModel, HasFiniteCoefficientsAndWidthAtTheEndsOfItsRanges) {
  const auto& entry = find_entry(GetParam());
  for (const bool at_maximum : {false, true}) {
    SCOPED_TRACE(at_maximum ? "maximum" : "minimum");
    std::vector<double> values;
    for (const auto& parameter : entry.model.parameters) {
      values.push_back(at_maximum ? parameter.maximum : parameter.minimum);
    }

    const auto coefficients = entry.coefficients(values);
    const double width = entry.shape(values).width;

    for (const double coefficient : coefficients) EXPECT_TRUE(std::isfinite(coefficient));
    EXPECT_GT(width, 0);
    EXPECT_LE(width, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(catalogue, CatalogueModel, ::testing::ValuesIn(model_names()),
                         [](const auto& instance) { return instance.param; });

TEST(FindModel, SuggestsTheNearestName) {
  try {
    (void)find_model("cook_torrence");
    FAIL() << "expected ArgumentError";
  } catch (const ArgumentError& error) {
    EXPECT_STREQ(error.what(), "unknown model 'cook_torrence'; did you mean 'cook_torrance'?");
  }
}

TEST(Catalogue, DefaultsAreThoseOfThePublications) {
  EXPECT_EQ(find_model("cook_torrance").parameters.at(1).default_value, 1.0);
  EXPECT_EQ(find_model("oren_nayar").parameters.at(1).default_value, 0.33);
  EXPECT_FALSE(find_model("ward").parameters.at(0).default_value.has_value());
}

TEST(Catalogue, TraitsTellWhatBreaksEnergyConservation) {
  EXPECT_TRUE(find_model("phong").traits.conserves_energy);
  EXPECT_TRUE(find_model("cook_torrance").traits.conserves_energy);
  EXPECT_FALSE(find_model("ward").traits.conserves_energy);
  EXPECT_FALSE(find_model("oren_nayar").traits.conserves_energy);
}

class BlinnConstant : public ::testing::TestWithParam<double> {};

TEST_P(BlinnConstant, IsTheClosedForm) {
  const double expected = static_cast<double>(reference::blinn_constant(static_cast<long double>(GetParam())));

  EXPECT_NEAR(blinn_constant(GetParam()), expected, 1e-14 * expected);
}

INSTANTIATE_TEST_SUITE_P(catalogue, BlinnConstant, ::testing::Values(0.001, 1, 2, 20, 512, 1e5));

}  // namespace
}  // namespace lobe::test
