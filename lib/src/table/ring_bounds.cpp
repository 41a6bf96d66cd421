#include "table/ring_bounds.hpp"

#include <algorithm>
#include <cstddef>

namespace lobe {

std::vector<double> spread_over_rings(std::span<const double> changes) {
  constexpr double kFarShare = 0.5;
  const std::size_t rings = changes.size();
  const auto largest = [&](std::size_t ring, std::size_t reach) {
    const std::size_t first = ring - std::min(ring, reach);
    return *std::ranges::max_element(changes.subspan(first, std::min(rings, ring + reach + 1) - first));
  };
  std::vector<double> bounds;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    bounds.push_back(std::max(largest(ring, 1), kFarShare * largest(ring, std::max<std::size_t>(2, rings / 8))));
  }
  return bounds;
}

}  // namespace lobe
