#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>
#include <utility>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/version.hpp"
#include "lut/lut_fit.hpp"

namespace lobe {
namespace {

/// A language and how it writes.
struct LanguageRow {
  std::string_view name;
  std::array<std::string_view, 2> endings;
  std::string_view comment;
  std::string_view precision;
};
constexpr std::array kLanguages{LanguageRow{"c", {".h", ".c"}, "//", "single"},
                                LanguageRow{"glsl", {".glsl", ".glsl"}, "//", "single"},
                                LanguageRow{"python", {".py", ".py"}, "#", "double"}};

constexpr auto kLanguageNames = [] {
  std::array<std::string_view, kLanguages.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kLanguages[i].name;
  return names;
}();

std::string argument_name(const LutAxis& axis) {
  std::string name = axis.map == AxisMap::linear ? axis.name : fmt::format("{}_{}", to_string(axis.map), axis.name);
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return axis.name == "theta" ? name + "_deg" : name;
}

/// Writes the functions of one language.
class FunctionWriter {
 public:
  FunctionWriter(const LutFit& fit, LutFitLanguage language, std::string name)
      : fit_(fit), language_(language), name_(std::move(name)) {}

  [[nodiscard]] std::string text() const {
    std::string all;
    for (std::size_t c = 0; c < fit_.columns.size(); ++c) all += (c == 0 ? "" : "\n") + function(c);
    if (fit_.columns.size() > 1 && language_ == LutFitLanguage::glsl) {
      std::vector<std::string> calls;
      for (std::size_t c = 0; c < fit_.columns.size(); ++c) {
        calls.push_back(fmt::format("{}({})", function_name(c), fmt::join(arguments(), ", ")));
      }
      all += fmt::format("\nvec{0} {1}({2}) {{\n  return vec{0}({3});\n}}\n", fit_.columns.size(), name_,
                         declarations(), fmt::join(calls, ", "));
    }
    return all;
  }

 private:
  [[nodiscard]] bool is_python() const { return language_ == LutFitLanguage::python; }

  [[nodiscard]] std::string function_name(std::size_t column) const {
    return fit_.columns.size() == 1 ? name_ : fmt::format("{}_{}", name_, fit_.columns[column]);
  }

  [[nodiscard]] std::vector<std::string> arguments() const {
    std::vector<std::string> names;
    for (const LutAxis& axis : fit_.request.axes) names.push_back(argument_name(axis));
    return names;
  }

  [[nodiscard]] std::string declarations() const {
    std::vector<std::string> all;
    for (const auto& name : arguments()) all.push_back(is_python() ? name : "float " + name);
    return fmt::format("{}", fmt::join(all, ", "));
  }

  [[nodiscard]] std::string number(double value) const {
    if (is_python()) return shortest(value);
    std::string text = fmt::format("{}", static_cast<float>(value));
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return language_ == LutFitLanguage::c ? text + "f" : text;
  }

  [[nodiscard]] std::string statement(std::string_view name, std::string_view value) const {
    if (is_python()) return fmt::format("    {} = {}\n", name, value);
    return fmt::format("  {} {} = {};\n", language_ == LutFitLanguage::c ? "const float" : "float", name, value);
  }

  [[nodiscard]] std::string function(std::size_t column) const {
    const LutFitColumn& function = fit_.functions[column];
    std::string body;
    std::vector<std::string> variables;
    for (std::size_t a = 0; a < fit_.request.axes.size(); ++a) {
      const FitVariable variable = fit_variable(fit_.request.axes[a], fit_.is_centred);
      const std::string argument = arguments()[a];
      variables.push_back(variable.is_argument() ? argument : fmt::format("x{}", a + 1));
      if (variable.is_argument()) continue;
      const std::string shift = variable.offset < 0 ? fmt::format("({} + {})", argument, number(-variable.offset))
                                                    : fmt::format("({} - {})", argument, number(variable.offset));
      body += statement(variables.back(), fmt::format("{} * {}", shift, number(variable.factor)));
    }
    std::string value = polynomial("p", fit_.form.numerator, function.numerator, variables, body);
    if (!function.denominator.empty()) {
      const std::string below = polynomial("q", fit_.form.denominator, function.denominator, variables, body);
      value = fmt::format("({}) / ({})", value, below);
    }
    const std::string head = is_python() ? "def " : language_ == LutFitLanguage::c ? "static inline float " : "float ";
    return fmt::format("{}{}({}){}\n{}{}return {}{}\n{}", head, function_name(column), declarations(),
                       is_python() ? ":" : " {", body, is_python() ? "    " : "  ", value, is_python() ? "" : ";",
                       is_python() ? "" : "}\n");
  }

  /// Horner's scheme of terms: "t0 + x * (t1 + x * t2)".
  [[nodiscard]] static std::string scheme(const std::vector<std::string>& terms, const std::string& variable) {
    std::string text = terms.back();
    for (std::size_t k = terms.size() - 1; k-- > 0;) {
      const bool is_sum = k + 2 < terms.size();
      text = fmt::format("{} + {} * {}{}{}", terms[k], variable, is_sum ? "(" : "", text, is_sum ? ")" : "");
    }
    return text;
  }

