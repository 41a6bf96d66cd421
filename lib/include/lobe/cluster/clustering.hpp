#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/metric/metric.hpp"

namespace [[gnu::visibility("default")]] lobe {

// Distance matrices below are n x n, symmetric, not negative, with a zero diagonal; errors are bounds on them, entry by
// entry. Everything here is deterministic. All functions throw ArgumentError for matrices that are empty, not square,
// not symmetric to 1e-12 of the largest distance or of different sizes, and NumericError for entries that are negative
// or not finite.

/// Two clusters that become one. Clusters below n are the materials; cluster n + i is the result of merge i.
struct Merge {
  std::size_t first = 0;   ///< the smaller number
  std::size_t second = 0;  ///< the larger number
  Estimate height;         ///< mean distance between the materials of both clusters
  std::size_t size = 0;    ///< materials in the new cluster
};

/// A tree of n materials: n - 1 merges with heights that never fall.
struct Dendrogram {
  std::vector<Merge> merges;  ///< n - 1 merges, in order

  /// Number of materials, n.
  [[nodiscard]] std::size_t leaves() const { return merges.size() + 1; }
};

/// Builds a tree by agglomerative clustering with average linkage (UPGMA, Sokal and Michener 1958), along chains of
/// nearest neighbours (Murtagh 1983; Muellner 2011, Fig. 3), O(n^2). Among equal distances the one to the material
/// listed first counts, so trees with ties depend on the order of the materials. The errors of heights hold for the
/// tree as it is.
[[nodiscard]] Dendrogram average_linkage(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error);

/// Orders the leaves so that the distances between neighbours have the smallest sum, among all orders that draw the
/// tree without crossings (Bar-Joseph, Gifford and Jaakkola 2001). Exact, O(n^3) at worst. Of an order and its reverse
/// it returns the one that begins with the smaller index.
/// \throws ArgumentError also for a tree of another size
[[nodiscard]] std::vector<std::size_t> optimal_leaf_order(const Dendrogram& tree, const Eigen::MatrixXd& distance);

/// Cuts a tree into clusters, before its last `clusters` - 1 merges.
/// \return n cluster numbers from 0, in order of the first material of each
/// \throws ArgumentError unless `clusters` is in [1, n]
[[nodiscard]] std::vector<std::size_t> cut(const Dendrogram& tree, std::size_t clusters);

/// Heights at which pairs of materials are joined, n x n (Sokal and Rohlf 1962); an ultrametric.
[[nodiscard]] Eigen::MatrixXd cophenetic_distance(const Dendrogram& tree);

/// Linear correlation between the distances of pairs and their heights in the tree; 1 if the tree represents the
/// distances exactly. Its error is of first order in the distances' errors. NaN if distances or heights are all equal,
/// and with fewer than three materials.
[[nodiscard]] Estimate cophenetic_correlation(const Dendrogram& tree, const Eigen::MatrixXd& distance,
                                              const Eigen::MatrixXd& distance_error);

/// k materials that represent all.
struct Medoids {
  std::vector<std::size_t> medoid;   ///< k materials, rising
  std::vector<std::size_t> cluster;  ///< n: index in `medoid` of the nearest medoid
  Estimate cost;                     ///< sum of the distances to the medoids
};

/// Finds k medoids by swaps, starting from BUILD (Kaufman and Rousseeuw 1990), with swaps as in FasterPAM (Schubert and
/// Rousseeuw 2021, Alg. 4), until no swap of a medoid with another material lowers the cost by more than rounding. The
/// result is such a local optimum, for k = 1 the global one. A material equally near to two medoids belongs to the
/// first.
/// \throws ArgumentError unless k is in [1, n]
[[nodiscard]] Medoids k_medoids(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error, std::size_t k);

/// Silhouettes (b - a) / max(a, b) (Rousseeuw 1987), where a is the mean distance to the others in the same cluster and
/// b the smallest mean distance to another cluster. They lie in [-1, 1], and are 0 for a material that is alone or if
/// there is only one cluster.
/// \param cluster n cluster numbers, from 0 without gaps
/// \throws ArgumentError also if there are not n cluster numbers, or if they have gaps
[[nodiscard]] std::vector<Estimate> silhouettes(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error,
                                                const std::vector<std::size_t>& cluster);

/// A neighbour of a material.
struct Neighbour {
  std::size_t material = 0;        ///< index of the neighbour
  Estimate distance;               ///< distance to it, with its bound
  bool is_rank_uncertain = false;  ///< whether another material is as near within the errors of both
};

/// Finds the nearest other materials of each material, by rising distance; among equal distances in the order of the
/// list.
/// \param count neighbours per material; all n - 1 if there are fewer
[[nodiscard]] std::vector<std::vector<Neighbour>> nearest_neighbours(const Eigen::MatrixXd& distance,
                                                                     const Eigen::MatrixXd& distance_error,
                                                                     std::size_t count);

/// Options for clustering.
struct ClusteringOptions {
  std::size_t clusters = 0;    ///< number of clusters; 0: from 2 to 12, and below n, with the largest mean silhouette
  std::size_t neighbours = 3;  ///< number of nearest materials listed for each
};

/// Quality of a number of clusters.
struct ClusterCount {
  std::size_t clusters = 0;  ///< number of clusters
  Estimate silhouette;       ///< mean over the materials
};

/// Structure of a set of materials, derived from its distance matrix.
struct Clustering {
  Dendrogram tree;                        ///< tree by average linkage
  std::vector<std::size_t> leaf_order;    ///< materials in the order of optimal_leaf_order()
  Estimate cophenetic_correlation;        ///< correlation of the tree's heights with the distances
  std::vector<std::size_t> tree_cluster;  ///< the tree cut into as many clusters as there are medoids
  Medoids medoids;                        ///< representatives, and the materials that belong to them
  std::vector<Estimate> silhouette;       ///< silhouette of each material in its medoid's cluster
  Estimate mean_silhouette;               ///< mean over all materials
  std::vector<ClusterCount> candidates;   ///< numbers of clusters that were tried; empty if the number was given
  std::vector<std::vector<Neighbour>> neighbours;  ///< nearest materials of each, nearest first
};

/// Derives tree, representatives and neighbours of a set of materials from their distances.
/// \throws ArgumentError also for more clusters than materials
[[nodiscard]] Clustering cluster_materials(const Metric& metric, const ClusteringOptions& options = {});

}  // namespace lobe
