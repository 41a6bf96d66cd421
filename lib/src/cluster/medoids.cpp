#include <algorithm>
#include <string>

#include "core/numbers.hpp"
#include "lobe/cluster/clustering.hpp"
#include "lobe/core/error.hpp"
#include "metric/distance_matrix.hpp"

namespace lobe {
namespace {

using Eigen::Index;

constexpr double kRounding = 1e-12;  // a swap must lower the cost by more than this share of it

/// A material's nearest medoid, as a place in their list, and the distance of the second nearest.
struct Nearest {
  std::size_t medoid = 0;
  double distance = kInfinity;
  double second = kInfinity;
};

Nearest nearest_of(const Eigen::MatrixXd& distance, const std::vector<std::size_t>& medoids, Index material) {
  Nearest nearest;
  for (std::size_t k = 0; k < medoids.size(); ++k) {
    const double value = distance(static_cast<Index>(medoids[k]), material);
    if (value < nearest.distance) {
      nearest = {k, value, nearest.distance};
    } else {
      nearest.second = std::min(nearest.second, value);
    }
  }
  return nearest;
}

std::vector<Nearest> assign(const Eigen::MatrixXd& distance, const std::vector<std::size_t>& medoids) {
  std::vector<Nearest> nearest;
  for (Index i = 0; i < distance.rows(); ++i) nearest.push_back(nearest_of(distance, medoids, i));
  return nearest;
}

double cost_of(const std::vector<Nearest>& nearest) {
  double cost = 0;
  for (const auto& entry : nearest) cost += entry.distance;
  return cost;
}

bool is_medoid(const std::vector<std::size_t>& medoids, std::size_t material) {
  return std::find(medoids.begin(), medoids.end(), material) != medoids.end();
}

/// BUILD: one medoid after the other, each the one that lowers the cost most.
std::vector<std::size_t> build(const Eigen::MatrixXd& distance, std::size_t k) {
  const Index n = distance.rows();
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(n, kInfinity);
  std::vector<std::size_t> medoids;
  while (medoids.size() < k) {
    double smallest = kInfinity;
    Index best = 0;
    for (Index i = 0; i < n; ++i) {
      const double cost = nearest.cwiseMin(distance.col(i)).sum();
      if (cost < smallest && !is_medoid(medoids, static_cast<std::size_t>(i))) {
        smallest = cost;
        best = i;
      }
    }
    medoids.push_back(static_cast<std::size_t>(best));
    nearest = nearest.cwiseMin(distance.col(best));
  }
  return medoids;
}

/// The change of cost when a material becomes a medoid, and the medoid that it best takes the place of.
struct Swap {
  std::size_t medoid = 0;
  double change = 0;
};

/// The terms of all k swaps with one candidate in one pass (Schubert and Rousseeuw 2021, eqs. 9 to 11).
Swap best_swap(const Eigen::MatrixXd& distance, const std::vector<Nearest>& nearest, std::size_t medoids,
               std::size_t candidate) {
  std::vector<double> change(medoids, 0);  // by the medoid that is removed
  double shared = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const Nearest& old = nearest[i];
    const double value = distance(static_cast<Index>(i), static_cast<Index>(candidate));
    if (value < old.distance) {
      shared += value - old.distance;
    } else {
      change[old.medoid] += std::min(value, old.second) - old.distance;
    }
  }
  const auto best = std::min_element(change.begin(), change.end());
  return {static_cast<std::size_t>(best - change.begin()), *best + shared};
}

/// Swaps as soon as one lowers the cost, until a whole round of candidates has none.
void swap_medoids(const Eigen::MatrixXd& distance, std::vector<std::size_t>& medoids) {
  const auto n = static_cast<std::size_t>(distance.rows());
  std::vector<Nearest> nearest = assign(distance, medoids);
  double cost = cost_of(nearest);
  std::size_t without_swap = 0;
  for (std::size_t candidate = 0; without_swap < n; candidate = (candidate + 1) % n) {
    ++without_swap;
    if (is_medoid(medoids, candidate)) continue;
    const Swap swap = best_swap(distance, nearest, medoids.size(), candidate);
    if (!(swap.change < -kRounding * cost)) continue;
    medoids[swap.medoid] = candidate;
    nearest = assign(distance, medoids);
    cost = cost_of(nearest);
    without_swap = 0;
  }
}

}  // namespace

Medoids k_medoids(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error, std::size_t k) {
  require_distances(distance, distance_error);
  const auto n = static_cast<std::size_t>(distance.rows());
  if (k < 1 || k > n) {
    throw ArgumentError(std::to_string(k) + " medoids of " + std::to_string(n) +
                        " materials; expected a number in [1, " + std::to_string(n) + "]");
  }
  Medoids result;
  result.medoid = build(distance, k);
  swap_medoids(distance, result.medoid);
  std::sort(result.medoid.begin(), result.medoid.end());
  for (Index i = 0; i < distance.rows(); ++i) {
    const Nearest nearest = nearest_of(distance, result.medoid, i);
    result.cluster.push_back(nearest.medoid);
    result.cost.value += nearest.distance;
    // A bound wherever the true nearest medoid is another one, too.
    double error = 0;
    for (const auto medoid : result.medoid) error = std::max(error, distance_error(static_cast<Index>(medoid), i));
    result.cost.error += error;
  }
  // A medoid that another one coincides with still is of its own cluster.
  for (std::size_t m = 0; m < k; ++m) result.cluster[result.medoid[m]] = m;
  return result;
}

std::vector<Estimate> silhouettes(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error,
                                  const std::vector<std::size_t>& cluster) {
  require_distances(distance, distance_error);
  if (static_cast<Index>(cluster.size()) != distance.rows()) {
    throw ArgumentError("clusters of " + std::to_string(cluster.size()) + " materials with distances of " +
                        std::to_string(distance.rows()) + "; expected as many");
  }
  const std::size_t largest = *std::max_element(cluster.begin(), cluster.end());
  std::vector<double> size(std::min(largest, cluster.size()) + 1, 0);
  for (const auto k : cluster) {
    if (k < size.size()) ++size[k];
  }
  if (largest >= cluster.size() || std::find(size.begin(), size.end(), 0) != size.end()) {
    throw ArgumentError("clusters are numbered up to " + std::to_string(largest) +
                        " with gaps; expected numbers from 0 without gaps");
  }
  std::vector<Estimate> result;
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    const std::size_t own = cluster[i];
    if (size[own] == 1 || size.size() == 1) {
      result.push_back({0, 0});
      continue;
    }
    std::vector<Estimate> mean(size.size());
    for (std::size_t j = 0; j < cluster.size(); ++j) {
      if (j == i) continue;
      const double members = size[cluster[j]] - (cluster[j] == own ? 1 : 0);
      mean[cluster[j]].value += distance(static_cast<Index>(j), static_cast<Index>(i)) / members;
      mean[cluster[j]].error += distance_error(static_cast<Index>(j), static_cast<Index>(i)) / members;
    }
    const Estimate inside = mean[own];
    Estimate outside{kInfinity, 0};
    for (std::size_t k = 0; k < mean.size(); ++k) {
      if (k == own) continue;
      outside.value = std::min(outside.value, mean[k].value);
      outside.error = std::max(outside.error, mean[k].error);
    }
    const double scale = std::max(inside.value, outside.value);
    if (!(scale > 0)) {
      result.push_back({0, 0});
      continue;
    }
    const double error = (inside.value * outside.error + outside.value * inside.error) / (scale * scale);
    result.push_back({(outside.value - inside.value) / scale, std::min(error, 2.0)});
  }
  return result;
}

}  // namespace lobe
