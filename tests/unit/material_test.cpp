#include "lobe/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "lobe/error.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

TEST(ParseMaterial, ReadsAModelWithoutParameters) {
  const auto material = parse_material("lambert");

  EXPECT_EQ(material.name, "lambert");
  EXPECT_EQ(material.family, "Lambert");
  ASSERT_EQ(material.terms.size(), 1U);
  EXPECT_EQ(material.terms[0].model, "lambert");
  EXPECT_TRUE(material.terms[0].values.empty());
  EXPECT_EQ(material.terms[0].weight, std::vector<double>{1.0});
}

TEST(ParseMaterial, PutsParametersInTheOrderOfTheCatalogue) {
  const auto material = parse_material("lafortune:n=20,c_z=0.9,c_xy=-1");

  EXPECT_EQ(material.terms.at(0).values, (std::vector<double>{-1, 0.9, 20}));
}

TEST(ParseMaterial, TakesDefaultsOfTheCatalogue) {
  EXPECT_EQ(parse_material("cook_torrance:m=0.3").terms.at(0).values, (std::vector<double>{0.3, 1}));
  EXPECT_EQ(parse_material("oren_nayar:sigma=0.5").terms.at(0).values, (std::vector<double>{0.5, 0.33}));
}

TEST(ParseMaterial, TakesScaleAsTheWeight) {
  EXPECT_EQ(parse_material("ward:m=0.1,scale=0.5").terms.at(0).weight, std::vector<double>{0.5});
}

TEST(ParseMaterial, JoinsTermsWithPlus) {
  const auto material = parse_material("lambert:scale=0.3 + ward:m=0.1,scale=0.5");

  ASSERT_EQ(material.terms.size(), 2U);
  EXPECT_EQ(material.terms[0].model, "lambert");
  EXPECT_EQ(material.terms[1].model, "ward");
  EXPECT_EQ(material.name, "lambert:scale=0.3 + ward:m=0.1,scale=0.5");
}

TEST(ParseMaterial, DoesNotSplitAtThePlusOfANumber) {
  EXPECT_EQ(parse_material("phong:n=1e+3+lambert").terms.size(), 2U);
  EXPECT_EQ(parse_material("phong:n=1e+3").terms.at(0).values, std::vector<double>{1000});
  EXPECT_EQ(parse_material("phong:n=+20").terms.at(0).values, std::vector<double>{20});
}

TEST(ParseMaterial, IgnoresBlanks) {
  EXPECT_EQ(parse_material("  ward : m = 0.1 , scale = 2 ").terms.at(0).values, std::vector<double>{0.1});
}

struct BadSpecification {
  std::string name;
  std::string text;
  std::string message;  ///< a piece of it
};
std::ostream& operator<<(std::ostream& out, const BadSpecification& bad) {
  return out << bad.name;
}

class BadMaterial : public ::testing::TestWithParam<BadSpecification> {};

