#pragma once

#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

namespace lobe::test {

/// True under LOBE_TEST_SCALE=small: an instrumented runtime costs about 1e4 times a normal one per work-item.
inline bool small_scale() {
  const char* scale = std::getenv("LOBE_TEST_SCALE");
  return scale != nullptr && std::string_view(scale) == "small";
}

/// True under LOBE_TEST_SCALE=full, the long form of sweeps over many cases (script/test --long).
inline bool full_scale() {
  const char* scale = std::getenv("LOBE_TEST_SCALE");
  return scale != nullptr && std::string_view(scale) == "full";
}

/// How many cases of a sweep are tried: all of them, or a part that script/test has the time for.
inline std::size_t swept(std::size_t all, std::size_t part) {
  return full_scale() ? all : part;
}

/// Cases of a sweep: all of them, or one of `every`.
template <typename T>
std::vector<T> swept_of(std::vector<T> all, std::size_t every) {
  if (full_scale()) return all;
  std::vector<T> part;
  for (std::size_t i = 0; i < all.size(); i += every) part.push_back(std::move(all[i]));
  return part;
}

/// A size or tolerance by the scale of the run; the one place where instrumented runs are made smaller.
template <typename T>
T scaled(T full, T small) {
  return small_scale() ? small : full;
}

}  // namespace lobe::test
