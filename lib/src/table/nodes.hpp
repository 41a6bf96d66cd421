#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "device/tabulate_pairs.hpp"
#include "hemisphere/gauss.hpp"
#include "lobe/hemisphere/grid.hpp"

namespace lobe {

/// Directions with their quadrature weights (projected solid angle).
struct NodeSet {
  DirectionSet directions;
  std::vector<double> weights;
};

/// One node per ring, with the weight of the whole ring: rows that are enough for isotropic reflectances.
/// \param points per coordinate of each cell
[[nodiscard]] NodeSet ring_nodes(const HemisphereGrid& grid, std::size_t points);

/// Every node.
[[nodiscard]] NodeSet all_nodes(const HemisphereGrid& grid, std::size_t points);

/// Nodes of a product grid at the azimuths 0 .. pi, [ring][k], with the weights of their mirror images added.
[[nodiscard]] NodeSet half_nodes(const HemisphereGrid& grid, std::size_t points);

/// half_nodes() of product grids, all_nodes() of others: what a row of an isotropic reflectance is integrated over.
[[nodiscard]] NodeSet row_nodes(const HemisphereGrid& grid, std::size_t points);

/// Angles from the normal over which functions of theta are averaged, with weights that sum to 1.
struct RingRule {
  std::vector<double> thetas;
  std::vector<double> weights;
};

/// Averages over a node's cell by a Gauss rule, weighted by projected solid angle; on grids without cells the node.
/// \param kinks polar angles between which the function is smooth
[[nodiscard]] RingRule ring_rule(const HemisphereGrid& grid, std::size_t node, std::size_t count,
                                 std::span<const PanelEdge> kinks = {});

}  // namespace lobe
