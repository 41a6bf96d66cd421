#pragma once

#include <vector>

#include "device/pair_tabulator.hpp"
#include "lobe/grid.hpp"

namespace lobe {

/// Directions with their quadrature weights (projected solid angle).
struct NodeSet {
  DirectionSet directions;
  std::vector<double> weights;
};

/// One node per ring, with the weight of the whole ring: rows that are enough for isotropic reflectances.
/// \param samples per coordinate of each cell
[[nodiscard]] NodeSet ring_nodes(const HemisphereGrid& grid, std::size_t samples);

/// Every node.
[[nodiscard]] NodeSet all_nodes(const HemisphereGrid& grid, std::size_t samples);

/// Nodes of a product grid at the azimuths 0 .. pi, [ring][k], with the weights of their mirror images added.
[[nodiscard]] NodeSet half_nodes(const HemisphereGrid& grid, std::size_t samples);

/// half_nodes() of product grids, all_nodes() of others: what a row of an isotropic reflectance is integrated over.
[[nodiscard]] NodeSet row_nodes(const HemisphereGrid& grid, std::size_t samples);

}  // namespace lobe
