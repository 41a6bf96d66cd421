#pragma once

#include <vector>

#include "device/draw_directions.hpp"
#include "lobe/model/material.hpp"
#include "lobe/model/sampling_strategy.hpp"

namespace lobe {

/// The density that directions of a term with values in sr^-1 are drawn from; shares sum to 1. Factors and weights do
/// not change it. It is above 0 wherever the term's model is not 0, and weights f cos / density have a finite variance.
/// \throws ArgumentError for an unknown model
[[nodiscard]] std::vector<ProposalPart> propose(const Term& term, const UnitVector& light, PatchDraw patches);

}  // namespace lobe
