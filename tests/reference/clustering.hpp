#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace lobe::reference {

using Matrix = std::vector<std::vector<double>>;

/// Heights at which average linkage brings pairs together: merges the two clusters whose members have the smallest mean
/// distance, taken from the distances themselves, until one is left.
[[nodiscard]] Matrix average_linkage_heights(const Matrix& distance);

/// Smallest sum of the distances between neighbours over all ways to draw a tree.
/// \param merges clusters that become one, materials from 0, then merges
[[nodiscard]] double shortest_leaf_order(const std::vector<std::pair<std::size_t, std::size_t>>& merges,
                                         const Matrix& distance);

/// Smallest sum of the distances to the nearest of k materials, over all choices of them.
[[nodiscard]] double smallest_medoid_cost(const Matrix& distance, std::size_t k);

/// The silhouette of a material (Rousseeuw 1987).
[[nodiscard]] double silhouette(const Matrix& distance, const std::vector<std::size_t>& cluster, std::size_t material);

}  // namespace lobe::reference
