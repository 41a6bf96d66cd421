#include "lobe/render/shader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "device/program.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/specification.hpp"
#include "model/lobes.hpp"
#include "render/glsl_words.hpp"
#include "render/shader_text.hpp"

namespace lobe {
namespace {

/// Functions that GLSL lacks. Series where the plain formula cancels; erfc by W. H. Press et al., Numerical Recipes
/// (1992), 6.2, erfcc, whose relative error is below 1.2e-7.
constexpr std::string_view kLog1p = R"(
float lobe_log1p(float x) {
  if (abs(x) > 0.25) return log(1.0 + x);
  float s = x / (2.0 + x);
  float z = s * s;
  return 2.0 * s * (1.0 + z * (1.0 / 3.0 + z * (0.2 + z * (1.0 / 7.0 + z / 9.0))));
}
)";
constexpr std::string_view kExpm1 = R"(
float lobe_expm1(float x) {
  if (abs(x) > 0.5) return exp(x) - 1.0;
  return x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * (1.0 + x / 5.0 * (1.0 + x / 6.0 * (1.0 + x / 7.0 *
         (1.0 + x / 8.0)))))));
}
)";
constexpr std::string_view kErfc = R"(
float lobe_erfc(float x) {
  float z = abs(x);
  float t = 1.0 / (1.0 + 0.5 * z);
  float s = 1.48851587 + t * (-0.82215223 + t * 0.17087277);
  s = 0.09678418 + t * (-0.18628806 + t * (0.27886807 + t * (-1.13520398 + t * s)));
  float tail = t * exp(-z * z - 1.26551223 + t * (1.00002368 + t * (0.37409196 + t * s)));
  return x < 0.0 ? 2.0 - tail : tail;
}
)";

/// What formulas of users may call, and GLSL lacks or leaves undefined for negative bases.
constexpr std::string_view kFormulaFunctions = R"(
float lobe_pow(float x, float y) {
  if (x > 0.0) return pow(x, y);
  if (y == 0.0) return 1.0;
  if (x == 0.0) return y > 0.0 ? 0.0 : 1.0 / 0.0;
  float power = pow(-x, y);
  float half_y = 0.5 * y;
  return y != floor(y) ? 0.0 / 0.0 : half_y == floor(half_y) ? power : -power;
}
float lobe_exp10(float x) { return exp2(3.3219281 * x); }
float lobe_log10(float x) { return 0.43429448 * log(x); }
float lobe_cbrt(float x) { return x == 0.0 ? 0.0 : sign(x) * exp(log(abs(x)) / 3.0); }
float lobe_hypot(float x, float y) { return sqrt(x * x + y * y); }
float lobe_erf(float x) {
  if (abs(x) > 0.5) return 1.0 - lobe_erfc(x);
  float z = x * x;
  return 1.1283792 * x * (1.0 - z * (1.0 / 3.0 - z * (0.1 - z * (1.0 / 42.0 - z * (1.0 / 216.0 - z / 1320.0)))));
}
float lobe_fmod(float x, float y) { return x - y * trunc(x / y); }
float lobe_fdim(float x, float y) { return max(x - y, 0.0); }
float lobe_fma(float x, float y, float z) { return x * y + z; }
)";

/// As kernels/prelude.clh and pair_geometry.clh have them, in single precision.
constexpr std::string_view kGeometry = R"(
struct lobe_geometry {
  float cos_i;      // N.L
  float cos_o;      // N.V
  float cos_h;      // N.H
  float cos_d;      // L.H
  float tan2_h;     // tan^2 of the angle between N and H
  float log_cos_h;  // ln(N.H)
  float log_rv;     // ln(R.V), R the mirror image of L; -1e30 where R.V <= 0
  float slope_x;    // H_x / H_z
  float slope_y;    // H_y / H_z
  float in_x;       // L_x
  float in_y;       // L_y
};

