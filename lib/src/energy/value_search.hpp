#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "lobe/core/directions.hpp"

namespace lobe {

/// Pairs of directions spread evenly, the same in every run: in equal parts anywhere, about the mirror direction, about
/// the retro direction, and at grazing angles; see check_plausibility(). The first quarter are those anywhere.
[[nodiscard]] std::vector<Directions> spread_pairs(std::size_t count, bool with_azimuths);

/// Reverses a pair: seen backward, from viewer to light.
[[nodiscard]] Directions reversed(const Directions& pair);

/// A pair of directions and what speaks for it.
struct FoundPair {
  double merit = 0;
  Directions at;
};

/// Merits of pairs of directions; no NaN.
using PairMerit = std::function<Eigen::ArrayXd(std::span<const Directions>)>;

/// Searches for the largest merit around the best of some pairs, in boxes that shrink.
/// \param merits of the pairs
[[nodiscard]] FoundPair best_pair(const PairMerit& merit, std::span<const Directions> pairs,
                                  const Eigen::ArrayXd& merits, bool with_azimuths);

}  // namespace lobe
