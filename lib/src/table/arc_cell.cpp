#include "table/arc_cell.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hemisphere/square_map.hpp"

namespace lobe {

using std::numbers::pi;

ArcCell arc_cell(const HemisphereGrid& grid, std::size_t node) {
  const Direction at = grid.directions()[node];
  const Ring& ring = grid.rings()[grid.ring_of(node)];
  const double inner = std::sin(ring.theta_low);
  const double outer = std::sin(ring.theta_high);
  if (grid.kind() != GridKind::shirley_chiu) {
    const double half = pi / static_cast<double>(ring.count);
    return {inner, outer, {at.phi - half, 0}, {at.phi + half, 0}, at.phi};
  }
  const double half = 1 / std::sqrt(static_cast<double>(grid.nodes()));
  const SquarePoint middle = hemisphere_to_square(at);
  if (std::abs(std::abs(middle.a) - std::abs(middle.b)) < half / 2) {
    // On a diagonal, between two sectors of the map: it opens with the radius.
    return {inner, outer, {at.phi - pi / 4, pi / 4 * inner}, {at.phi + pi / 4, -pi / 4 * inner}, at.phi};
  }
  const double sector = std::round(at.phi / (pi / 2)) * (pi / 2);
  const double across = (at.phi - sector) / (pi / 4) * std::sin(at.theta);
  return {inner, outer, {sector, pi / 4 * (across - half)}, {sector, pi / 4 * (across + half)}, at.phi};
}

}  // namespace lobe
