#pragma once

#include <vector>

#include "lobe/hemisphere/grid.hpp"

namespace lobe {

/// Weights for every second ring of a gauss grid, zero for the others: a coarser rule on the same nodes, to judge the
/// full one by. They integrate f(cos theta) cos(theta) d cos(theta) exactly for polynomials f of degree below their
/// number. On other grids each ring that is kept takes the weight of one that is dropped.
/// \return one weight per ring, per radian of azimuth; they need not be positive
[[nodiscard]] std::vector<double> embedded_ring_weights(const HemisphereGrid& grid);

/// The same for the rings that embedded_ring_weights() leaves out: where a kink makes the difference of the one rule to
/// the full one vanish by chance, that of the other does not. On gauss grids of less than four rings the same rule.
[[nodiscard]] std::vector<double> other_ring_weights(const HemisphereGrid& grid);

/// The same for every `stride`-th ring of a gauss grid with at least so many, the last of each: rings stride - 1,
/// 2 stride - 1, ...
[[nodiscard]] std::vector<double> embedded_ring_weights(const HemisphereGrid& grid, std::size_t stride);

}  // namespace lobe