lobe_geometry lobe_geometry_of(vec3 L, vec3 V) {
  float across_x = L.x + V.x;
  float across_y = L.y + V.y;
  float across2 = across_x * across_x + across_y * across_y;
  float along = L.z + V.z;
  float difference = L.z - V.z;
  float length_of_sum = sqrt(across2 + along * along);
  float deficit = 0.5 * (difference * difference + across2);  // 1 - R.V
  lobe_geometry g;
  g.cos_i = L.z;
  g.cos_o = V.z;
  g.cos_h = along / length_of_sum;
  g.cos_d = 0.5 * length_of_sum;
  g.tan2_h = across2 / (along * along);
  g.log_cos_h = -0.5 * lobe_log1p(g.tan2_h);
  g.log_rv = deficit < 1.0 ? lobe_log1p(-min(deficit, 0.99999994)) : -1e30;
  g.slope_x = across_x / along;
  g.slope_y = across_y / along;
  g.in_x = L.x;
  g.in_y = L.y;
  return g;
}

struct lobe_coefficients {
  float c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11, c12, c13, c14, c15;
};

struct lobe_factor_constants {
  float a, b;
};
)";

/// Words of formulas of users that GLSL has others for.
const std::map<std::string_view, std::string_view, std::less<>>& formula_words() {
  static const std::map<std::string_view, std::string_view, std::less<>> kWords{{"pack", "float"},
                                                                                {"flag", "bool"},
                                                                                {"TO_PACK", ""},
                                                                                {"TO_REAL", ""},
                                                                                {"FLAG_NOT", "!"},
                                                                                {"FORMULA_PI", "3.14159265"},
                                                                                {"formula_fresnel", "lobe_fresnel"},
                                                                                {"pow", "lobe_pow"},
                                                                                {"powr", "lobe_pow"},
                                                                                {"exp10", "lobe_exp10"},
                                                                                {"log10", "lobe_log10"},
                                                                                {"rsqrt", "inversesqrt"},
                                                                                {"cbrt", "lobe_cbrt"},
                                                                                {"hypot", "lobe_hypot"},
                                                                                {"erf", "lobe_erf"},
                                                                                {"fmod", "lobe_fmod"},
                                                                                {"fdim", "lobe_fdim"},
                                                                                {"fma", "lobe_fma"},
                                                                                {"mad", "lobe_fma"}};
  return kWords;
}

/// Words of kernels that GLSL has others for, whatever the kernel.
const std::map<std::string_view, std::string_view, std::less<>>& other_words() {
  static const std::map<std::string_view, std::string_view, std::less<>> kWords{
      {"real", "float"},
      {"uint", "int"},
      {"fmin", "min"},
      {"fmax", "max"},
      {"fabs", "abs"},
      {"atan2", "atan"},
      {"log1p", "lobe_log1p"},
      {"expm1", "lobe_expm1"},
      {"erfc", "lobe_erfc"},
      {"geometry", "lobe_geometry"},
      {"coefficients", "lobe_coefficients"},
      {"factor_constants", "lobe_factor_constants"},
      {"LARGEST_LANE", ""},
      {"EVERY_LANE", ""},
      {"const", ""}};
  return kWords;
}

/// Words that kernels use for variables and GLSL keeps for itself.
bool is_reserved(std::string_view word) {
  static const std::set<std::string_view, std::less<>> kReserved{
      "active",    "common", "discard", "filter", "fixed",   "flat",    "half", "in",     "inout",
      "input",     "mat2",   "mat3",    "mat4",   "mix",     "noise",   "out",  "output", "partition",
      "precision", "sample", "smooth",  "step",   "texture", "varying", "vec2", "vec3",   "vec4"};
  return kReserved.contains(word);
}

