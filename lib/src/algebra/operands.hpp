#pragma once

#include <span>

#include "lobe/table.hpp"

namespace lobe {

/// \throws ArgumentError when the grids differ and `exact_grid` is true.
void require_same_grid(const BrdfTable& first, const BrdfTable& other, bool exact_grid);

/// Brings tables on one grid to one form (general if any is) and one number of channels (a single one serves all).
/// \throws ArgumentError for channel counts that do not fit.
void match_operands(std::span<BrdfTable> tables);

}  // namespace lobe
