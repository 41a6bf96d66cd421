#pragma once

#include <string>

#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Distributions from which directions are drawn.
enum class SamplingStrategy {
  tailored,  ///< the sampling strategies of the material's models
  cosine     ///< the cosine of the angle from the normal, for comparison
};

/// How a direction within a patch of the base plane is drawn if the horizon cuts the patch (Neumann 2001, 4.2.4).
enum class PatchDraw {
  exact,      ///< uniformly in the visible part of the patch, with the inverse of its area as density
  rejection,  ///< points of the patch or of the unit disc, whichever is smaller, until one is in both
  roulette    ///< one point, lost unless it is in both
};

/// Names the strategies that draw directions for a term, for people: "Beckmann facets, uniform".
/// \throws ArgumentError for an unknown model
[[nodiscard]] std::string sampling_strategy_text(const Term& term);

}  // namespace lobe
