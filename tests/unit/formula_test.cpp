// The language of formulas: what is understood, as which tree, and what is refused, where.
#include "model/formula.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <random>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/formula_tree.hpp"
#include "support/hostile_formulas.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kParameters{"n", "rho"};

FormulaTree tree_of(const std::string& text) {
  return read_formula_tree({.text = text, .parameters = kParameters});
}

/// With parentheses where they are needed only.
std::string canonical(const std::string& text) {
  return canonical_text(tree_of(text), kParameters);
}

std::string complaint_about(const Formula& formula) {
  try {
    require_valid(formula);
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "none";
}

/// Of a text that stands in a file from line 10, column 5 on.
std::string complaint_on(const std::string& text) {
  try {
    static_cast<void>(
        read_formula_tree({.text = text, .parameters = kParameters, .file = "mine.toml", .line = 10, .column = 5}));
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "none";
}

TEST(FormulaText, IsWrittenWithTheParenthesesThatItNeeds) {
  EXPECT_EQ(canonical("rho*(n+2)/(2*pi)*exp(n*log_rv)"), "rho * (n + 2) / (2 * pi) * exp(n * log_rv)");
  EXPECT_EQ(canonical("((1.50))+((2))*3e0"), "1.5 + 2 * 3");
  EXPECT_EQ(canonical("1-(2-3)-4"), "1 - (2 - 3) - 4");
  EXPECT_EQ(canonical("1/(2*3)/4"), "1 / (2 * 3) / 4");
  EXPECT_EQ(canonical("-(1+2)*-3"), "-(1 + 2) * -3");
  EXPECT_EQ(canonical("- - +n--1"), "--n - -1");
  EXPECT_EQ(canonical("where((1<2||!(2>3))&&3<=4,n,rho)"), "where((1 < 2 || !(2 > 3)) && 3 <= 4, n, rho)");
  EXPECT_EQ(canonical("where(1==2||3!=4&&n>=1,1,2)"), "where(1 == 2 || 3 != 4 && n >= 1, 1, 2)");
}

TEST(FormulaText, BindsAsInC) {
  EXPECT_EQ(tree_of("1 + 2 * 3"), tree_of("1 + (2 * 3)"));
  EXPECT_EQ(tree_of("1 - 2 - 3"), tree_of("(1 - 2) - 3"));
  EXPECT_EQ(tree_of("6 / 2 / 3"), tree_of("(6 / 2) / 3"));
  EXPECT_EQ(tree_of("-n * rho"), tree_of("(-n) * rho"));
  EXPECT_EQ(tree_of("where(1 < 2 && 3 < 4 || 5 < 6, 1, 2)"), tree_of("where(((1 < 2) && (3 < 4)) || (5 < 6), 1, 2)"));
  EXPECT_EQ(tree_of("where(!(1 < 2) && 3 < 4, 1, 2)"), tree_of("where((!(1 < 2)) && (3 < 4), 1, 2)"));
  EXPECT_EQ(tree_of("where(1 + 2 < 3 * 4, 1, 2)"), tree_of("where((1 + 2) < (3 * 4), 1, 2)"));
  EXPECT_NE(tree_of("1 - 2 - 3"), tree_of("1 - (2 - 3)"));
}

TEST(FormulaText, HasNumbersAsInC) {
  EXPECT_EQ(tree_of(".5"), tree_of("0.5"));
  EXPECT_EQ(tree_of("5."), tree_of("5"));
  EXPECT_EQ(tree_of("2.5e-1"), tree_of("0.25"));
  EXPECT_EQ(tree_of("1E+2"), tree_of("100"));
  EXPECT_EQ(tree_of("010"), tree_of("10"));
  EXPECT_EQ(tree_of("0.1").parts.at(0).number, 0.1);
  EXPECT_EQ(tree_of("4.9406564584124654e-324").parts.at(0).number, 5e-324);
  EXPECT_EQ(canonical("1.7976931348623157e308"), "1.7976931348623157e+308");
}

TEST(FormulaText, MayBreakLinesAnywhere) {
  EXPECT_EQ(tree_of("\n rho\t*\r\n exp\n(\nn )\n"), tree_of("rho*exp(n)"));
}

TEST(FormulaText, HasItsLimitsInside) {
  const auto nested = [](std::size_t depth) { return repeated("(", depth) + "1" + repeated(")", depth); };
  EXPECT_EQ(tree_of(nested(kFormulaDepth)), tree_of("1"));
  EXPECT_THAT(complaint_on(nested(kFormulaDepth + 1)), HasSubstr("mine.toml:10:105: parentheses, calls and signs"));
  EXPECT_EQ(tree_of(repeated("1+", 499) + "1").parts.size(), 999U);
  EXPECT_THAT(complaint_on(repeated("1+", 500) + "1"), HasSubstr("more than 1000 numbers, names and operations"));
  EXPECT_EQ(tree_of(repeated(" ", kFormulaLength - 1) + "1"), tree_of("1"));
  EXPECT_THAT(complaint_on(repeated(" ", kFormulaLength) + "1"), HasSubstr("has 10001 characters; expected at most"));
}

TEST(FormulaText, SaysWhereItIsWrong) {
  EXPECT_EQ(complaint_on("rho / pi *\n  cos_in"), "mine.toml:11:3: unknown name 'cos_in'; did you mean 'cos_i'?");
  EXPECT_EQ(complaint_on("rho * cos_in"), "mine.toml:10:11: unknown name 'cos_in'; did you mean 'cos_i'?");
  EXPECT_EQ(complaint_on("n + sqr(n)"), "mine.toml:10:9: unknown function 'sqr'; did you mean 'sqrt'?");
  EXPECT_EQ(complaint_on("abs(n)"), "mine.toml:10:5: unknown function 'abs'; did you mean 'fabs'?");
  EXPECT_EQ(complaint_on("ln(n)"), "mine.toml:10:5: unknown function 'ln'; did you mean 'log'?");
  EXPECT_THAT(complaint_on("get_global_id(0)"), HasSubstr("10:5: unknown function 'get_global_id'; docs/formulas.md"));
  EXPECT_THAT(complaint_on("zzzzz"), HasSubstr("10:5: unknown name 'zzzzz'; known: n, rho, cos_i"));
  EXPECT_EQ(complaint_on("n(2)"),
            "mine.toml:10:5: parameter 'n' is no function; expected an operator such as '*' after it");
  EXPECT_EQ(complaint_on("exp + 1"), "mine.toml:10:5: function 'exp' without arguments; expected '(' after it");
  EXPECT_EQ(complaint_on("1.0f"),
            "mine.toml:10:8: number 1.0 has the suffix 'f'; expected none, formulas are computed in double precision");
  EXPECT_THAT(complaint_on("0x1f"), HasSubstr("10:6: hexadecimal numbers are not understood"));
  EXPECT_THAT(complaint_on("1e999"), HasSubstr("10:5: number 1e999 is out of range"));
  EXPECT_THAT(complaint_on("1.2.3"), HasSubstr("10:8: number 1.2 is followed by '.'"));
  EXPECT_EQ(complaint_on("n ^ 2"),
            "mine.toml:10:7: unexpected '^'; expected an operator or the end of the formula (powers are pow(a, b))");
  EXPECT_THAT(complaint_on("cos_i > 0 ? 1 : 2"), HasSubstr("(choices are where(condition, a, b))"));
  EXPECT_THAT(complaint_on("1 // two"), HasSubstr("10:7: unexpected '/'; expected an operator or the end of the "
                                                  "formula (a formula has no comments)"));
  EXPECT_EQ(complaint_on("(1 + 2"), "mine.toml:10:11: the formula ends here; expected an operator or ')'");
  EXPECT_EQ(complaint_on("1 +"), "mine.toml:10:8: the formula ends here; expected a number, a name, a sign or '('");
  EXPECT_EQ(complaint_on("2 n"), "mine.toml:10:7: unexpected name 'n'; expected an operator or the end of the formula");
  EXPECT_THAT(complaint_on(std::string("1\0", 2)), HasSubstr("10:6: unexpected '\\x00'"));
  EXPECT_THAT(complaint_on("1\x1b[2J"), HasSubstr("10:6: unexpected '\\x1b'"));
  EXPECT_THAT(complaint_on("2 × n"), HasSubstr("10:7: unexpected '×'"));
  EXPECT_THAT(complaint_on("n + \xff"), HasSubstr("10:9: unexpected '\\xff'"));
  EXPECT_THAT(complaint_on(""), HasSubstr("formula is empty; expected an expression such as \"rho / pi\""));
}

TEST(FormulaText, ThatStandsInNoFileSaysItsPlaceAllTheSame) {
  EXPECT_EQ(complaint_about({.text = "1 +\n+ )", .parameters = {}}),
            "formula:2:3: unexpected ')'; expected a number, a name, a sign or '('");
}

TEST(FormulaText, TellsConditionsFromNumbers) {
  EXPECT_THAT(complaint_on("(cos_i > 0) * 2"), HasSubstr("10:5: a condition stands where a number is expected"));
  EXPECT_THAT(complaint_on("2 * (cos_i > 0)"), HasSubstr("10:9: a condition stands where a number is expected"));
  EXPECT_THAT(complaint_on("cos_i < cos_o < 1"), HasSubstr("10:5: a condition stands"));
  EXPECT_THAT(complaint_on("cos_i > 0"), HasSubstr("10:5: a condition stands"));
  EXPECT_THAT(complaint_on("exp(cos_i > 0)"), HasSubstr("10:9: a condition stands"));
  EXPECT_THAT(complaint_on("-(cos_i > 0)"), HasSubstr("10:6: a condition stands"));
  EXPECT_THAT(complaint_on("where(1, 2, 3)"), HasSubstr("10:11: a number stands where a condition is expected"));
  EXPECT_THAT(complaint_on("where(cos_i > 0 && 1, 2, 3)"), HasSubstr("10:24: a number stands"));
  EXPECT_THAT(complaint_on("where(!n, 2, 3)"), HasSubstr("10:12: a number stands"));
  EXPECT_THAT(complaint_on("where(1 < 2, 1 < 2, 3)"), HasSubstr("10:18: a condition stands"));
}

TEST(FormulaText, CountsArguments) {
  EXPECT_EQ(complaint_on("exp()"), "mine.toml:10:9: function 'exp' is given no arguments; expected one argument");
  EXPECT_EQ(complaint_on("exp(1, 2)"),
            "mine.toml:10:10: function 'exp' is given more arguments than that; expected one argument");
  EXPECT_EQ(complaint_on("1 + pow(1)"), "mine.toml:10:9: function 'pow' is given 1 argument; expected 2 arguments");
  EXPECT_EQ(complaint_on("clamp(1, 2)"), "mine.toml:10:5: function 'clamp' is given 2 arguments; expected 3 arguments");
  EXPECT_EQ(complaint_on("where(1 < 2, 3)"),
            "mine.toml:10:5: function 'where' is given 2 arguments; expected where(condition, a, b)");
}

TEST(FormulaParameters, MayHaveTheNamesOfFunctionsAndOfWordsOfC) {
  const std::vector<std::string> names{"c", "g", "half", "float", "pow", "kernel", "exp", "where", "v0"};
  const Formula formula{.text = "c + g + half + float + pow(pow, exp(exp)) + kernel + where(where > 0, 1, v0)",
                        .parameters = names};
  EXPECT_EQ(complaint_about(formula), "none");
  EXPECT_EQ(canonical_text(read_formula_tree(formula), names), formula.text);
}

TEST(FormulaParameters, AreRefusedWithTheNamesOfQuantities) {
  for (const auto& quantity : formula_quantities()) {
    SCOPED_TRACE(quantity.name);
    const std::string name(quantity.name);
    EXPECT_THAT(complaint_about({.text = name, .parameters = {name}}), HasSubstr("name of a quantity of the geometry"));
  }
}

TEST(FormulaParameters, AreNames) {
  for (const char* name : {"", "1a", "a b", "a-b", "a\n", "a\x1b", "ä", "a.b", "$a", "__asm__(\"nop\")"}) {
    SCOPED_TRACE(name);
    const std::string complaint = complaint_about({.text = "1", .parameters = {name}});
    EXPECT_THAT(complaint, HasSubstr("of a formula is no name; expected letters, digits and '_'"));
    EXPECT_FALSE(has_control_characters(complaint)) << complaint;
  }
  EXPECT_THAT(complaint_about({.text = repeated("a", 65), .parameters = {repeated("a", 65)}}), HasSubstr("is no name"));
  EXPECT_EQ(complaint_about({.text = repeated("a", 64), .parameters = {repeated("a", 64)}}), "none");
}

TEST(FormulaParameters, AreUsed) {
  EXPECT_EQ(complaint_about({.text = "rho / pi", .parameters = {"rho", "rh"}}),
            "the formula does not use the parameter 'rh'; did you mean 'rho'?");
  // The name of a function is no use of the parameter.
  EXPECT_THAT(complaint_about({.text = "exp(rho)", .parameters = {"rho", "exp"}}),
              HasSubstr("does not use the parameter 'exp'"));
  EXPECT_EQ(complaint_about({.text = "1", .parameters = {"m"}}),
            "the formula does not use the parameter 'm'; expected its name in the formula");
}

TEST(Formula, IsAnisotropicWhereItSeesAzimuths) {
  EXPECT_TRUE(is_anisotropic({.text = "1 + in_x", .parameters = {}}));
  EXPECT_TRUE(is_anisotropic({.text = "exp(-half_y * half_y)", .parameters = {}}));
  EXPECT_FALSE(is_anisotropic({.text = "cos_i + theta_o", .parameters = {}}));
  EXPECT_FALSE(is_anisotropic({.text = "in_x_2", .parameters = {"in_x_2"}}));
}

// --- What reaches the compiler.
TEST(FormulaSource, HasNothingOfTheUsersText) {
  Formula formula{.text = "secret * 2 + fmin(half, 0.25)", .parameters = {"secret", "half"}};
  formula.file = "\"\n#include \"x";
  const std::string source = formula_source(formula);
  EXPECT_THAT(source, Not(HasSubstr("secret")));
  EXPECT_THAT(source, Not(HasSubstr("half")));
  EXPECT_THAT(source, Not(HasSubstr("#")));
  EXPECT_THAT(source, HasSubstr("const pack p2 = TO_PACK(c.c2);"));
  EXPECT_THAT(source, HasSubstr("= (pack)(2.0);"));
  EXPECT_THAT(source, HasSubstr("= fmin(v3, v4);"));
}

TEST(FormulaSource, IsTheSameHoweverTheFormulaIsWritten) {
  const Formula one{.text = "rho*(n+2)", .parameters = {"rho", "n"}, .file = "a.toml", .line = 3};
  const Formula other{.text = "\n a * ( b + 2.0 )", .parameters = {"a", "b"}, .file = "b.toml", .line = 9};
  EXPECT_EQ(formula_source(one), formula_source(other));
}

// Exact: numbers of any size are written so that they read back as themselves, and as double, not as int.
TEST(FormulaSource, HasNumbersThatAreDoubles) {
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {"7", "(pack)(7.0)"}, {"1e22", "(pack)(1e+22)"}, {"0.1", "(pack)(0.1)"}, {"3000000000", "(pack)(3e+09)"}}) {
    EXPECT_THAT(formula_source({.text = text, .parameters = {}}), HasSubstr(expected)) << text;
  }
}

