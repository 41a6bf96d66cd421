#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/shader_program.hpp"

namespace lobe {

enum class ShaderBase : std::uint8_t { nothing, real, integer, natural, truth, structure };

/// A type of the shading language: a scalar, vector, matrix or structure, or an array of them.
struct ShaderType {
  ShaderBase base = ShaderBase::nothing;
  std::uint8_t rows = 1;
  std::uint8_t columns = 1;
  std::uint16_t structure = 0;  ///< number of the structure
  std::uint32_t count = 0;      ///< elements of an array; 0: no array

  [[nodiscard]] bool is_plain() const { return count == 0 && base != ShaderBase::structure; }
  [[nodiscard]] bool is_scalar() const { return is_plain() && rows == 1 && columns == 1; }
  [[nodiscard]] bool is_vector() const { return is_plain() && rows > 1 && columns == 1; }
  [[nodiscard]] bool is_matrix() const { return is_plain() && columns > 1; }
  [[nodiscard]] bool is_number() const {
    return is_plain() && (base == ShaderBase::real || base == ShaderBase::integer || base == ShaderBase::natural);
  }
  [[nodiscard]] bool is_integer() const {
    return is_plain() && (base == ShaderBase::integer || base == ShaderBase::natural);
  }
  [[nodiscard]] bool is_truth() const { return is_scalar() && base == ShaderBase::truth; }
  /// Components of a type that is plain.
  [[nodiscard]] std::uint32_t size() const { return std::uint32_t{rows} * columns; }
  [[nodiscard]] ShaderType with_base(ShaderBase other) const {
    ShaderType type = *this;
    type.base = other;
    return type;
  }
  [[nodiscard]] ShaderType element() const {
    ShaderType type = *this;
    type.count = 0;
    return type;
  }
  bool operator==(const ShaderType&) const = default;
};

[[nodiscard]] constexpr ShaderType shader_scalar(ShaderBase base) {
  return {base, 1, 1, 0, 0};
}
[[nodiscard]] constexpr ShaderType shader_vector(ShaderBase base, std::uint32_t size) {
  return {base, static_cast<std::uint8_t>(size), 1, 0, 0};
}

struct ShaderMember {
  std::string_view name;
  ShaderType type;
  std::uint32_t offset = 0;
};
struct ShaderStructure {
  std::string_view name;
  std::vector<ShaderMember> members;
  std::uint32_t slots = 0;
};

/// The type of a keyword, such as vec3.
[[nodiscard]] std::optional<ShaderType> shader_type(std::string_view name);
/// Whether a word is one of GLSL's that no name may be.
[[nodiscard]] bool is_shader_keyword(std::string_view word);

/// How arguments and result of a function of GLSL fit together.
enum class ShaderShape {
  components,    ///< all of one size, also the result; some may be scalars
  comparison,    ///< vectors of one size, a vector of truths
  to_scalar,     ///< vectors of one size, a scalar
  vectors,       ///< vectors of one size, the result, too
  cross,         ///< vectors of three
  refract,       ///< two vectors and a scalar, a vector
  truths,        ///< a vector of truths, one truth
  opposite,      ///< a vector of truths
  transpose,     ///< a matrix
  outer,         ///< two vectors, a matrix
  by_components  ///< two matrices of one size
};

/// A function of GLSL.
struct ShaderBuiltin {
  std::string_view name;
  ShaderOp op;
  std::size_t arguments;
  ShaderShape shape = ShaderShape::components;
  unsigned scalars = 0;  ///< bits of the arguments that may be scalars beside vectors
};

/// The function of a name and a number of arguments, or nothing.
[[nodiscard]] const ShaderBuiltin* shader_builtin(std::string_view name, std::size_t arguments);
/// The names of all functions.
[[nodiscard]] std::vector<std::string_view> shader_builtin_names();

}  // namespace lobe
