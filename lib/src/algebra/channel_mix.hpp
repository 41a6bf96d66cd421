#pragma once

#include <span>
#include <vector>

#include "lobe/table/table.hpp"

namespace lobe {

/// mix() with a weight for each channel of a table, or one for all of them.
/// \throws as mix()
[[nodiscard]] BrdfTable mix_channels(std::span<const std::vector<double>> weights, std::span<const BrdfTable> tables,
                                     bool exact_grid = false);

}  // namespace lobe
