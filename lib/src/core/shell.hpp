#pragma once

#include <string>
#include <string_view>

namespace lobe {

/// A word as a shell takes it: between quotes where it has any character that might mean something to one.
[[nodiscard]] std::string shell_word(std::string_view word);

}  // namespace lobe
