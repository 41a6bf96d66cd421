#include "reference/clustering.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace lobe::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Members = std::vector<std::size_t>;

double mean_distance(const Matrix& distance, const Members& a, const Members& b) {
  double sum = 0;
  for (const auto i : a) {
    for (const auto j : b) sum += distance[i][j];
  }
  return sum / static_cast<double>(a.size() * b.size());
}

Members joined(Members a, const Members& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

Matrix average_linkage_heights(const Matrix& distance) {
  const std::size_t n = distance.size();
  Matrix height(n, std::vector<double>(n, 0));
  std::vector<Members> clusters;
  for (std::size_t i = 0; i < n; ++i) clusters.push_back({i});
  while (clusters.size() > 1) {
    double smallest = kInfinity;
    std::size_t first = 0;
    std::size_t second = 1;
    for (std::size_t a = 0; a < clusters.size(); ++a) {
      for (std::size_t b = a + 1; b < clusters.size(); ++b) {
        const double mean = mean_distance(distance, clusters[a], clusters[b]);
        if (mean < smallest) {
          smallest = mean;
          first = a;
          second = b;
        }
      }
    }
    for (const auto i : clusters[first]) {
      for (const auto j : clusters[second]) {
        height[i][j] = smallest;
        height[j][i] = smallest;
      }
    }
    clusters[first] = joined(clusters[first], clusters[second]);
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(second));
  }
  return height;
}

double shortest_leaf_order(const std::vector<std::pair<std::size_t, std::size_t>>& merges, const Matrix& distance) {
  const std::size_t n = distance.size();
  double shortest = kInfinity;
  for (std::size_t flips = 0; flips < (std::size_t{1} << merges.size()); ++flips) {
    std::vector<Members> order;
    for (std::size_t i = 0; i < n; ++i) order.push_back({i});
    for (std::size_t i = 0; i < merges.size(); ++i) {
      const auto& [a, b] = merges[i];
      const bool is_flipped = (flips >> i & 1U) != 0;
      order.push_back(is_flipped ? joined(order[b], order[a]) : joined(order[a], order[b]));
    }
    double length = 0;
    for (std::size_t i = 1; i < n; ++i) length += distance[order.back()[i - 1]][order.back()[i]];
    shortest = std::min(shortest, length);
  }
  return shortest;
}

double smallest_medoid_cost(const Matrix& distance, std::size_t k) {
  const std::size_t n = distance.size();
  double smallest = kInfinity;
  for (std::size_t subset = 0; subset < (std::size_t{1} << n); ++subset) {
    Members medoids;
    for (std::size_t i = 0; i < n; ++i) {
      if ((subset >> i & 1U) != 0) medoids.push_back(i);
    }
    if (medoids.size() != k) continue;
    double cost = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double nearest = kInfinity;
      for (const auto m : medoids) nearest = std::min(nearest, distance[i][m]);
      cost += nearest;
    }
    smallest = std::min(smallest, cost);
  }
  return smallest;
}

double silhouette(const Matrix& distance, const std::vector<std::size_t>& cluster, std::size_t material) {
  std::map<std::size_t, Members> others;
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    if (i != material) others[cluster[i]].push_back(i);
  }
  const std::size_t own = cluster[material];
  if (!others.contains(own)) return 0;
  double b = kInfinity;
  for (const auto& [number, members] : others) {
    if (number != own) b = std::min(b, mean_distance(distance, {material}, members));
  }
  const double a = mean_distance(distance, {material}, others[own]);
  if (b == kInfinity || std::max(a, b) == 0) return 0;
  return (b - a) / std::max(a, b);
}

}  // namespace lobe::reference
