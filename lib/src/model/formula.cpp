#include "model/formula.hpp"

#include <algorithm>
#include <cctype>

#include "core/text.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

bool starts_name(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool continues_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

constexpr std::string_view kTangents[] = {"in_x", "in_y", "out_x", "out_y", "half_x", "half_y"};

/// A text as a string of C.
std::string in_quotes(std::string_view text) {
  std::string literal = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') literal += '\\';
    literal += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  }
  return literal + '"';
}

}  // namespace

const std::vector<std::string_view>& formula_names() {
  static const std::vector<std::string_view> names = {
      "cos_i",   "cos_o",  "cos_h",     "cos_d",  "cos_rv",     "cos_lv", "theta_i",
      "theta_o", "tan2_h", "log_cos_h", "log_rv", "distance_p", "in_x",   "in_y",
      "out_x",   "out_y",  "half_x",    "half_y", "pi",         "where",  "fresnel"};
  return names;
}

std::vector<std::string_view> names_in(std::string_view text) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < text.size();) {
    if (!starts_name(text[i])) {
      // Letters of numbers, as in 1e5 or 0x1f, are no names.
      const bool is_number = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
      ++i;
      while (is_number && i < text.size() && (continues_name(text[i]) || text[i] == '.')) ++i;
      continue;
    }
    const std::size_t start = i;
    while (i < text.size() && continues_name(text[i])) ++i;
    const auto name = text.substr(start, i - start);
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

bool is_anisotropic(const Formula& formula) {
  const auto names = names_in(formula.text);
  return std::ranges::any_of(kTangents, [&](auto name) { return std::ranges::find(names, name) != names.end(); });
}

void require_valid(const Formula& formula) {
  if (trim(formula.text).empty()) throw ArgumentError("formula is empty; expected an expression such as \"rho / pi\"");
  if (formula.parameters.size() > kFormulaParameters) {
    throw ArgumentError("formula has " + std::to_string(formula.parameters.size()) + " parameters; expected at most " +
                        std::to_string(kFormulaParameters));
  }
  if (!(formula.width > 0 && formula.width <= 1)) {
    throw ArgumentError("width of a formula is " + shortest(formula.width) + "; expected a value in (0, 1] rad");
  }
  const auto used = names_in(formula.text);
  const auto& reserved = formula_names();
  for (std::size_t i = 0; i < formula.parameters.size(); ++i) {
    const std::string& name = formula.parameters[i];
    const auto here = formula.parameters.begin() + static_cast<std::ptrdiff_t>(i);
    if (name.empty() || !starts_name(name.front()) || !std::ranges::all_of(name, continues_name)) {
      throw ArgumentError("parameter '" + name + "' of a formula is no name; expected letters, digits and '_'");
    }
    if (std::ranges::find(reserved, name) != reserved.end()) {
      throw ArgumentError("parameter '" + name + "' of a formula has the name of a quantity of the geometry");
    }
    if (std::find(formula.parameters.begin(), here, name) != here) {
      throw ArgumentError("parameter '" + name + "' of a formula is given twice");
    }
    if (std::ranges::find(used, name) == used.end()) {
      throw ArgumentError("the formula does not use the parameter '" + name + "'" + did_you_mean(name, used));
    }
  }
}

std::string formula_source(const Formula& formula) {
  std::string source =
      "#line 1 \"formula\"\nreal formula(const geometry g, const coefficients c) {\n  FORMULA_GEOMETRY\n";
  if (is_anisotropic(formula)) source += "  FORMULA_TANGENTS\n";
  for (std::size_t i = 0; i < formula.parameters.size(); ++i) {
    source += "  const pack " + formula.parameters[i] + " = TO_PACK(c.c" + std::to_string(i + 1) + ");\n";
  }
  // Lines and columns in the compiler's messages are those of the user's file.
  source += "  const pack value = (\n#line " + std::to_string(formula.line) + " " +
            in_quotes(formula.file.empty() ? "formula" : formula.file) + "\n";
  source += std::string(formula.column - 1, ' ') + formula.text + "\n";
  source += "#line 1 \"formula\"\n  );\n  return TO_REAL(TO_PACK(c.c0) * value);\n}\n";
  return source;
}

}  // namespace lobe
