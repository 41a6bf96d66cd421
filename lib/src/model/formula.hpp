#pragma once

#include <string>
#include <string_view>

#include "lobe/model/material.hpp"

namespace lobe {

/// Uses a name that only anisotropic models see.
/// \throws ArgumentError where the formula cannot be read
[[nodiscard]] bool is_anisotropic(const Formula& formula);

/// \throws ArgumentError for what is not in the language of formulas, with its place in the text ("FILE:LINE:COLUMN:
/// ..."),
///   and for too many parameters, a parameter that is no name, is a quantity of the geometry, is given twice or not
///   used, and a width outside (0, 1]
void require_valid(const Formula& formula);

/// The function kFormulaFunction in OpenCL C: c0 times the formula, parameters from c1 on. It is made of words that
/// stand in the library and of numbers; nothing of the formula's text, names of parameters included, is in it.
/// \throws ArgumentError as require_valid()
[[nodiscard]] std::string formula_source(const Formula& formula);
inline constexpr std::string_view kFormulaFunction = "formula";

}  // namespace lobe
