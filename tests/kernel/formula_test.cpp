// Formulas as they are computed, against an evaluator of the text that knows nothing of the library's.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "lobe/model/material.hpp"
#include "model/formula_kinks.hpp"
#include "model/formula_tree.hpp"
#include "model/formula_value.hpp"
#include "model/values.hpp"
#include "reference/formula_value.hpp"
#include "support/device.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using Names = std::map<std::string, double, std::less<>>;

std::vector<Directions> formula_directions() {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> theta(0.05, 1.5);
  std::vector<Directions> list;
  while (list.size() < 24) list.push_back({theta(engine), theta(engine), 1 + theta(engine)});
  return list;
}

/// The names of the geometry that the formulas below use.
Names names_at(const Directions& pair) {
  return {{"cos_i", std::cos(pair.theta_in)}, {"cos_o", std::cos(pair.theta_out)}, {"pi", pi}};
}

/// All formulas as one, `where(k == 0, first, where(k == 1, second, ...))`: they are compiled once.
std::string choice_of(const std::vector<std::string>& formulas) {
  std::string text;
  std::string end;
  for (std::size_t k = 0; k + 1 < formulas.size(); ++k) {
    text += "where(k == " + std::to_string(k) + ", " + formulas[k] + ", ";
    end += ")";
  }
  return text + formulas.back() + end;
}

/// The value on the host is within its error of both: the reference's and the device's.
/// \return whether it is known
bool expect_on_host(const std::string& text, const Directions& pair, double expected, double seen) {
  const FormulaTree tree = read_formula_tree({.text = text, .parameters = {}});
  const Estimate value = formula_value(tree, {}, pair);
  if (std::isnan(value.error)) return false;
  EXPECT_LE(std::abs(value.value - expected), value.error) << text;
  EXPECT_LE(std::abs(value.value - seen), value.error) << text;
  return true;
}

/// \param relative how far values may be from the reference's, of their size and of 1
void expect_reference(const std::vector<std::string>& formulas, double relative) {
  const auto list = formula_directions();
  const std::string text = choice_of(formulas);
  std::size_t finite = 0;
  std::size_t known = 0;
  for (std::size_t k = 0; k < formulas.size(); ++k) {
    Term term{.model = std::string(kCustomModel), .values = {static_cast<double>(k)}, .weight = {1.0}};
    term.formula = Formula{.text = text, .parameters = {"k"}};
    const auto values = unchecked_values(device(), {"formulas", "", {term}}, list);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const double expected = reference::formula_value(formulas[k], names_at(list[i]));
      const double seen = values(static_cast<Eigen::Index>(i), 0);
      const bool is_known = expect_on_host(formulas[k], list[i], expected, seen);
      finite += std::isfinite(expected) ? 1U : 0U;
      known += is_known ? 1U : 0U;
      if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(seen)) << formulas[k];
      } else if (std::isinf(expected)) {
        EXPECT_EQ(seen, expected) << formulas[k];
      } else {
        EXPECT_NEAR(seen, expected, relative * (1 + std::abs(expected))) << formulas[k];
      }
    }
  }
  // Of most of them something is known.
  EXPECT_GE(known, 9 * finite / 10);
}

// Every function of the list, so that one that a device lacks, or that means something else there, is found.
TEST(FormulaFunctions, AreThoseOfTheReference) {
  std::vector<std::string> formulas;
  for (const auto& function : formula_functions()) {
    const std::string name(function.name);
    const std::string first = name == "acosh" ? "1.5 + cos_i" : "cos_i";
    formulas.push_back(function.arguments == 1   ? name + "(" + first + ")"
                       : function.arguments == 2 ? name + "(cos_i, cos_o)"
                       : name == "smoothstep"    ? "smoothstep(0.2, 0.7, cos_i)"
                       : name == "clamp"         ? "clamp(cos_i, 0.3, 0.3 + cos_o / 2)"
                                                 : name + "(cos_i, 0.5 + cos_o, 0.25)");
    // Numbers below 0 and above 1, where that means something.
    if (function.arguments == 1) formulas.push_back(name + "(3 * (cos_i - cos_o))");
  }
  // By groups: what nests has a limit.
  constexpr std::size_t kGroup = 40;
  for (std::size_t begin = 0; begin < formulas.size(); begin += kGroup) {
    const auto first = formulas.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto count = static_cast<std::ptrdiff_t>(std::min(kGroup, formulas.size() - begin));
    expect_reference({first, first + count}, 1e-13);
  }
}

