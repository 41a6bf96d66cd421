#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/read/toml.hpp"

namespace lobe {

/// The values of one parameter in a family, with the texts that stand for them in labels.
struct Sweep {
  std::string parameter;
  const toml::node* place = nullptr;
  std::vector<double> values;
  std::vector<std::string> texts;
};

/// Largest number of materials that one family may unfold to.
inline constexpr std::size_t kLargestSweep = 100000;

/// Reads a number, a list of numbers, {values = [...]}, {linspace = [a, b], count = n} or {logspace = [a, b], count =
/// n}. Ends of a range are included and exact.
/// \throws ArgumentError with the place.
[[nodiscard]] Sweep read_sweep(std::string_view parameter, const toml::node& node);

/// Combinations of sweeps as places in each. Sweeps of one group go together: the first of each, the second of each and
/// so on; groups, and sweeps that are in none, make every combination, the last one running fastest.
/// \param groups places of sweeps, none in two groups
/// \param place of the family, for messages
/// \throws ArgumentError when sweeps of a group differ in length (single values fit any) or there are too many.
[[nodiscard]] std::vector<std::vector<std::size_t>> combine(const std::vector<Sweep>& sweeps,
                                                            const std::vector<std::vector<std::size_t>>& groups,
                                                            const toml::node& place);

}  // namespace lobe
