#include "lobe/cluster/clustering.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "lobe/core/error.hpp"
#include "metric/distance_matrix.hpp"
#include "metric/table_products.hpp"

namespace lobe {
namespace {

using Eigen::Index;

constexpr std::size_t kFewestClusters = 2;
constexpr std::size_t kMostClusters = 12;

struct Grouping {
  Medoids medoids;
  std::vector<Estimate> silhouette;
  Estimate mean_silhouette;
};

Grouping group(const Metric& metric, std::size_t clusters) {
  Grouping grouping{k_medoids(metric.distance, metric.distance_error, clusters), {}, {}};
  grouping.silhouette = silhouettes(metric.distance, metric.distance_error, grouping.medoids.cluster);
  grouping.mean_silhouette = mean(grouping.silhouette);
  return grouping;
}

/// The grouping of largest mean silhouette; of equal ones that of fewer clusters.
Grouping best_grouping(const Metric& metric, std::vector<ClusterCount>& candidates) {
  const auto n = static_cast<std::size_t>(metric.distance.rows());
  Grouping best;
  for (std::size_t clusters = kFewestClusters; clusters <= kMostClusters && clusters < n; ++clusters) {
    Grouping grouping = group(metric, clusters);
    candidates.push_back({clusters, grouping.mean_silhouette});
    if (candidates.size() == 1 || grouping.mean_silhouette.value > best.mean_silhouette.value)
      best = std::move(grouping);
  }
  return candidates.empty() ? group(metric, 1) : best;
}

}  // namespace

std::vector<std::vector<Neighbour>> nearest_neighbours(const Eigen::MatrixXd& distance,
                                                       const Eigen::MatrixXd& distance_error, std::size_t count) {
  require_distances(distance, distance_error);
  const Index n = distance.rows();
  std::vector<std::vector<Neighbour>> lists;
  for (Index i = 0; i < n; ++i) {
    std::vector<Neighbour> list;
    for (Index j = 0; j < n; ++j) {
      if (j != i) list.push_back({static_cast<std::size_t>(j), {distance(j, i), distance_error(j, i)}, false});
    }
    const auto is_nearer = [](const Neighbour& a, const Neighbour& b) { return a.distance.value < b.distance.value; };
    std::stable_sort(list.begin(), list.end(), is_nearer);
    const std::size_t kept = std::min(count, list.size());
    for (std::size_t a = 0; a < kept; ++a) {
      for (std::size_t b = 0; b < list.size() && !list[a].is_rank_uncertain; ++b) {
        const double gap = std::abs(list[a].distance.value - list[b].distance.value);
        list[a].is_rank_uncertain = a != b && gap <= list[a].distance.error + list[b].distance.error;
      }
    }
    list.resize(kept);
    lists.push_back(std::move(list));
  }
  return lists;
}

Clustering cluster_materials(const Metric& metric, const ClusteringOptions& options) {
  Clustering result;
  result.tree = average_linkage(metric.distance, metric.distance_error);
  result.leaf_order = optimal_leaf_order(result.tree, metric.distance);
  result.cophenetic_correlation = cophenetic_correlation(result.tree, metric.distance, metric.distance_error);
  Grouping grouping = options.clusters > 0 ? group(metric, options.clusters) : best_grouping(metric, result.candidates);
  result.medoids = std::move(grouping.medoids);
  result.silhouette = std::move(grouping.silhouette);
  result.mean_silhouette = grouping.mean_silhouette;
  result.tree_cluster = cut(result.tree, result.medoids.medoid.size());
  result.neighbours = nearest_neighbours(metric.distance, metric.distance_error, options.neighbours);
  return result;
}

}  // namespace lobe
