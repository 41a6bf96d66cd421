#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>

#include "lobe/render/shader.hpp"

namespace lobe {

/// Prefix of everything that is global in a shader's text, but for the function itself.
inline constexpr std::string_view kShaderPrefix = "lobe_";

/// Whether a word of GLSL may begin with this character.
[[nodiscard]] bool begins_word(char letter);
/// Whether a word of GLSL may contain this character after the first.
[[nodiscard]] bool continues_word(char letter);

/// The word that begins at a place of a text.
[[nodiscard]] std::string_view word_at(std::string_view text, std::size_t at);

/// Refuses what is no name of a function.
/// \throws ArgumentError
void require_function_name(const std::string& name);

/// Refuses a name that a text without the function itself has.
/// \throws ArgumentError
void require_free_name(const std::string& name, std::string_view text);

/// Rows for red, green and blue, columns for channels.
/// \param name of the reflectance, for the error
/// \throws ArgumentError for channels without colours, and weights that do not fit
[[nodiscard]] Eigen::MatrixXd shader_colours(const std::string& name, std::size_t channels,
                                             const ShaderOptions& options);

}  // namespace lobe
