#include "model/formula.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/formula_tree.hpp"

namespace lobe {
namespace {

using Kind = FormulaPart::Kind;

bool is_name(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto continues = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); };
  return !text.empty() && text.size() <= kFormulaNameLength && is_letter(text.front()) &&
         std::ranges::all_of(text, continues);
}

bool uses(const FormulaTree& tree, Kind kind, std::size_t index) {
  return std::ranges::any_of(tree.parts,
                             [&](const FormulaPart& part) { return part.kind == kind && part.index == index; });
}

bool is_anisotropic(const FormulaTree& tree) {
  return std::ranges::any_of(tree.parts, [](const FormulaPart& part) {
    return part.kind == Kind::quantity && formula_quantities()[part.index].is_anisotropic;
  });
}

void require_parameters(const Formula& formula) {
  if (formula.parameters.size() > kFormulaParameters) {
    throw ArgumentError("formula has " + std::to_string(formula.parameters.size()) + " parameters; expected at most " +
                        std::to_string(kFormulaParameters));
  }
  for (std::size_t i = 0; i < formula.parameters.size(); ++i) {
    const std::string& name = formula.parameters[i];
    const auto here = formula.parameters.begin() + static_cast<std::ptrdiff_t>(i);
    if (!is_name(name)) {
      throw ArgumentError("parameter '" + printable(name.substr(0, kFormulaNameLength)) +
                          "' of a formula is no name; expected letters, digits and '_', at most " +
                          std::to_string(kFormulaNameLength));
    }
    if (std::ranges::find(formula_quantities(), name, &FormulaQuantity::name) != formula_quantities().end()) {
      throw ArgumentError("parameter '" + name + "' of a formula has the name of a quantity of the geometry");
    }
    if (std::find(formula.parameters.begin(), here, name) != here) {
      throw ArgumentError("parameter '" + name + "' of a formula is given twice");
    }
  }
}

void require_use(const Formula& formula, const FormulaTree& tree) {
  for (std::size_t i = 0; i < formula.parameters.size(); ++i) {
    if (uses(tree, Kind::parameter, i)) continue;
    std::vector<std::string_view> used;
    for (std::size_t k = 0; k < formula.parameters.size(); ++k) {
      if (uses(tree, Kind::parameter, k)) used.push_back(formula.parameters[k]);
    }
    for (std::size_t k = 0; k < formula_quantities().size(); ++k) {
      if (uses(tree, Kind::quantity, k)) used.push_back(formula_quantities()[k].name);
    }
    const std::string& name = formula.parameters[i];
    throw ArgumentError("the formula does not use the parameter '" + name + "'" +
                        (used.empty() ? "; expected its name in the formula" : did_you_mean(name, used)));
  }
}

FormulaTree valid_tree(const Formula& formula) {
  require_parameters(formula);
  if (!(formula.width > 0 && formula.width <= 1)) {
    throw ArgumentError("width of a formula is " + shortest(formula.width) + "; expected a value in (0, 1] rad");
  }
  FormulaTree tree = read_formula_tree(formula);
  require_use(formula, tree);
  return tree;
}

/// A number as a double of C, whose digits read back as the same.
std::string double_literal(double value) {
  std::string text = shortest(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string variable(std::size_t part) {
  return "v" + std::to_string(part);
}

/// The right-hand side of the assignment of a part.
std::string right_hand_side(const FormulaPart& part) {
  const auto operand = [&](std::size_t k) { return variable(part.operands[k]); };
  const auto joined = [&](std::string_view sign) { return operand(0) + " " + std::string(sign) + " " + operand(1); };
  switch (part.kind) {
    case Kind::number:
      return "(pack)(" + double_literal(part.number) + ")";
    case Kind::quantity:
      return std::string(formula_quantities()[part.index].name);
    case Kind::parameter:
      return "p" + std::to_string(part.index + 1);
    case Kind::negation:
      return "-" + operand(0);
    case Kind::opposite:
      return "FLAG_NOT(" + operand(0) + ")";
    case Kind::call: {
      const FormulaFunction& function = formula_functions()[part.index];
      std::string text(function.code.empty() ? function.name : function.code);
      for (std::size_t k = 0; k < function.arguments; ++k) text += (k == 0 ? "(" : ", ") + operand(k);
      return text + ")";
    }
    case Kind::choice:
      return operand(0) + " ? " + operand(1) + " : " + operand(2);
    case Kind::sum:
      return joined("+");
    case Kind::difference:
      return joined("-");
    case Kind::product:
      return joined("*");
    case Kind::quotient:
      return joined("/");
    case Kind::less:
      return joined("<");
    case Kind::less_or_equal:
      return joined("<=");
    case Kind::greater:
      return joined(">");
    case Kind::greater_or_equal:
      return joined(">=");
    case Kind::equal:
      return joined("==");
    case Kind::unequal:
      return joined("!=");
    case Kind::both:
      return joined("&");
    case Kind::either:
      return joined("|");
  }
  return {};
}

}  // namespace

bool is_anisotropic(const Formula& formula) {
  return is_anisotropic(read_formula_tree(formula));
}

void require_valid(const Formula& formula) {
  static_cast<void>(valid_tree(formula));
}

std::string formula_source(const Formula& formula) {
  const FormulaTree tree = valid_tree(formula);
  std::string source = "real formula(const geometry g, const coefficients c) {\n  FORMULA_GEOMETRY\n";
  if (is_anisotropic(tree)) source += "  FORMULA_TANGENTS\n";
  for (std::size_t i = 1; i <= formula.parameters.size(); ++i) {
    source += "  const pack p" + std::to_string(i) + " = TO_PACK(c.c" + std::to_string(i) + ");\n";
  }
  // One statement for each part: nothing nests, whatever the formula.
  for (std::size_t k = 0; k < tree.parts.size(); ++k) {
    const FormulaPart& part = tree.parts[k];
    source += std::string("  const ") + (is_condition(part.kind) ? "flag " : "pack ") + variable(k) + " = " +
              right_hand_side(part) + ";\n";
  }
  source += "  return TO_REAL(TO_PACK(c.c0) * " + variable(tree.parts.size() - 1) + ");\n}\n";
  return source;
}

}  // namespace lobe