/// The lines of a kernel's header that define something: no guards, no includes, nothing for packs of several lanes.
std::string definitions_of(std::string_view file) {
  std::string kept;
  bool is_for_packs = false;
  for (const std::string_view line : split(file, '\n')) {
    if (line.starts_with("#if REAL_WIDTH")) is_for_packs = true;
    const bool is_unused = trim(line).starts_with("(void)");
    const bool is_second_gap = line.empty() && (kept.empty() || kept.ends_with("\n\n"));
    const bool is_kept = !is_for_packs && !line.starts_with("#") && !line.starts_with("//#include");
    if (is_kept && !is_unused && !is_second_gap) kept += std::string(line) + "\n";
    if (line.starts_with("#endif")) is_for_packs = false;
  }
  return kept;
}

/// Names of the functions that a text defines.
void add_functions(std::string_view text, std::set<std::string, std::less<>>& names) {
  constexpr std::string_view kBegin = "real ";
  for (const std::string_view line : split(text, '\n')) {
    if (!line.starts_with(kBegin)) continue;
    const std::string_view word = word_at(line, kBegin.size());
    if (line.substr(kBegin.size() + word.size()).starts_with("(")) names.emplace(word);
  }
}

/// The parenthesis that closes the one at `open`.
std::size_t closing(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return i;
  }
  throw std::logic_error("a kernel has an open parenthesis");
}

/// A constant of kernels, REAL_C(...), by what stands between the parentheses.
std::string constant_text(std::string_view inside) {
  constexpr std::string_view kCast = "(double)";
  if (inside.starts_with(kCast)) return fmt::format("float({})", inside.substr(kCast.size()));
  return inside.starts_with("-") ? fmt::format("({})", inside) : std::string(inside);
}

/// Kernels of models are written in a part of C that GLSL shares but for some words, and without the rest of C: no
/// pointers, no conversions but those handled here.
std::string translated(std::string_view text, const std::set<std::string, std::less<>>& functions) {
  constexpr std::string_view kIntegerCast = "(uint)";
  constexpr std::string_view kPackCast = "(pack)";
  std::string made;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i).starts_with("//")) {
      const std::size_t end = std::min(text.find('\n', i), text.size());
      made += text.substr(i, end - i);
      i = end;
    } else if (text.substr(i).starts_with(kIntegerCast)) {
      made += "int";
      i += kIntegerCast.size();
    } else if (text.substr(i).starts_with(kPackCast)) {
      made += "float";
      i += kPackCast.size();
    } else if (text[i] == '|') {
      made += "||";
      ++i;
    } else if (text[i] == '&') {
      made += "&&";
      i += text.substr(i).starts_with("&&") ? 2U : 1U;
    } else if (begins_word(text[i])) {
      const std::string_view word = word_at(text, i);
      i += word.size();
      if (word == "REAL_C") {
        const std::size_t end = closing(text, i);
        made += constant_text(text.substr(i + 1, end - i - 1));
        i = end + 1;
        continue;
      }
      const bool is_call = i < text.size() && text[i] == '(';
      if (const auto other = other_words().find(word); other != other_words().end()) {
        made += other->second;
        if (word == "const" && i < text.size() && text[i] == ' ') ++i;
      } else if (functions.contains(word)) {
        made += fmt::format("{}{}", kShaderPrefix, word);
      } else if (const auto own = formula_words().find(word); own != formula_words().end()) {
        made += own->second;
      } else {
        made += word;
        if (is_reserved(word) && !is_call) made += '_';
      }
    } else if (std::isdigit(static_cast<unsigned char>(text[i])) != 0) {  // with its exponent, which is no word
      std::size_t end = i + 1;
      while (end < text.size() && (continues_word(text[end]) || text[end] == '.' ||
                                   ((text[end] == '-' || text[end] == '+') && (text[end - 1] == 'e')))) {
        ++end;
      }
      made += text.substr(i, end - i);
      i = end;
    } else {
      made += text[i++];
    }
  }
  return made;
}

