#pragma once

#include <cstddef>

#include "lobe/study/study.hpp"

namespace lobe::test {

/// A study's results made up without a device: `per_family` materials in each of two families, two channels, both
/// lightings. Distances are those of points in the plane, so that the embedding is exact.
[[nodiscard]] StudyResult synthetic_study(std::size_t per_family = 3);

}  // namespace lobe::test