TEST_P(BadMaterial, IsAnArgumentErrorThatSaysWhy) {
  try {
    (void)parse_material(GetParam().text);
    FAIL() << "expected ArgumentError";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    material, BadMaterial,
    ::testing::Values(BadSpecification{"empty", "", "MODEL[:key=value,...]"},
                      BadSpecification{"blank", "  ", "MODEL[:key=value,...]"},
                      BadSpecification{"unknown_model", "wrad:m=0.1", "did you mean 'ward'?"},
                      BadSpecification{"unknown_parameter", "cook_torrance:m=0.3,f=1", "has no parameter 'f'"},
                      BadSpecification{"misspelt_parameter", "oren_nayar:sigmma=0.3", "did you mean 'sigma'?"},
                      BadSpecification{"parameter_of_none", "lambert:n=1", "has no parameter 'n'; it takes none"},
                      BadSpecification{"missing_parameter", "ward", "needs the parameter 'm'"},
                      BadSpecification{"given_twice", "ward:m=0.1,m=0.2", "given twice"},
                      BadSpecification{"below_range", "ward:m=0", "expected a value in"},
                      BadSpecification{"above_range", "oren_nayar:sigma=3", "expected a value in"},
                      BadSpecification{"negative_exponent", "phong:n=-2", "'n'"},
                      BadSpecification{"not_a_number", "ward:m=rough", "'rough'"},
                      BadSpecification{"nan", "ward:m=nan", "finite"},
                      BadSpecification{"infinite", "phong:n=inf", "finite"},
                      BadSpecification{"number_with_unit", "oren_nayar:sigma=0.5rad", "'0.5rad'"},
                      BadSpecification{"no_value", "ward:m=", "'m'"},
                      BadSpecification{"no_equals", "ward:m", "MODEL[:key=value,...]"},
                      BadSpecification{"no_key", "ward:=0.1", "MODEL[:key=value,...]"},
                      BadSpecification{"colon_without_parameters", "ward:", "MODEL[:key=value,...]"},
                      BadSpecification{"trailing_comma", "ward:m=0.1,", "MODEL[:key=value,...]"},
                      BadSpecification{"empty_term", "ward:m=0.1+", "unknown model ''"},
                      BadSpecification{"scale_infinite", "lambert:scale=inf", "finite"},
                      BadSpecification{"scale_twice", "lambert:scale=1,scale=2", "given twice"}),
    ByName{});

TEST(MakeMaterial, IsWhatItsSpecificationParsesTo) {
  const auto made = make_material("lafortune", {{"c_xy", -1}, {"c_z", 0.8}, {"n", 10}});

  const auto parsed = parse_material(made.name);

  ASSERT_EQ(made.terms.size(), 1U);
  EXPECT_EQ(made.terms[0].values, parsed.terms.at(0).values);
  EXPECT_EQ(made.family, parsed.family);
}

TEST(MakeMaterial, RejectsAValueOutOfRange) {
  EXPECT_THROW((void)make_material("ward", {{"m", -1.0}}), ArgumentError);
}

TEST(MakeMaterial, RejectsAMissingParameter) {
  EXPECT_THROW((void)make_material("ward"), ArgumentError);
}

TEST(MaterialChannels, AreTheLargestNumberOfWeights) {
  const Material material{"rgb", "", {{"lambert", {}, {0.1, 0.2, 0.3}}, {"phong", {20}, {0.5}}}};

  EXPECT_EQ(material.channels(), 3U);
}

TEST(MaterialJson, NamesModelParametersAndWeights) {
  const auto json = nlohmann::json::parse(to_json(parse_material("lambert:scale=0.25+ward:m=0.1")));

  EXPECT_EQ(json.at("name"), "lambert:scale=0.25+ward:m=0.1");
  EXPECT_EQ(json.at("terms").size(), 2U);
  EXPECT_EQ(json.at("terms").at(0).at("weight"), nlohmann::json({0.25}));
  EXPECT_EQ(json.at("terms").at(1).at("model"), "ward");
  EXPECT_EQ(json.at("terms").at(1).at("parameters").at("m"), 0.1);
}

TEST(MaterialJson, ReadsBackBitForBit) {
  Material material = parse_material("lambert:scale=0.1+ward:m=0.30000000000000004");
  material.name = "Größe \"x\"\n";
  material.terms[0].weight = {0.1, 1.0 / 3, 5e-324};
  const Material read = material_from_json(to_json(material));
  EXPECT_EQ(read.name, material.name);
  EXPECT_EQ(read.family, "mixture");
  ASSERT_EQ(read.terms.size(), 2U);
  EXPECT_EQ(read.terms[0].weight, material.terms[0].weight);
  EXPECT_EQ(read.terms[1].model, "ward");
  EXPECT_EQ(read.terms[1].values, material.terms[1].values);
}

TEST(MaterialJson, ReplacesBytesThatAreNoUtf8) {
  Material material = make_material("lambert");
  material.name = std::string(2, '\xff');
  EXPECT_EQ(material_from_json(to_json(material)).name, "\ufffd\ufffd");
}

TEST(MaterialJson, RefusesWhatIsNoMaterial) {
  EXPECT_THROW((void)material_from_json("{"), ArgumentError);
  EXPECT_THROW((void)material_from_json("[]"), ArgumentError);
  EXPECT_THROW((void)material_from_json(R"({"name": "x", "family": "", "terms": []})"), ArgumentError);
  EXPECT_THROW((void)material_from_json(
                   R"({"name": "x", "family": "", "terms": [{"model": "lambert", "parameters": {}, "weight": []}]})"),
               ArgumentError);
  EXPECT_THROW(
      (void)material_from_json(
          R"({"name": "x", "family": "", "terms": [{"model": "ward", "parameters": {"m": -1}, "weight": [1]}]})"),
      ArgumentError);
}

}  // namespace
}  // namespace lobe::test