/// A number as GLSL reads it: never an integer.
std::string float_text(float value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

/// What a macro of kernels/lobes/formula.clh stands for.
std::string macro_text(std::string_view name) {
  constexpr std::string_view kFile = "lobes/formula.clh";
  const std::string file(kFile);
  const auto files = with_includes(std::span(&file, 1));
  const std::string_view all = files.back().text;
  const std::string begin = fmt::format("#define {} ", name);
  std::string text;
  bool is_inside = false;
  for (std::string_view line : split(all, '\n')) {
    if (line.starts_with(begin)) {
      is_inside = true;
      line.remove_prefix(begin.size());
    }
    if (!is_inside) continue;
    const bool goes_on = line.ends_with("\\");
    if (goes_on) line.remove_suffix(1);
    const std::string_view statement = trim(line);
    if (!statement.empty()) text += fmt::format("  {}\n", statement);
    if (!goes_on) break;
  }
  return text;
}

/// The function of a user's formula under a name of its own; no letter of the user's is in it.
std::string formula_text(std::string_view source, std::string_view name) {
  constexpr std::string_view kBegin = "real formula(";
  std::string text;
  for (const std::string_view line : split(source, '\n')) {
    const std::string_view statement = trim(line);
    if (statement == "FORMULA_GEOMETRY" || statement == "FORMULA_TANGENTS") {
      text += macro_text(statement);
    } else if (line.starts_with(kBegin)) {
      text += fmt::format("real {}({}\n", name, line.substr(kBegin.size()));
    } else if (!line.empty()) {
      text += fmt::format("{}\n", line);
    }
  }
  return text;
}

void require_translatable(const Material& material, const LobeSet& set) {
  const auto refuse = [&](std::string_view what, std::string_view expected) {
    throw NumericError(fmt::format("'{}' {}; expected {}", material.name, what, expected));
  };
  if (!set.deltas.empty()) refuse("has delta parts, which no shader's function has", "a material without them");
  for (const LobeBatch& batch : set.batches) {
    if (batch.kernel.curves > 0) refuse("is pumped up, and its divisors have no text", "a material without '@pump'");
  }
}

/// \throws NumericError beyond single precision
float single(double value, const Material& material) {
  const auto rounded = static_cast<float>(value);
  if (std::isfinite(rounded)) return rounded;
  throw NumericError(fmt::format("'{}' has the constant {}, which single precision cannot hold; expected a wider lobe",
                                 material.name, shortest(value)));
}

/// "lobe_ward(g, c0) * lobe_factor_cos_max(g, lobe_factor_constants(c0.c10, c0.c11))"
std::string product_text(const LobeKernel& kernel, std::size_t lobe) {
  std::string text = fmt::format("{}{}(g, k{})", kShaderPrefix, kernel.model, lobe);
  constexpr std::size_t kFirst = 10;  // coefficient of factors
  for (std::size_t f = 0; f < kernel.factors.size(); ++f) {
    text += fmt::format(" * {}factor_{}(g, lobe_factor_constants(k{}.c{}, k{}.c{}))", kShaderPrefix, kernel.factors[f],
                        lobe, kFirst + 2 * f, lobe, kFirst + 2 * f + 1);
  }
  return text;
}

std::string constants_text(const Shader& shader, std::size_t lobe, bool has_uniforms) {
  std::string text;
  for (std::size_t i = 0; i < kCoefficients; ++i) {
    if (i > 0) text += ", ";
    text += has_uniforms ? fmt::format("lobe_constants[{}].{}", 4 * lobe + i / 4, "xyzw"[i % 4])
                         : float_text(shader.constants[lobe][i]);
  }
  return text;
}

}  // namespace

