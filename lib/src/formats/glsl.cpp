// Functions of the OpenGL shading language: what lobe shader prints, and what others write by hand.
// Source: The OpenGL ES Shading Language 3.00.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string_view>
#include <utility>

#include "formats/format.hpp"
#include "formats/shader_compiler.hpp"
#include "hemisphere/unit_vector.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
using Slots = std::vector<double>;

/// Words that a shader may begin with. Those whose declarations are not read are among them, and some of HLSL, for
/// clear complaints.
constexpr std::array<std::string_view, 34> kFirstWords{
    "const",     "uniform", "struct", "precision", "highp",  "mediump", "lowp",      "float",  "int",
    "uint",      "bool",    "void",   "vec2",      "vec3",   "vec4",    "mat2",      "mat3",   "mat4",
    "ivec2",     "ivec3",   "ivec4",  "in",        "out",    "varying", "attribute", "layout", "flat",
    "invariant", "uvec2",   "bvec2",  "float2",    "float3", "float4",  "half3"};
constexpr std::array<std::string_view, 9> kFirstDirectives{"#version",   "#define", "#ifdef",   "#ifndef", "#if",
                                                           "#extension", "#pragma", "#include", "#undef"};

/// Cuts off blanks and comments.
void skip_shader_comments(std::string_view& text) {
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (text.starts_with("//")) {
      text.remove_prefix(std::min(text.find('\n'), text.size()));
    } else if (text.starts_with("/*")) {
      const std::size_t end = text.find("*/", 2);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
    } else {
      return;
    }
  }
}

