#include "lobe/model/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "model/terms.hpp"
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

TEST(ParseMaterial, ReadsFactors) {
  const auto material = parse_material("phong:n=1e+3,scale=0.5 * cos_max * lacquer:s=0.2 + lambert");

  ASSERT_EQ(material.terms.size(), 2U);
  const auto& factors = material.terms[0].factors;
  ASSERT_EQ(factors.size(), 2U);
  EXPECT_EQ(factors[0].name, "cos_max");
  EXPECT_EQ(factors[0].values, std::vector<double>{1});
  EXPECT_EQ(factors[1].name, "lacquer");
  EXPECT_EQ(factors[1].values, std::vector<double>{0.2});
  EXPECT_EQ(material.terms[0].weight, std::vector<double>{0.5});
  EXPECT_TRUE(material.terms[1].factors.empty());
}

TEST(ParseMaterial, SplitsATermWhoseParametersDifferByChannel) {
  const auto material = parse_material("ward:m=0.1/0.2/0.3,scale=0.5/0.25/1*cos_max:p=0.5");

  ASSERT_EQ(material.terms.size(), 3U);
  EXPECT_EQ(material.channels(), 3U);
  EXPECT_EQ(material.family, "Ward");
  for (std::size_t c = 0; c < 3; ++c) {
    SCOPED_TRACE(c);
    EXPECT_EQ(material.terms[c].values, (std::vector{std::vector{0.1, 0.2, 0.3}[c]}));
    std::vector<double> weight(3, 0.0);
    weight[c] = std::vector{0.5, 0.25, 1.0}[c];
    EXPECT_EQ(material.terms[c].weight, weight);
    EXPECT_EQ(material.terms[c].factors.size(), 1U);
  }
}

TEST(ParseMaterial, KeepsATermWhoseParametersAgreeInAllChannels) {
  const auto material = parse_material("ward:m=0.1/0.1,scale=0.5/0.25");

  ASSERT_EQ(material.terms.size(), 1U);
  EXPECT_EQ(material.terms[0].weight, (std::vector{0.5, 0.25}));
}

TEST(ParseMaterial, ReadsAdjustmentsOfTheWhole) {
  const auto material = parse_material("lambert+phong:n=20@normalise");

  EXPECT_EQ(material.terms.size(), 2U);
  EXPECT_EQ(material.adjustments, std::vector{Adjustment{}});
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
                      BadSpecification{"empty_term", "ward:m=0.1+", "a part of one, is empty; expected MODEL"},
                      BadSpecification{"scale_infinite", "lambert:scale=inf", "finite"},
                      BadSpecification{"unknown_factor", "phong:n=20*cosmax", "did you mean 'cos_max'?"},
                      BadSpecification{"factor_out_of_range", "lambert*lacquer:s=-1",
                                       "parameter 's' of factor 'lacquer' is -1; expected a value in [0, 100]"},
                      BadSpecification{"factor_by_channel", "lambert*lacquer:s=1/2", "expected one"},
                      BadSpecification{"empty_factor", "lambert*", "unknown factor ''"},
                      BadSpecification{"too_many_factors", "lambert*cos_max*cos_max*cos_max*cos_max", "at most 3"},
                      BadSpecification{"channels_that_do_not_fit", "ggx:alpha=0.1/0.2,f0=0.1/0.2/0.3",
                                       "expected one, or one for each of the 3 channels"},
                      BadSpecification{"scale_that_does_not_fit", "ward:m=0.1/0.2,scale=1/1/1", "expected as many"},
                      BadSpecification{"unknown_adjustment", "lambert@normalize", "did you mean 'normalise'?"},
                      BadSpecification{"formula", "custom:n=1", "expected a material file"},
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

TEST(MaterialJson, RefusesFormulasAndCurvesThatDoNotFit) {
  const std::string head = R"({"name": "x", "family": "", "terms": [{"weight": [1], )";
  EXPECT_THROW((void)material_from_json(head + R"("model": "custom", "parameters": {"a": 1},
                   "formula": {"text": "cos_i", "width": 0.1, "reciprocal": false}}]})"),
               ArgumentError);
  EXPECT_THROW((void)material_from_json(head + R"("model": "lambert", "parameters": {},
                   "pumping": {"correction": "g1", "albedos": [[1, 2]]}}]})"),
               ArgumentError);
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
  material.name = "Größe \"x\"";
  material.terms[0].weight = {0.1, 1.0 / 3, 5e-324};
  const Material read = material_from_json(to_json(material));
  EXPECT_EQ(read.name, material.name);
  EXPECT_EQ(read.family, "mixture");
  ASSERT_EQ(read.terms.size(), 2U);
  EXPECT_EQ(read.terms[0].weight, material.terms[0].weight);
  EXPECT_EQ(read.terms[1].model, "ward");
  EXPECT_EQ(read.terms[1].values, material.terms[1].values);
}

