#pragma once

#include <cstddef>
#include <vector>

#include "lobe/hemisphere/grid.hpp"

namespace lobe {

/// Weights for every second ring of a gauss grid, zero for the others: a coarser rule on the same nodes, to judge the
/// full one by. They integrate f(cos theta) cos(theta) d cos(theta) exactly for polynomials f of degree below their
/// number. On other grids each ring that is kept takes the weight of one that is dropped.
/// \return one weight per ring, per radian of azimuth; they need not be positive
[[nodiscard]] std::vector<double> embedded_ring_weights(const HemisphereGrid& grid);

/// Weights of the other embedded rule, on the rings that embedded_ring_weights() leaves out: if a kink happens to make
/// the difference of one rule to the full one vanish, that of the other does not. On gauss grids with less than four
/// rings both rules are the same.
[[nodiscard]] std::vector<double> other_ring_weights(const HemisphereGrid& grid);

/// Weights of the embedded rule on rings first, first + stride, ... of a grid with at least `stride` rings, each made
/// as those of embedded_ring_weights().
[[nodiscard]] std::vector<double> thinned_ring_weights(const HemisphereGrid& grid, std::size_t first,
                                                       std::size_t stride);

/// Weights of the embedded rule on every `stride`-th ring of a gauss grid with at least so many, the last of each:
/// rings stride - 1, 2 stride - 1, ...
[[nodiscard]] std::vector<double> embedded_ring_weights(const HemisphereGrid& grid, std::size_t stride);

}  // namespace lobe
