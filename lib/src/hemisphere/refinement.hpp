#pragma once

#include <array>
#include <cstddef>

namespace lobe {

/// Gauss nodes per panel and axis at each level of refinement. Both rules of this room take a level; the difference of
/// two successive levels estimates the error of the coarser one.
inline constexpr std::array<int, 9> kNodesPerPanel{6, 8, 10, 12, 15, 18, 22, 27, 33};
inline constexpr int kLevels = static_cast<int>(kNodesPerPanel.size());

/// Gauss nodes for loose tolerances where azimuths have panels, too, and of L under patch lights: on one axis more the
/// first levels of kNodesPerPanel cost ten times as much and reach 1e-7 or so. Levels of 3 and 4 nodes agreed by
/// accident.
inline constexpr std::array<int, kLevels> kLooseNodesPerPanel{4, 6, 8, 10, 13, 16, 20, 26, 33};

/// Below it levels coarser than those of kNodesPerPanel are only lost time.
inline constexpr double kLooseTolerance = 1e-4;

}  // namespace lobe