// Every quantity by its definition.
TEST(FormulaQuantities, AreThoseOfTheHost) {
  const auto list = formula_directions();
  for (const auto& quantity : formula_quantities()) {
    Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
    term.formula = Formula{.text = std::string(quantity.name), .parameters = {}};
    const FormulaTree tree = read_formula_tree(*term.formula);
    const auto values = unchecked_values(device(), {"quantity", "", {term}}, list);
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Estimate value = formula_value(tree, {}, list[i]);
      EXPECT_LE(std::abs(value.value - values(static_cast<Eigen::Index>(i), 0)), value.error) << quantity.name;
      EXPECT_LE(value.error, 1e-12 * std::max(1.0, std::abs(value.value))) << quantity.name;
    }
  }
}

// Kinks of formulas have an evaluator of their own, of pairs as rules see them.
TEST(FormulaQuantities, AreThoseOfKinks) {
  for (const auto& quantity : formula_quantities()) {
    if (quantity.name == "pi") continue;
    const std::string name(quantity.name);
    const FormulaKinks found =
        formula_kinks(read_formula_tree({.text = "step(0.25, " + name + ")", .parameters = {}}), {});
    ASSERT_EQ(found.kinks.size(), 1U) << name;
    EXPECT_EQ(found.kinks.front().is_anisotropic, quantity.is_anisotropic) << name;
    EXPECT_TRUE(found.kinks.front().is_jump()) << name;
    const FormulaTree tree = read_formula_tree({.text = name, .parameters = {}});
    for (const Directions& pair : formula_directions()) {
      const double phi = pair.phi_in + pair.delta_phi;
      KinkPair seen{.cos_i = std::cos(pair.theta_in),
                    .cos_o = std::cos(pair.theta_out),
                    .in_x = std::sin(pair.theta_in) * std::cos(pair.phi_in),
                    .in_y = std::sin(pair.theta_in) * std::sin(pair.phi_in),
                    .out_x = std::sin(pair.theta_out) * std::cos(phi),
                    .out_y = std::sin(pair.theta_out) * std::sin(phi)};
      seen.cos_between = seen.cos_i * seen.cos_o + seen.in_x * seen.out_x + seen.in_y * seen.out_y;
      const double expected = formula_value(tree, {}, pair).value - 0.25;
      // Of half-vectors roots lose half of the digits where they are small.
      EXPECT_NEAR(std::abs(found.kinks.front()(seen)), std::abs(expected), 1e-7 * std::max(1.0, std::abs(expected)))
          << name;
    }
  }
}

// What rounding decides is not known on the host.
TEST(FormulaOnTheHost, SaysNothingWhereRoundingDecides) {
  const auto at = [](const std::string& text, double parameter = 0) {
    const FormulaTree tree = read_formula_tree({.text = text, .parameters = {"p"}});
    return formula_value(tree, std::vector{parameter}, {0.3, 0.4, 1});
  };
  for (const char* const text : {"where(cos_i == cos_i, 1, 2)", "1 / (cos_i - cos_i)", "sqrt(cos_i - cos_i)",
                                 "sin(1e15 * cos_i)", "log(-cos_i)", "where(cos_i < cos_i && p == 0, 1, 2)"}) {
    EXPECT_TRUE(std::isnan(at(text).error)) << text;
  }
  EXPECT_EQ(at("floor(cos_i - cos_i)").error, 1);
  EXPECT_EQ(at("where(cos_i == cos_i && p == 1, 1, 2)").value, 2);
  EXPECT_EQ(at("where(cos_i == cos_i && p == 1, 1, 2)").error, 0);
  EXPECT_EQ(at("where(cos_i == cos_i || p == 1, 1, 2)", 1).value, 1);
  EXPECT_EQ(at("where(!(p > 1), 3, log(-cos_i))", 1).error, 0);
}

