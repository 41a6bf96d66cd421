#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "formats/shader_tokens.hpp"

namespace lobe {

/// What an instruction does to slots, each of which holds a number; n is its width. Operands with a stride of 0 are the
/// same number for all n.
enum class ShaderOp : std::uint8_t {
  // Moves.
  copy,      // dst = a
  undefine,  // dst = NaN, a variable without a value
  pick,      // dst[k] = a[c's k-th two bits]
  index,     // dst = offset of element a of b elements, of width c each
  load,      // dst = a[offset in b]
  store,     // dst[offset in b] = a
  // Conversions; wrapped numbers are those of 32 bits.
  to_integer,
  to_natural,
  to_truth,
  wrap_integer,
  wrap_natural,
  // Operators.
  add,
  subtract,
  multiply,
  divide,
  divide_integer,
  modulo_integer,
  negate,
  opposite,
  less,
  less_or_equal,
  greater,
  greater_or_equal,
  equal,
  unequal,
  same,     // dst = whether all of a and b are equal
  differs,  // dst = whether any of them is not
  matrix,   // dst = a b, of sizes in c: rows of a, columns of a, columns of b
  // Functions by components.
  radians,
  degrees,
  sine,
  cosine,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,
  hyperbolic_sine,
  hyperbolic_cosine,
  hyperbolic_tangent,
  area_sine,
  area_cosine,
  area_tangent,
  exponential,
  logarithm,
  exponential_2,
  logarithm_2,
  root,
  inverse_root,
  absolute,
  sign,
  floor,
  truncate,
  round,
  round_even,
  ceiling,
  fraction,
  is_nan,
  is_infinite,
  arc_tangent_2,
  power,
  modulo,
  minimum,
  maximum,
  step,
  clamp,
  mix,
  choose,
  smoothstep,
  multiply_add,
  // Functions of vectors.
  dot,
  length,
  distance,
  cross,
  normalise,
  reflect,
  refract,
  face_forward,
  any,
  all,
  transpose,
  outer,
  // Control.
  jump,           // to dst
  jump_if_false,  // a
  call,           // the code at dst
  give_back,      // to where the call was
  halt
};

/// An instruction.
struct ShaderInstruction {
  ShaderOp op = ShaderOp::halt;
  std::array<std::uint8_t, 3> stride{1, 1, 1};  ///< of a, b and c
  std::uint32_t n = 1;
  std::uint32_t dst = 0;
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t c = 0;
  ShaderPlace at = {};
};

/// Why a run ended.
enum class ShaderEnd {
  normal,
  too_long,      // kMostShaderSteps
  outside,       // an index outside its array
  division,      // of an integer by 0
  not_a_number,  // when these are looked for: the first that is not a number
  not_finite     // when these are looked for: the first infinite one
};

/// Instructions of one run, at most; of wide ones every eight numbers count as one more.
inline constexpr std::size_t kMostShaderSteps = 100'000;

/// How a run ended, and where if not normally.
struct ShaderOutcome {
  ShaderEnd end = ShaderEnd::normal;
  ShaderPlace at = {};
  std::size_t steps = 0;
};

/// A function of directions as a program on slots. Nothing recurses, so that all variables have fixed slots.
struct ShaderProgram {
  std::vector<ShaderInstruction> code;
  std::vector<double> slots;  ///< before a run: constants, uniforms, constant globals
  std::size_t deepest = 0;    ///< calls within calls
  std::uint32_t setup = 0;    ///< where the code for constant globals begins
  std::uint32_t entry = 0;    ///< where the code for a pair of directions begins
  std::uint32_t inputs = 0;   ///< slots of L, V, N, X and Y
  std::uint32_t result = 0;   ///< slots of the result
  std::size_t channels = 0;   ///< 1 or 3
};

/// Runs code until it halts.
/// \param slots changed by it
/// \param sought whether to end at the first number that is not one, or not finite
[[nodiscard]] ShaderOutcome run_shader(const ShaderProgram& program, std::span<double> slots, std::uint32_t from,
                                       ShaderEnd sought = ShaderEnd::normal);

/// The end of a run in words, such as "an index is outside its array".
[[nodiscard]] std::string_view shader_end_text(ShaderEnd end);

/// Value of a scalar function by components of one or two numbers, for constants; those of more are not constants.
[[nodiscard]] double shader_value(ShaderOp op, double a, double b);

}  // namespace lobe
