#include "formats/shader_types.hpp"

#include <algorithm>
#include <array>

namespace lobe {
namespace {

using Op = ShaderOp;
using Shape = ShaderShape;

struct NamedType {
  std::string_view name;
  ShaderType type;
};

constexpr ShaderType shader_matrix(unsigned columns, unsigned rows) {
  return {ShaderBase::real, static_cast<std::uint8_t>(rows), static_cast<std::uint8_t>(columns), 0, 0};
}

constexpr std::array kTypes{NamedType{"void", {}},
                            NamedType{"float", shader_scalar(ShaderBase::real)},
                            NamedType{"int", shader_scalar(ShaderBase::integer)},
                            NamedType{"uint", shader_scalar(ShaderBase::natural)},
                            NamedType{"bool", shader_scalar(ShaderBase::truth)},
                            NamedType{"vec2", shader_vector(ShaderBase::real, 2)},
                            NamedType{"vec3", shader_vector(ShaderBase::real, 3)},
                            NamedType{"vec4", shader_vector(ShaderBase::real, 4)},
                            NamedType{"ivec2", shader_vector(ShaderBase::integer, 2)},
                            NamedType{"ivec3", shader_vector(ShaderBase::integer, 3)},
                            NamedType{"ivec4", shader_vector(ShaderBase::integer, 4)},
                            NamedType{"uvec2", shader_vector(ShaderBase::natural, 2)},
                            NamedType{"uvec3", shader_vector(ShaderBase::natural, 3)},
                            NamedType{"uvec4", shader_vector(ShaderBase::natural, 4)},
                            NamedType{"bvec2", shader_vector(ShaderBase::truth, 2)},
                            NamedType{"bvec3", shader_vector(ShaderBase::truth, 3)},
                            NamedType{"bvec4", shader_vector(ShaderBase::truth, 4)},
                            NamedType{"mat2", shader_matrix(2, 2)},
                            NamedType{"mat3", shader_matrix(3, 3)},
                            NamedType{"mat4", shader_matrix(4, 4)},
                            NamedType{"mat2x2", shader_matrix(2, 2)},
                            NamedType{"mat2x3", shader_matrix(2, 3)},
                            NamedType{"mat2x4", shader_matrix(2, 4)},
                            NamedType{"mat3x2", shader_matrix(3, 2)},
                            NamedType{"mat3x3", shader_matrix(3, 3)},
                            NamedType{"mat3x4", shader_matrix(3, 4)},
                            NamedType{"mat4x2", shader_matrix(4, 2)},
                            NamedType{"mat4x3", shader_matrix(4, 3)},
                            NamedType{"mat4x4", shader_matrix(4, 4)}};

constexpr std::array<std::string_view, 41> kKeywords{
    "attribute", "break",     "case",       "centroid", "const",      "continue", "default", "discard",   "do",
    "double",    "else",      "false",      "flat",     "for",        "goto",     "highp",   "if",        "in",
    "inout",     "invariant", "layout",     "lowp",     "mediump",    "out",      "precise", "precision", "return",
    "sampler2D", "smooth",    "struct",     "switch",   "true",       "typedef",  "uniform", "varying",   "while",
    "buffer",    "shared",    "subroutine", "half",     "samplerCube"};

constexpr unsigned kFirst = 1;
constexpr unsigned kSecond = 2;
constexpr unsigned kThird = 4;

constexpr std::array kBuiltins{ShaderBuiltin{"radians", Op::radians, 1},
                               ShaderBuiltin{"degrees", Op::degrees, 1},
                               ShaderBuiltin{"sin", Op::sine, 1},
                               ShaderBuiltin{"cos", Op::cosine, 1},
                               ShaderBuiltin{"tan", Op::tangent, 1},
                               ShaderBuiltin{"asin", Op::arc_sine, 1},
                               ShaderBuiltin{"acos", Op::arc_cosine, 1},
                               ShaderBuiltin{"atan", Op::arc_tangent, 1},
                               ShaderBuiltin{"atan", Op::arc_tangent_2, 2},
                               ShaderBuiltin{"sinh", Op::hyperbolic_sine, 1},
                               ShaderBuiltin{"cosh", Op::hyperbolic_cosine, 1},
                               ShaderBuiltin{"tanh", Op::hyperbolic_tangent, 1},
                               ShaderBuiltin{"asinh", Op::area_sine, 1},
                               ShaderBuiltin{"acosh", Op::area_cosine, 1},
                               ShaderBuiltin{"atanh", Op::area_tangent, 1},
                               ShaderBuiltin{"exp", Op::exponential, 1},
                               ShaderBuiltin{"log", Op::logarithm, 1},
                               ShaderBuiltin{"exp2", Op::exponential_2, 1},
                               ShaderBuiltin{"log2", Op::logarithm_2, 1},
                               ShaderBuiltin{"pow", Op::power, 2},
                               ShaderBuiltin{"sqrt", Op::root, 1},
                               ShaderBuiltin{"inversesqrt", Op::inverse_root, 1},
                               ShaderBuiltin{"abs", Op::absolute, 1},
                               ShaderBuiltin{"sign", Op::sign, 1},
                               ShaderBuiltin{"floor", Op::floor, 1},
                               ShaderBuiltin{"trunc", Op::truncate, 1},
                               ShaderBuiltin{"round", Op::round, 1},
                               ShaderBuiltin{"roundEven", Op::round_even, 1},
                               ShaderBuiltin{"ceil", Op::ceiling, 1},
                               ShaderBuiltin{"fract", Op::fraction, 1},
                               ShaderBuiltin{"isnan", Op::is_nan, 1},
                               ShaderBuiltin{"isinf", Op::is_infinite, 1},
                               ShaderBuiltin{"mod", Op::modulo, 2, Shape::components, kSecond},
                               ShaderBuiltin{"min", Op::minimum, 2, Shape::components, kSecond},
                               ShaderBuiltin{"max", Op::maximum, 2, Shape::components, kSecond},
                               ShaderBuiltin{"clamp", Op::clamp, 3, Shape::components, kSecond | kThird},
                               ShaderBuiltin{"mix", Op::mix, 3, Shape::components, kThird},
                               ShaderBuiltin{"step", Op::step, 2, Shape::components, kFirst},
                               ShaderBuiltin{"smoothstep", Op::smoothstep, 3, Shape::components, kFirst | kSecond},
                               ShaderBuiltin{"fma", Op::multiply_add, 3},
                               ShaderBuiltin{"lessThan", Op::less, 2, Shape::comparison},
                               ShaderBuiltin{"lessThanEqual", Op::less_or_equal, 2, Shape::comparison},
                               ShaderBuiltin{"greaterThan", Op::greater, 2, Shape::comparison},
                               ShaderBuiltin{"greaterThanEqual", Op::greater_or_equal, 2, Shape::comparison},
                               ShaderBuiltin{"equal", Op::equal, 2, Shape::comparison},
                               ShaderBuiltin{"notEqual", Op::unequal, 2, Shape::comparison},
                               ShaderBuiltin{"dot", Op::dot, 2, Shape::to_scalar},
                               ShaderBuiltin{"length", Op::length, 1, Shape::to_scalar},
                               ShaderBuiltin{"distance", Op::distance, 2, Shape::to_scalar},
                               ShaderBuiltin{"cross", Op::cross, 2, Shape::cross},
                               ShaderBuiltin{"normalize", Op::normalise, 1, Shape::vectors},
                               ShaderBuiltin{"reflect", Op::reflect, 2, Shape::vectors},
                               ShaderBuiltin{"refract", Op::refract, 3, Shape::refract, kThird},
                               ShaderBuiltin{"faceforward", Op::face_forward, 3, Shape::vectors},
                               ShaderBuiltin{"any", Op::any, 1, Shape::truths},
                               ShaderBuiltin{"all", Op::all, 1, Shape::truths},
                               ShaderBuiltin{"not", Op::opposite, 1, Shape::opposite},
                               ShaderBuiltin{"transpose", Op::transpose, 1, Shape::transpose},
                               ShaderBuiltin{"outerProduct", Op::outer, 2, Shape::outer},
                               ShaderBuiltin{"matrixCompMult", Op::multiply, 2, Shape::by_components}};

}  // namespace

std::optional<ShaderType> shader_type(std::string_view name) {
  const auto* found = std::ranges::find(kTypes, name, &NamedType::name);
  return found == kTypes.end() ? std::nullopt : std::optional(found->type);
}

bool is_shader_keyword(std::string_view word) {
  return shader_type(word).has_value() || std::ranges::find(kKeywords, word) != kKeywords.end();
}

const ShaderBuiltin* shader_builtin(std::string_view name, std::size_t arguments) {
  const auto* found = std::ranges::find_if(
      kBuiltins, [&](const ShaderBuiltin& one) { return one.name == name && one.arguments == arguments; });
  return found == kBuiltins.end() ? nullptr : found;
}

std::vector<std::string_view> shader_builtin_names() {
  std::vector<std::string_view> names;
  for (const ShaderBuiltin& one : kBuiltins) {
    if (names.empty() || names.back() != one.name) names.push_back(one.name);
  }
  return names;
}

}  // namespace lobe