TEST(MaterialJson, ReadsBackFactorsFormulasAndAdjustments) {
  Material material = parse_material("phong:n=20*fresnel:ior=0.2,k=3.4*cos_max@normalise");
  Term term{.model = std::string(kCustomModel), .values = {0.3, 2}, .weight = {1, 2}};
  term.formula = Formula{.text = "rho / pi * pow(cos_h, n)", .parameters = {"rho", "n"}, .width = 0.25};
  material.terms.push_back(term);
  const Material read = material_from_json(to_json(material));
  EXPECT_EQ(read.adjustments, material.adjustments);
  ASSERT_EQ(read.terms.size(), 2U);
  ASSERT_EQ(read.terms[0].factors.size(), 2U);
  EXPECT_EQ(read.terms[0].factors[0].name, "fresnel");
  EXPECT_EQ(read.terms[0].factors[0].values, (std::vector{0.2, 3.4}));
  ASSERT_TRUE(read.terms[1].formula);
  EXPECT_EQ(read.terms[1].formula->text, term.formula->text);
  EXPECT_EQ(read.terms[1].formula->parameters, term.formula->parameters);
  EXPECT_EQ(read.terms[1].formula->width, 0.25);
  EXPECT_TRUE(read.terms[1].formula->reciprocal);
  EXPECT_EQ(read.terms[1].values, term.values);
  EXPECT_EQ(read.terms[1].weight, term.weight);
  EXPECT_EQ(to_json(read), to_json(material));
}

TEST(MaterialJson, ReplacesBytesThatAreNoUtf8) {
  Material material = make_material("lambert");
  material.name = std::string(2, '\xff');
  EXPECT_EQ(material_from_json(to_json(material)).name, "\ufffd\ufffd");
}

TEST(MaterialJson, RefusesNamesWithControlCharacters) {
  for (const std::string name : {"a\nb", "\x1b[2J", "a\tb", "\x7f", "\u009b"}) {
    SCOPED_TRACE(name);
    Material material = make_material("lambert");
    material.name = name;
    EXPECT_THROW((void)material_from_json(to_json(material)), ArgumentError);
    material.name = "plain";
    material.family = name;
    EXPECT_THROW((void)material_from_json(to_json(material)), ArgumentError);
  }
}

TEST(CustomTerm, HasFiniteParameters) {
  const Formula formula{.text = "n / pi", .parameters = {"n"}};
  EXPECT_NO_THROW((void)make_custom_term(formula, {1}));
  for (const double value : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    SCOPED_TRACE(value);
    EXPECT_THROW((void)make_custom_term(formula, {value}), ArgumentError);
  }
}

TEST(MaterialJson, RefusesFormulasThatAreNone) {
  Material material = make_material("lambert");
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1}};
  term.formula = Formula{.text = "1.0); const pack y = (2.0", .parameters = {}};
  material.terms = {term};
  try {
    (void)material_from_json(to_json(material));
    FAIL() << "expected ArgumentError";
  } catch (const ArgumentError& error) {
    EXPECT_STREQ(error.what(), "formula:1:4: unexpected ')'; expected an operator or the end of the formula");
  }
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
