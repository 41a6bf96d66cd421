#pragma once

#include "lobe/study/study.hpp"

namespace lobe {

/// A study made in code may leave its channels unnamed and unweighted; and where it has several, one of its formulas at
/// least says so. What has been through this comes out of it again as it is.
/// \throws ArgumentError where channels and weights do not fit
[[nodiscard]] Study with_channels(Study study);

}  // namespace lobe
