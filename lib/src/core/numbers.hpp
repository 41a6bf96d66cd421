#pragma once

#include <limits>

namespace lobe {

/// What is not known, as errors of what was read without them.
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace lobe
