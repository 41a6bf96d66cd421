#pragma once

#include <cstddef>
#include <span>

#include "lobe/table/table.hpp"

namespace lobe {

/// Bounds on the errors of a channel as sums over azimuth see them, [ring_in][ring_out]: those of the mean of both
/// signs of delta_phi where they are known, else those of all values.
[[nodiscard]] inline std::span<const double> even_errors(const BrdfTable& table, std::size_t channel) {
  const std::size_t pairs = table.grid.rings().size() * table.grid.rings().size();
  return std::span(table.even_error.empty() ? table.error : table.even_error).subspan(channel * pairs, pairs);
}

/// Half the difference of both signs of delta_phi, root mean square over azimuth; 0 where it is in the errors.
[[nodiscard]] inline double odd_part(const BrdfTable& table, std::size_t channel, std::size_t pair) {
  const std::size_t pairs = table.grid.rings().size() * table.grid.rings().size();
  return table.odd_part.empty() ? 0 : table.odd_part[channel * pairs + pair];
}

/// Once values have changed in a way that tells nothing of it.
inline void forget_odd_part(BrdfTable& table) {
  table.even_error.clear();
  table.odd_part.clear();
}

}  // namespace lobe
