#pragma once

#include <string>

#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// What directions are drawn from.
enum class SamplingStrategy {
  tailored,  ///< the strategies of the material's models
  cosine     ///< the cosine of the angle from the normal, for comparison
};

/// How a direction within a patch of the base plane is drawn where the horizon cuts it off (Neumann 2001, 4.2.4).
enum class PatchDraw {
  exact,      ///< evenly in what is left of the patch, by the inverse of its area
  rejection,  ///< points of the patch or of the unit disc, whichever is smaller, until one is in both
  roulette    ///< one point, lost unless it is in both
};

/// The strategies that directions of a term are drawn by, for people: "Beckmann facets, uniform".
/// \throws ArgumentError for an unknown model
[[nodiscard]] std::string sampling_strategy_text(const Term& term);

}  // namespace lobe
