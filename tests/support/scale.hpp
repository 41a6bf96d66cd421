#pragma once

#include <cstddef>
#include <cstdlib>
#include <string_view>

namespace lobe::test {

/// True under LOBE_TEST_SCALE=small: an instrumented runtime costs about 1e4 times a normal one per work-item.
inline bool small_scale() {
  const char* scale = std::getenv("LOBE_TEST_SCALE");
  return scale != nullptr && std::string_view(scale) == "small";
}

/// A size or tolerance by the scale of the run; the one place where instrumented runs are made smaller.
template <typename T>
T scaled(T full, T small) {
  return small_scale() ? small : full;
}

}  // namespace lobe::test
