#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/model/material.hpp"

/// The language of formulas (docs/formulas.md): read into a tree of operations that are known here, so that no text of
/// a formula is ever given to a compiler.
namespace lobe {

/// Limits of a formula: characters; names, numbers and operations; nesting of parentheses, calls and signs; characters
/// of a name.
inline constexpr std::size_t kFormulaLength = 10'000;
inline constexpr std::size_t kFormulaParts = 1000;
inline constexpr std::size_t kFormulaDepth = 100;
inline constexpr std::size_t kFormulaNameLength = 64;

/// A quantity of the geometry, or pi.
struct FormulaQuantity {
  std::string_view name;
  bool is_anisotropic = false;  ///< a component along an axis of the surface
};
[[nodiscard]] std::span<const FormulaQuantity> formula_quantities();

/// A function of one, two or three numbers.
struct FormulaFunction {
  std::string_view name;
  std::size_t arguments;
  std::string_view code = {};  ///< its name in OpenCL C, where that is another one
};
[[nodiscard]] std::span<const FormulaFunction> formula_functions();

/// A part of a formula.
struct FormulaPart {
  enum class Kind {
    number,
    quantity,
    parameter,
    negation,
    sum,
    difference,
    product,
    quotient,
    call,
    choice,  ///< where(condition, a, b)
    less,    ///< from here on conditions
    less_or_equal,
    greater,
    greater_or_equal,
    equal,
    unequal,
    both,
    either,
    opposite
  };
  Kind kind = Kind::number;
  double number = 0;
  std::size_t index = 0;                  ///< of the quantity, parameter or function in its list
  std::array<std::size_t, 3> operands{};  ///< places of the parts that it is made of, in order
  [[nodiscard]] bool operator==(const FormulaPart&) const = default;
};
[[nodiscard]] bool is_condition(FormulaPart::Kind kind);
[[nodiscard]] std::size_t operand_count(const FormulaPart& part);

/// A formula: every part stands behind its operands; the last one is the value.
struct FormulaTree {
  std::vector<FormulaPart> parts;
  [[nodiscard]] bool operator==(const FormulaTree&) const = default;
};

/// Reads a formula.
/// \throws ArgumentError "FILE:LINE:COLUMN: what; expected ..." in one line of printable characters
///   ("formula:LINE:COLUMN: ..." where it stands in no file) for what is not in the language, a wrong number of
///   arguments, a condition in place of a number and a number in place of a condition, and where a limit is exceeded
[[nodiscard]] FormulaTree read_formula_tree(const Formula& formula);

/// The formula as text: the same tree has the same text, and the text the same tree.
/// \param parameters their names
[[nodiscard]] std::string canonical_text(const FormulaTree& tree, std::span<const std::string> parameters);

}  // namespace lobe