TEST(FormulaSource, RefusesWhatIsNotValid) {
  EXPECT_THROW((void)formula_source({.text = "1.0); (2.0", .parameters = {}}), ArgumentError);
  EXPECT_THROW((void)formula_source({.text = "n", .parameters = {"n", "m"}}), ArgumentError);
  EXPECT_THROW((void)formula_source({.text = "1", .parameters = {"a = 0; int b"}}), ArgumentError);
  EXPECT_THROW((void)formula_source({.text = "1", .parameters = {}, .width = 0}), ArgumentError);
}

// --- Attacks.
class HostileFormula : public ::testing::TestWithParam<std::string> {};

TEST_P(HostileFormula, IsRefusedWithOneClearLine) {
  constexpr std::size_t kLongest = 400;
  Formula formula{.text = GetParam(), .parameters = {"n"}, .file = "mine.toml", .line = 10, .column = 5};
  std::string complaint = "none";
  try {
    static_cast<void>(read_formula_tree(formula));
  } catch (const ArgumentError& error) {
    complaint = error.what();
  }
  EXPECT_THAT(complaint, ::testing::MatchesRegex("mine\\.toml:[0-9]+:[0-9]+: .*"));
  EXPECT_THAT(complaint, ::testing::AnyOf(HasSubstr("expected"), HasSubstr("did you mean"), HasSubstr("known:"),
                                          HasSubstr("docs/formulas.md")));
  EXPECT_FALSE(has_control_characters(complaint)) << complaint;
  EXPECT_LE(complaint.size(), kLongest) << complaint;
  EXPECT_THROW(require_valid(formula), ArgumentError);
  EXPECT_THROW((void)formula_source(formula), ArgumentError);
}