  /// Expression of a polynomial; its parts in the last variable become statements of the body, if there are several.
  [[nodiscard]] std::string polynomial(const std::string& letter, const std::vector<unsigned>& degrees,
                                       const std::vector<double>& coefficients,
                                       const std::vector<std::string>& variables, std::string& body) const {
    std::size_t next = 0;
    const auto part = [&](const auto& self, std::size_t argument, unsigned sum,
                          const std::string& name) -> std::string {
      std::vector<std::string> terms;
      const bool is_last = argument + 1 == variables.size();
      for (unsigned k = 0; k <= degree_at(degrees, variables.size(), argument, sum); ++k) {
        if (is_last) {
          terms.push_back(number(coefficients[next++]));
        } else {
          const std::string inner = fmt::format("{}{}{}", name, argument == 0 ? "" : "_", k);
          const std::string value = self(self, argument + 1, sum + k, inner);
          body += statement(inner, value);
          terms.push_back(inner);
        }
      }
      return scheme(terms, variables[argument]);
    };
    return part(part, 0, 0, letter);
  }

  const LutFit& fit_;
  LutFitLanguage language_;
  std::string name_;
};

std::string none_below(const LutFit& fit, double bound) {
  // Rounded down: it is a bound.
  const double unit = bound > 0 ? std::pow(10.0, std::floor(std::log10(bound)) - 3) : 1;
  const std::string text = fmt::format("{:.4g}", std::floor(bound / unit) * unit);
  return fmt::format("no {} of this form is below {}",
                     fit.form.denominator.empty() ? "polynomial" : "rational function", text);
}

std::vector<std::string> fit_header(const LutFit& fit, const LutFitFileOptions& options) {
  const LanguageRow& row = kLanguages.at(static_cast<std::size_t>(options.language));
  std::vector<std::string> lines{lut_quantity_text(fit.request)};
  lines.push_back(fmt::format("made by lobe {}{}{}", version(), options.command_line.empty() ? "" : ": ",
                              printable(options.command_line)));
  lines.push_back(lut_fit_text(fit.request, fit.form));
  for (std::size_t a = 0; a < fit.request.axes.size(); ++a) {
    const LutAxis& axis = fit.request.axes[a];
    lines.push_back(
        fmt::format("argument {}: {}, for {}", argument_name(axis), fit_argument_text(axis), lut_axis_text(axis)));
  }
  for (std::size_t c = 0; c < fit.columns.size(); ++c) {
    const LutFitColumn& function = fit.functions[c];
    const LutErrors& errors = options.language == LutFitLanguage::python ? function.errors : function.single_errors;
    lines.push_back(fmt::format("{}: largest error at the entries {:.4g}; {}", fit.columns[c], errors.entries.largest,
                                none_below(fit, function.bound)));
    lines.push_back(fmt::format(
        "{}: largest error between the entries {:.4g} at {}", fit.columns[c], errors.between.largest,
        lut_place_text({.request = fit.request, .columns = {}, .values = {}, .errors = {}}, errors.between)));
    if (errors.all.largest > errors.between.largest) {
      lines.push_back(
          fmt::format("{}: largest error up to the ends of the axes {:.4g}", fit.columns[c], errors.all.largest));
    }
  }
  lines.push_back(fmt::format("errors are absolute, in {} precision, and were measured at {} points", row.precision,
                              fit.functions.front().errors.points));
  return lines;
}

}  // namespace

std::vector<std::string_view> lut_fit_language_names() {
  return {kLanguageNames.begin(), kLanguageNames.end()};
}

LutFitLanguage parse_lut_fit_language(std::string_view name) {
  const auto found = std::ranges::find(kLanguageNames, name);
  if (found == kLanguageNames.end()) {
    throw ArgumentError(
        fmt::format("unknown language '{}' of functions{}", excerpt(name), did_you_mean(name, kLanguageNames)));
  }
  return static_cast<LutFitLanguage>(found - kLanguageNames.begin());
}

LutFitLanguage lut_fit_language_of(const std::filesystem::path& path) {
  const std::string ending = lowercase(path.extension().string());
  const auto found = std::ranges::find_if(
      kLanguages, [&](const LanguageRow& row) { return std::ranges::find(row.endings, ending) != row.endings.end(); });
  if (found == kLanguages.end()) {
    throw ArgumentError(fmt::format("no language of functions has the ending '{}'; expected .h, .c, .glsl or .py",
                                    excerpt(path.extension().string())));
  }
  return static_cast<LutFitLanguage>(found - kLanguages.begin());
}

std::string lut_fit_file(const LutFit& fit, const LutFitFileOptions& options) {
  const bool is_name =
      !options.name.empty() && std::isdigit(static_cast<unsigned char>(options.name.front())) == 0 &&
      std::ranges::all_of(options.name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  if (!is_name) {
    throw ArgumentError(fmt::format("a function cannot be named '{}'; expected letters, digits and underscores",
                                    excerpt(options.name)));
  }
  if (options.language == LutFitLanguage::glsl && fit.columns.size() > 4) {
    throw ArgumentError(fmt::format(
        "language glsl has no vector of {} columns; expected at most 4, or another language", fit.columns.size()));
  }
  std::string text;
  for (const auto& line : fit_header(fit, options)) {
    text += fmt::format("{} {}\n", kLanguages.at(static_cast<std::size_t>(options.language)).comment, line);
  }
  return text + FunctionWriter(fit, options.language, options.name).text();
}

}  // namespace lobe
