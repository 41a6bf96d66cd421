#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobe/study/study.hpp"

namespace lobe {

/// to_string() of one of a study's origins; empty where the study was made in code and has none.
[[nodiscard]] inline std::string origin_text(std::span<const Origin> origins, std::size_t index) {
  return index < origins.size() ? to_string(origins[index]) : std::string();
}

/// One for each of so many.
[[nodiscard]] inline std::vector<std::string> origin_texts(std::span<const Origin> origins, std::size_t count) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) texts.push_back(origin_text(origins, i));
  return texts;
}

/// Explanation of origins in results.
inline constexpr const char* kOriginMeaning =
    "place in the study's files: FILE:LINE, what varies within the line, and what was set from outside";

}  // namespace lobe