INSTANTIATE_TEST_SUITE_P(All, HostileFormula, ::testing::ValuesIn(hostile_formulas()));

TEST(HostileFormulas, AreAtLeastTwoHundred) {
  auto list = hostile_formulas();
  std::ranges::sort(list);
  EXPECT_EQ(std::ranges::adjacent_find(list), list.end());
  EXPECT_GE(list.size(), 200U);
}

// Everything that the grammar makes reads back as itself; everything else is refused, whatever it is.
TEST(RandomText, IsRefusedOrReadsBackAsItself) {
  constexpr int kTexts = 20'000;
  const std::vector<std::string> words{
      "1",  "2.5e3", ".5", "n",  "rho", "cos_i", "pi",   "(",    ")", "+",  "-", "*",  "/",      "<",        "<=", ">",
      ">=", "==",    "!",  "!=", "&&",  "||",    "exp(", "pow(", ",", ", ", " ", "\n", "where(", "fresnel(", "e5", "x"};
  std::mt19937 engine(7);
  int understood = 0;
  for (int k = 0; k < kTexts; ++k) {
    std::string text;
    const auto length = 1 + engine() % 9;
    for (std::size_t i = 0; i < length; ++i) text += words[engine() % words.size()];
    if (complaint_on(text) != "none") continue;
    ++understood;
    EXPECT_EQ(tree_of(canonical(text)), tree_of(text)) << text;
    EXPECT_EQ(canonical(canonical(text)), canonical(text)) << text;
  }
  EXPECT_GT(understood, 100);
}

}  // namespace
}  // namespace lobe::test
