#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobe/material.hpp"

namespace lobe {

/// Names of variables and functions that formulas may use, beside their parameters and the functions of OpenCL C.
[[nodiscard]] const std::vector<std::string_view>& formula_names();

/// What looks like a name in a formula, in order, each once.
[[nodiscard]] std::vector<std::string_view> names_in(std::string_view text);

/// Uses a name that only anisotropic models see.
[[nodiscard]] bool is_anisotropic(const Formula& formula);

/// \throws ArgumentError for an empty text, too many parameters, a parameter that is no name, is one of
///   formula_names(), is given twice or not used, a width outside (0, 1]
void require_valid(const Formula& formula);

/// The function kFormulaFunction in OpenCL C: c0 times the formula, parameters from c1 on.
[[nodiscard]] std::string formula_source(const Formula& formula);
inline constexpr std::string_view kFormulaFunction = "formula";

}  // namespace lobe
