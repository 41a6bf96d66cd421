#pragma once

#include <array>
#include <cstddef>

namespace lobe {

/// Gauss nodes per panel and axis at each level of refinement. Both rules of this room take a level; the difference of
/// two successive levels estimates the error of the coarser one.
inline constexpr std::array<int, 9> kNodesPerPanel{6, 8, 10, 12, 15, 18, 22, 27, 33};
inline constexpr int kLevels = static_cast<int>(kNodesPerPanel.size());

}  // namespace lobe
