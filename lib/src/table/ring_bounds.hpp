#pragma once

#include <span>
#include <vector>

namespace lobe {

/// Safety factor on the changes against both embedded rules. For smooth reflectances the result is far above the error;
/// at kinks both rules err.
inline constexpr double kEmbeddedSafety = 3;

/// Changes by ring made into bounds: each takes the largest of its neighbours, and half of the largest within an eighth
/// of the rings, because at single rings both rules may err alike.
[[nodiscard]] std::vector<double> spread_over_rings(std::span<const double> changes);

}  // namespace lobe
