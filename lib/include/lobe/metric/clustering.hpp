#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/metric/metric.hpp"

namespace lobe {

// Distance matrices below are n x n, symmetric, not negative, with a zero diagonal; errors are bounds on them, entry by
// entry. Everything here is deterministic. All functions throw ArgumentError for matrices that are empty, not square,
// not symmetric to 1e-12 of the largest distance or of different sizes, and NumericError for entries that are negative
// or not finite.

/// Two clusters that become one. Clusters below n are the materials; cluster n + i is the one that merge i makes.
struct Merge {
  std::size_t first = 0;   ///< the smaller number
  std::size_t second = 0;  ///< the larger number
  Estimate height;         ///< mean distance between the materials of the one and those of the other
  std::size_t size = 0;    ///< materials in the new cluster
};

/// A tree of n materials: n - 1 merges, heights never falling.
struct Dendrogram {
  std::vector<Merge> merges;  ///< n - 1, in the order in which they are done

  /// Number of materials, n.
  [[nodiscard]] std::size_t leaves() const { return merges.size() + 1; }
};

/// Agglomerative clustering with average linkage (UPGMA, Sokal and Michener 1958) along chains of nearest neighbours
/// (Murtagh 1983; Muellner 2011, Fig. 3), O(n^2). Of equal distances the one to the material listed first counts, so
/// trees of distances with ties depend on the order of the materials; the errors of heights are those of the tree as it
/// is.
[[nodiscard]] Dendrogram average_linkage(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error);

/// Order of the leaves, among all those that draw the tree without crossings, in which the distances between neighbours
/// have the smallest sum (Bar-Joseph, Gifford and Jaakkola 2001). Exact, O(n^3) at worst. Of an order and its reverse
/// the one that begins with the smaller index.
/// \throws ArgumentError also for a tree of another size.
[[nodiscard]] std::vector<std::size_t> optimal_leaf_order(const Dendrogram& tree, const Eigen::MatrixXd& distance);

/// The tree's clusters once all but its last `clusters` - 1 merges are done.
/// \return n numbers of clusters from 0, in order of the first material of each
/// \throws ArgumentError unless `clusters` is in [1, n].
[[nodiscard]] std::vector<std::size_t> cut(const Dendrogram& tree, std::size_t clusters);

/// Heights at which pairs of materials come together, n x n (Sokal and Rohlf 1962). An ultrametric.
[[nodiscard]] Eigen::MatrixXd cophenetic_distance(const Dendrogram& tree);

/// Linear correlation between the distances of pairs and their heights in the tree: 1 where the tree tells all. The
/// error is that of first order in the distances' errors. NaN where distances or heights are all the same, with fewer
/// than three materials above all.
[[nodiscard]] Estimate cophenetic_correlation(const Dendrogram& tree, const Eigen::MatrixXd& distance,
                                              const Eigen::MatrixXd& distance_error);

/// k materials that stand for all.
struct Medoids {
  std::vector<std::size_t> medoid;   ///< k materials, rising
  std::vector<std::size_t> cluster;  ///< n: place in `medoid` of the nearest one
  Estimate cost;                     ///< sum of the distances to it
};

/// k-medoids by swaps: start by BUILD (Kaufman and Rousseeuw 1990), swaps as in FasterPAM (Schubert and Rousseeuw 2021,
/// Alg. 4), until none of a medoid with another material lowers the cost by more than rounding. The result is such a
/// local optimum, for k = 1 the global one. A material as near to two medoids belongs to the first.
/// \throws ArgumentError unless k is in [1, n].
[[nodiscard]] Medoids k_medoids(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error, std::size_t k);

/// Silhouettes (b - a) / max(a, b) (Rousseeuw 1987): a is the mean distance to the others of the own cluster, b the
/// smallest mean distance to another cluster; in [-1, 1], and 0 for a material that is alone or where there is one
/// cluster only.
/// \param cluster n numbers of clusters, from 0 without gaps
/// \throws ArgumentError also for clusters of another number, or with gaps.
[[nodiscard]] std::vector<Estimate> silhouettes(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error,
                                                const std::vector<std::size_t>& cluster);

/// A material near another one.
struct Neighbour {
  std::size_t material = 0;        ///< its number
  Estimate distance;               ///< to it, with its bound
  bool is_rank_uncertain = false;  ///< another material is as near within the errors of both
};

/// The nearest other materials of each, by rising distance, of equal ones the first listed first.
/// \param count of neighbours per material; all n - 1 where there are fewer
[[nodiscard]] std::vector<std::vector<Neighbour>> nearest_neighbours(const Eigen::MatrixXd& distance,
                                                                     const Eigen::MatrixXd& distance_error,
                                                                     std::size_t count);

/// How much a clustering tells.
struct ClusteringOptions {
  std::size_t clusters = 0;    ///< 0: the number from 2 to 12, and below n, whose mean silhouette is largest
  std::size_t neighbours = 3;  ///< nearest materials listed of each
};

/// How good a number of clusters is.
struct ClusterCount {
  std::size_t clusters = 0;  ///< the number
  Estimate silhouette;       ///< mean over the materials
};

/// What a distance matrix says of kinship between materials.
struct Clustering {
  Dendrogram tree;                                 ///< by average linkage
  std::vector<std::size_t> leaf_order;             ///< materials in the order that optimal_leaf_order() finds
  Estimate cophenetic_correlation;                 ///< of the tree's heights with the distances
  std::vector<std::size_t> tree_cluster;           ///< the tree cut into as many clusters as there are medoids
  Medoids medoids;                                 ///< representatives and who belongs to them
  std::vector<Estimate> silhouette;                ///< of each material in its medoid's cluster
  Estimate mean_silhouette;                        ///< over all materials
  std::vector<ClusterCount> candidates;            ///< numbers of clusters that were tried; empty where it was given
  std::vector<std::vector<Neighbour>> neighbours;  ///< nearest materials of each, nearest first
};

/// Tree, representatives and neighbours of a set of materials from their distances.
/// \throws ArgumentError also for more clusters than materials.
[[nodiscard]] Clustering cluster_materials(const Metric& metric, const ClusteringOptions& options = {});

}  // namespace lobe