Shader glsl_shader(const Material& material, const ShaderOptions& options) {
  require_function_name(options.function);
  const LobeSet set = make_lobe_set(std::span(&material, 1), {.with_deltas = true, .with_anisotropic = true});
  require_translatable(material, set);
  const Eigen::MatrixXd colours = shader_colours(material.name, material.channels(), options);

  Shader shader;
  std::vector<std::string> files;
  std::vector<LobeKernel> kernels;    // of each lobe
  std::vector<std::string> formulas;  // of users
  for (const LobeBatch& batch : set.batches) {
    for (const std::string& factor : batch.kernel.factors) files.push_back("factors/" + factor + ".clh");
    const std::string formula = batch.kernel.source.empty() ? "" : fmt::format("formula_{}", formulas.size());
    if (formula.empty()) {
      files.push_back("models/" + batch.kernel.model + ".clh");
    } else {
      files.emplace_back("parts/smooth_boundary.clh");
      formulas.push_back(formula_text(batch.kernel.source, formula));
    }
    for (const auto& coefficients : batch.coefficients) {
      kernels.push_back(batch.kernel);
      if (!formula.empty()) kernels.back().model = formula;
      auto& constants = shader.constants.emplace_back();
      for (std::size_t i = 0; i < kCoefficients; ++i) constants[i] = single(coefficients[i], material);
      auto& weights = shader.weights.emplace_back();
      const auto lobe = static_cast<Eigen::Index>(shader.weights.size() - 1);
      for (Eigen::Index row = 0; row < 3; ++row) {
        double sum = 0;
        for (Eigen::Index c = 0; c < colours.cols(); ++c) {
          sum += colours(row, c) * set.mix[static_cast<std::size_t>(c)].coeff(0, lobe);
        }
        weights[static_cast<std::size_t>(row)] = single(sum, material);
      }
    }
  }

  std::set<std::string, std::less<>> functions;
  std::string definitions;
  for (const KernelFile& file : with_includes(files)) {
    if (file.name == "prelude.clh" || file.name == "parts/factor.clh") continue;
    const std::string text = definitions_of(file.text);
    add_functions(text, functions);
    definitions += translated(text, functions);
  }
  for (const std::string& formula : formulas) {
    add_functions(formula, functions);
    definitions += translated(formula, functions) + "\n";
  }

  const std::size_t lobes = kernels.size();
  const auto text_of = specification(material);
  std::string& text = shader.text;
  const std::string title = fmt::format(
      "// {}: f(L, V) in sr^-1, without the cosine; L and V are unit vectors in coordinates of the surface, z along "
      "its\n"
      "// normal. GLSL ES 3.00 and GLSL 3.30 or later. Made by lobe{}\n",
      options.function, !options.has_uniforms && text_of ? fmt::format(" from '{}'.", *text_of) : ".");
  if (options.has_uniforms) {
    text += fmt::format("uniform vec4 lobe_constants[{}];\nuniform vec3 lobe_weights[{}];\n", 4 * lobes, lobes);
  }
  text += kLog1p;
  if (definitions.find("lobe_expm1") != std::string::npos) text += kExpm1;
  if (definitions.find("lobe_erf") != std::string::npos || !formulas.empty()) text += kErfc;
  if (!formulas.empty()) text += kFormulaFunctions;
  text += kGeometry;
  text += "\n" + definitions;
  require_free_name(options.function, text);
  text = title + text;
  text += fmt::format(
      "vec3 {}(vec3 L, vec3 V) {{\n"
      "  vec3 sum = vec3(0.0, 0.0, 0.0);\n"
      "  if (L.z <= 0.0 || V.z <= 0.0) return sum;\n"
      "  lobe_geometry g = lobe_geometry_of(L, V);\n",
      options.function);
  for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
    text += fmt::format("  lobe_coefficients k{} = lobe_coefficients({});\n", lobe,
                        constants_text(shader, lobe, options.has_uniforms));
    const auto& [red, green, blue] = shader.weights[lobe];
    const std::string weight =
        options.has_uniforms ? fmt::format("lobe_weights[{}]", lobe)
                             : fmt::format("vec3({}, {}, {})", float_text(red), float_text(green), float_text(blue));
    text += fmt::format("  sum += {} * ({});\n", weight, product_text(kernels[lobe], lobe));
  }
  text += "  return sum;\n}\n";
  return shader;
}

}  // namespace lobe