/// A random expression with as many or as few parentheses as happen to come.
class Expressions {
 public:
  std::string number(int depth) {
    if (depth == 0) return leaf();
    switch (any(9)) {
      case 0:
        return "(" + number(depth - 1) + ")";
      case 1:
        return "-" + number(depth - 1);
      case 2:
        return "fmin(" + number(depth - 1) + ", " + number(depth - 1) + ")";
      case 3:
        return "where(" + condition(depth - 1) + ", " + number(depth - 1) + ", " + number(depth - 1) + ")";
      case 4:
        return "exp(-fabs(" + number(depth - 1) + "))";
      case 5:
        return number(depth - 1) + " - " + number(depth - 1);
      case 6:
        return number(depth - 1) + " + " + number(depth - 1);
      case 7:
        return number(depth - 1) + " * " + number(depth - 1);
      default:
        return number(depth - 1) + " / " + number(depth - 1);
    }
  }

  std::string condition(int depth) {
    static constexpr const char* kComparisons[] = {" < ", " <= ", " > ", " >= ", " == ", " != "};
    if (depth == 0) return leaf() + kComparisons[any(6)] + leaf();
    switch (any(4)) {
      case 0:
        return "!(" + condition(depth - 1) + ")";
      case 1:
        return condition(depth - 1) + " && " + condition(depth - 1);
      case 2:
        return condition(depth - 1) + " || " + condition(depth - 1);
      default:
        return "(" + condition(depth - 1) + ")";
    }
  }

 private:
  std::string leaf() {
    static constexpr const char* kLeaves[] = {"cos_i", "cos_o", "pi", "2", "0.5", "3e-1", "7", "1.25"};
    return kLeaves[any(8)];
  }
  std::size_t any(std::size_t count) { return engine_() % count; }
  std::mt19937 engine_{3};
};

TEST(FormulaOperators, BindAsInTheReference) {
  Expressions expressions;
  for (int group = 0; group < scaled(8, 2); ++group) {
    std::vector<std::string> formulas;
    for (int k = 0; k < 12; ++k) formulas.push_back(expressions.number(3));
    expect_reference(formulas, 1e-12);
  }
}

// Quotients of whole numbers are those of real numbers; C has 0 for the first.
TEST(FormulaNumbers, AreReal) {
  expect_reference({"1 / 2", "(1 + 2) / 4 * cos_i", "7 / 2 / 2", "-1 / 3", "2 * 3 / 4", "5 / (2 * 4)"}, 1e-15);
}

TEST(FormulaParameters, WithNamesOfTheKernelsAreParameters) {
  const std::vector<std::string> names{"c", "g", "half", "float", "pow", "kernel", "pack", "real", "v0"};
  Term term{.model = std::string(kCustomModel), .values = {1, 2, 3, 4, 5, 6, 7, 8, 9}, .weight = {1.0}};
  term.formula = Formula{.text =
                             "c + 10 * (g + 10 * (half + 10 * (float + 10 * (pow + 10 * (kernel + 10 * (pack + 10 * "
                             "(real + 10 * v0))))))) + 0 * pow(pow, 2)",
                         .parameters = names};
  const std::vector<Directions> list{{0.3, 0.4, 1}};
  EXPECT_EQ(unchecked_values(device(), {"named", "", {term}}, list)(0, 0), 987654321);
}

// As long and as deep as a formula may be: no limit of the device's compiler is in the way.
TEST(FormulaLimits, AreWithinThoseOfTheCompiler) {
  std::string chain = "0.001";
  for (int k = 0; k < 499; ++k) chain += k % 2 == 0 ? "+0.001" : "+cos_i";
  std::string nest = "cos_i";
  for (std::size_t k = 0; k < kFormulaDepth; ++k) nest = "(" + nest + "*0.5+0.25)";
  for (const std::string& text : {chain, nest}) {
    SCOPED_TRACE(text);
    Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1.0}};
    term.formula = Formula{.text = text, .parameters = {}};
    const std::vector<Directions> list{{0.3, 0.4, 1}};
    const double expected = reference::formula_value(text, names_at(list[0]));
    EXPECT_NEAR(unchecked_values(device(), {"limit", "", {term}}, list)(0, 0), expected, 1e-12 * expected);
  }
}

}  // namespace
}  // namespace lobe::test