bool recognises(const FileBytes& head) {
  std::string_view text = head.content();
  if (text.find('\0') != std::string_view::npos) return false;  // no text
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  skip_shader_comments(text);
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n(["));
  if (std::ranges::find(kFirstDirectives, word) != kFirstDirectives.end()) return true;
  if (std::ranges::find(kFirstWords, word) == kFirstWords.end()) return false;
  // A declaration goes on with a name; a table of numbers does not.
  text.remove_prefix(word.size());
  if (text.starts_with("(") || text.starts_with("[")) return word == "layout" || text.starts_with("[");
  skip_shader_comments(text);
  return !text.empty() && (std::isalpha(static_cast<unsigned char>(text.front())) != 0 || text.front() == '_');
}

/// Sets the inputs for a pair of directions: L, V, N, X and Y.
void set_inputs(const ShaderProgram& program, const Directions& pair, Slots& slots) {
  const std::array<Eigen::Vector3d, 5> inputs{
      unit_vector(pair.theta_in, pair.phi_in), unit_vector(pair.theta_out, pair.phi_in + pair.delta_phi),
      Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  double* to = slots.data() + program.inputs;
  for (const Eigen::Vector3d& input : inputs) to = std::copy_n(input.data(), 3, to);
}

std::string pair_of(const Directions& pair) {
  // Adding 0 leaves no "-0".
  const auto degrees = [](double radians) { return std::round(to_degrees(radians) * 1e9) / 1e9 + 0.0; };
  return fmt::format("theta_in {:.6g}°, theta_out {:.6g}°, delta_phi {:.6g}°, phi_in {:.6g}°", degrees(pair.theta_in),
                     degrees(pair.theta_out), degrees(pair.delta_phi), degrees(pair.phi_in));
}

/// A shader's function and what complaints call it.
struct ShaderFunction {
  CompiledShader shader;
  std::string path;

  [[nodiscard]] ShaderOutcome run(const Directions& pair, Slots& slots) const {
    set_inputs(shader.program, pair, slots);
    return run_shader(shader.program, slots, shader.program.entry);
  }

  [[nodiscard]] std::span<const double> result(const Slots& slots) const {
    return std::span(slots).subspan(shader.program.result, shader.program.channels);
  }

  [[noreturn]] void refuse(const ShaderOutcome& outcome, const Directions& pair) const {
    throw NumericError(fmt::format("'{}', line {}, column {}: {} at {}; expected a number", path, outcome.at.line,
                                   outcome.at.column, shader_end_text(outcome.end), pair_of(pair)));
  }

  /// Looks for the place where a value stops to be finite.
  [[noreturn]] void refuse_value(const Directions& pair) const {
    Slots slots = shader.program.slots;
    (void)run(pair, slots);
    const auto values = result(slots);
    const bool is_nan = std::ranges::any_of(values, [](double x) { return std::isnan(x); });
    const ShaderEnd sought = is_nan ? ShaderEnd::not_a_number : ShaderEnd::not_finite;
    slots = shader.program.slots;
    set_inputs(shader.program, pair, slots);
    ShaderOutcome found = run_shader(shader.program, slots, shader.program.entry, sought);
    if (found.end == ShaderEnd::normal) found.end = sought;  // a variable without a value that nothing computes with
    refuse(found, pair);
  }

  [[nodiscard]] BrdfValues at(std::span<const Directions> pairs) const {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(shader.program.channels));
    Slots slots = shader.program.slots;
    for (Eigen::Index i = 0; i < values.value.rows(); ++i) {
      const Directions& pair = pairs[static_cast<std::size_t>(i)];
      const ShaderOutcome outcome = run(pair, slots);
      if (outcome.end != ShaderEnd::normal) refuse(outcome, pair);
      const auto found = result(slots);
      for (Eigen::Index c = 0; c < values.value.cols(); ++c) values.value(i, c) = found[static_cast<std::size_t>(c)];
      if (!values.value.row(i).allFinite()) refuse_value(pair);
    }
    return values;
  }
};

/// A number in [0, 1) for each k, evenly spread (van der Corput).
double spread(std::size_t k, std::size_t base) {
  double value = 0;
  double share = 1;
  for (; k > 0; k /= base) {
    share /= static_cast<double>(base);
    value += share * static_cast<double>(k % base);
  }
  return value;
}

/// Pairs at which a function is turned: anywhere, and about the mirror and the retro direction.
std::vector<Directions> turned_pairs() {
  constexpr std::size_t kPairs = 96;
  constexpr double kNarrow = 0.05;  // radians
  std::vector<Directions> pairs;
  for (std::size_t k = 1; k <= kPairs; ++k) {
    const double in = std::acos(1 - spread(k, 2));
    const double out = std::acos(1 - spread(k, 3));
    const double azimuth = 2 * pi * spread(k, 5);
    pairs.push_back({in, out, azimuth, 0});
    const double near = std::min(in + kNarrow * (spread(k, 7) - 0.5), pi / 2 - kNarrow / 100);
    pairs.push_back({in, std::abs(near), (k % 2 == 0 ? pi : 0) + kNarrow * (azimuth / pi - 1), 0});
  }
  return pairs;
}

/// Whether values stay as they are while both directions turn about the normal, as far as some pairs tell.
bool seems_isotropic(const ShaderFunction& function) {
  constexpr std::array<double, 4> kTurns{0.7, 2.3, 4.1, 1.5707963267948966};
  constexpr double kRounding = 1e-7;  // of directions, which narrow lobes multiply
  constexpr std::size_t kMostSteps = 10'000'000;
  std::size_t steps = 0;
  Slots slots = function.shader.program.slots;
  for (Directions pair : turned_pairs()) {
    const ShaderOutcome first = function.run(pair, slots);
    steps += first.steps;
    if (steps > kMostSteps) return true;
    if (first.end != ShaderEnd::normal) continue;
    const Slots values(function.result(slots).begin(), function.result(slots).end());
    for (const double turn : kTurns) {
      pair.phi_in = turn;
      const ShaderOutcome turned = function.run(pair, slots);
      steps += turned.steps;
      if (turned.end != ShaderEnd::normal) continue;
      const auto others = function.result(slots);
      for (std::size_t c = 0; c < values.size(); ++c) {
        const double larger = std::max(std::abs(values[c]), std::abs(others[c]));
        if (std::abs(values[c] - others[c]) > kRounding * larger) return false;
      }
    }
  }
  return true;
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  auto function = std::make_shared<ShaderFunction>();
  function->shader = compile_shader(file, options);
  function->path = file.path().string();
  const CompiledShader& shader = function->shader;
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kGlslFormat.title;
  brdf.conventions = fmt::format("sr^-1 without cosine, in double precision; function '{}', light '{}', viewer '{}'",
                                 shader.function, shader.light, shader.view);
  if (!shader.uniforms.empty()) brdf.conventions += fmt::format("; {}", fmt::join(shader.uniforms, ", "));
  if (shader.program.channels == 1) {
    brdf.channels = {"value"};
  } else {
    brdf.channels = {"red", "green", "blue"};
  }
  if (shader.candidates > 1) {
    brdf.remarks.push_back(fmt::format("{} functions take two directions; the last one, '{}', is meant",
                                       shader.candidates, shader.function));
  }
  brdf.is_isotropic = seems_isotropic(*function);
  brdf.at = [function, is_isotropic = brdf.is_isotropic](std::span<const Directions> pairs) {
    if (!is_isotropic) return function->at(pairs);
    std::vector<Directions> turned(pairs.begin(), pairs.end());
    for (Directions& pair : turned) pair.phi_in = 0;
    return function->at(turned);
  };
  return brdf;
}

}  // namespace

const Format kGlslFormat{.name = "glsl",
                         .title = "GLSL function (OpenGL shading language)",
                         .recognises = recognises,
                         .read = read,
                         .takes_functions = true};

}  // namespace lobe
