#pragma once

#include <string_view>

namespace lobe {

/// Whether a word is no name that a text in GLSL ES 3.00 or GLSL 3.30 may give to a function: a keyword, a word that is
/// reserved for keywords to come, a type, or a built-in function, variable or `main`. Words that begin with gl_ or
/// contain two underscores are none either. Source: Khronos, The OpenGL ES Shading Language 3.00.6 and The OpenGL
/// Shading Language 3.30.6, sections 3.6 to 3.9 and chapters 7 and 8.
[[nodiscard]] bool is_glsl_word(std::string_view word);

}  // namespace lobe
