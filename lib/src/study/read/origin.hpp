#pragma once

#include <string>

#include "lobe/study/study.hpp"

namespace lobe {

/// Reads the text of an origin, as to_string() writes it. A text of another form is kept as the name of a file.
[[nodiscard]] Origin read_origin(const std::string& text);

}  // namespace lobe
