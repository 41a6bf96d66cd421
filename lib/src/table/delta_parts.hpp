#pragma once

#include <cstddef>
#include <vector>

namespace lobe {

/// A factor of BrdfTable::mirror or retro; 0 where there is no such part.
[[nodiscard]] inline double delta_part(const std::vector<double>& parts, std::size_t at) {
  return parts.empty() ? 0 : parts[at];
}

}  // namespace lobe
