#pragma once

#include <vector>

#include "device/draw_directions.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// The density that directions V of a table are drawn from for L: constant over cells of the base plane, in proportion
/// to the mean size of the interpolated values there, and for a tenth the cosine, as values between the nodes may be
/// where no cell shows any. Cells are those of the nodes of a product grid with at most 128 rings of 256 azimuths, else
/// 32 bands of equal projected solid angle with 64 azimuths.
[[nodiscard]] std::vector<ProposalPart> propose(const BrdfTable& table, Direction in);

/// Vose's alias table of probabilities in proportion to `sizes`: by index the share that stays, then the index that
/// gets the rest.
/// \param sizes at least one above 0, none below
[[nodiscard]] std::vector<double> alias_table(const std::vector<double>& sizes);

}  // namespace lobe
