#pragma once

#include <cstddef>
#include <cstdlib>

namespace lobe::test {

/// A number from the environment, by which tests of random cases become longer or other ones.
inline std::size_t number_from(const char* variable, std::size_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace lobe::test
