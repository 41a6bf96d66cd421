#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "lobe/cluster/clustering.hpp"
#include "lobe/core/error.hpp"
#include "metric/distance_matrix.hpp"

namespace lobe {
namespace {

using Eigen::Index;

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

Index at(std::size_t i) {
  return static_cast<Index>(i);
}

/// A merge while the tree grows: a cluster is known by one of its materials.
struct Join {
  std::size_t first = 0;
  std::size_t second = 0;
  Estimate height;
};

/// Clusters and the mean distances between them. The column of a cluster is that of one of its materials.
class MeanDistances {
 public:
  MeanDistances(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& error)
      : distance_(distance.selfadjointView<Eigen::Lower>()),
        error_(error.selfadjointView<Eigen::Lower>()),
        size_(static_cast<std::size_t>(distance.rows()), 1),
        alive_(size_.size()) {
    std::iota(alive_.begin(), alive_.end(), std::size_t{0});
  }

  [[nodiscard]] std::size_t first() const { return alive_.front(); }
  [[nodiscard]] Estimate between(std::size_t a, std::size_t b) const {
    return {distance_(at(a), at(b)), error_(at(a), at(b))};
  }

  /// The nearest other cluster; of equal ones the favourite, else the first.
  [[nodiscard]] std::size_t nearest(std::size_t cluster, std::size_t favourite) const {
    std::size_t best = favourite;
    double smallest =
        favourite == kNone ? std::numeric_limits<double>::infinity() : distance_(at(favourite), at(cluster));
    for (const auto other : alive_) {
      const double value = distance_(at(other), at(cluster));
      if (other != cluster && value < smallest) {
        smallest = value;
        best = other;
      }
    }
    return best;
  }

  /// Lance and Williams 1967: means over the materials of both. The new cluster takes the place of `kept`.
  void join(std::size_t kept, std::size_t gone) {
    alive_.erase(std::lower_bound(alive_.begin(), alive_.end(), gone));
    const double share = static_cast<double>(size_[gone]) / static_cast<double>(size_[kept] + size_[gone]);
    size_[kept] += size_[gone];
    for (const auto other : alive_) {
      if (other == kept) continue;
      for (Eigen::MatrixXd* matrix : {&distance_, &error_}) {
        const double own = (*matrix)(at(other), at(kept));
        const double joined = (*matrix)(at(other), at(gone));
        // Between the two also in its last bit, or chains could come back to where they were.
        const double mean = std::clamp(own + share * (joined - own), std::min(own, joined), std::max(own, joined));
        (*matrix)(at(other), at(kept)) = mean;
        (*matrix)(at(kept), at(other)) = mean;
      }
    }
  }

 private:
  Eigen::MatrixXd distance_;
  Eigen::MatrixXd error_;
  std::vector<std::size_t> size_;
  std::vector<std::size_t> alive_;  ///< rising
};

/// Pairs that are each other's nearest, which every order of merging joins; a cluster before those it becomes part of.
std::vector<Join> join_nearest(MeanDistances clusters, std::size_t count) {
  std::vector<Join> joins;
  std::vector<double> lowest(count, 0);  // height of the cluster: rounding must not put a later one below it
  std::vector<std::size_t> chain;
  while (joins.size() + 1 < count) {
    if (chain.empty()) chain.push_back(clusters.first());
    const std::size_t end = chain.back();
    const std::size_t before = chain.size() > 1 ? chain[chain.size() - 2] : kNone;
    const std::size_t next = clusters.nearest(end, before);
    if (next != before) {
      chain.push_back(next);
      continue;
    }
    chain.resize(chain.size() - 2);
    const auto [kept, gone] = std::minmax(end, before);
    Estimate height = clusters.between(end, before);
    height.value = std::max({height.value, lowest[kept], lowest[gone]});
    lowest[kept] = height.value;
    clusters.join(kept, gone);
    joins.push_back({kept, gone, height});
  }
  return joins;
}

void require_size(const Dendrogram& tree, const Eigen::MatrixXd& distance) {
  if (at(tree.leaves()) == distance.rows()) return;
  throw ArgumentError("tree of " + std::to_string(tree.leaves()) + " materials with distances of " +
                      std::to_string(distance.rows()) + "; expected as many");
}

}  // namespace

Dendrogram average_linkage(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error) {
  require_distances(distance, distance_error);
  const auto count = static_cast<std::size_t>(distance.rows());
  std::vector<Join> joins = join_nearest({distance, distance_error}, count);
  std::stable_sort(joins.begin(), joins.end(),
                   [](const Join& a, const Join& b) { return a.height.value < b.height.value; });
  Dendrogram tree;
  std::vector<std::size_t> number(count);  // of the cluster that a material now stands for
  std::iota(number.begin(), number.end(), std::size_t{0});
  std::vector<std::size_t> size(count, 1);
  for (const auto& [kept, gone, height] : joins) {
    size[kept] += size[gone];
    const auto [first, second] = std::minmax(number[kept], number[gone]);
    tree.merges.push_back({first, second, height, size[kept]});
    number[kept] = count + tree.merges.size() - 1;
  }
  return tree;
}

std::vector<std::size_t> cut(const Dendrogram& tree, std::size_t clusters) {
  const std::size_t count = tree.leaves();
  if (clusters < 1 || clusters > count) {
    throw ArgumentError("tree of " + std::to_string(count) + " materials cut into " + std::to_string(clusters) +
                        " clusters; expected a number in [1, " + std::to_string(count) + "]");
  }
  // From the top downwards, so that a cluster knows to which one it belongs before its parts ask.
  std::vector<std::size_t> owner(count + tree.merges.size());
  std::iota(owner.begin(), owner.end(), std::size_t{0});
  for (std::size_t i = count - clusters; i-- > 0;) {
    owner[tree.merges[i].first] = owner[count + i];
    owner[tree.merges[i].second] = owner[count + i];
  }
  std::vector<std::size_t> number(owner.size(), kNone);
  std::vector<std::size_t> cluster(count);
  std::size_t next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t& own = number[owner[i]];
    if (own == kNone) own = next++;
    cluster[i] = own;
  }
  return cluster;
}

Eigen::MatrixXd cophenetic_distance(const Dendrogram& tree) {
  const std::size_t count = tree.leaves();
  Eigen::MatrixXd height = Eigen::MatrixXd::Zero(at(count), at(count));
  std::vector<std::vector<std::size_t>> members(count + tree.merges.size());
  for (std::size_t i = 0; i < count; ++i) members[i] = {i};
  for (std::size_t i = 0; i < tree.merges.size(); ++i) {
    const Merge& merge = tree.merges[i];
    for (const auto a : members[merge.first]) {
      for (const auto b : members[merge.second]) {
        height(at(a), at(b)) = merge.height.value;
        height(at(b), at(a)) = merge.height.value;
      }
    }
    auto& joined = members[count + i];
    joined = std::move(members[merge.first]);
    joined.insert(joined.end(), members[merge.second].begin(), members[merge.second].end());
    members[merge.second].clear();
  }
  return height;
}

Estimate cophenetic_correlation(const Dendrogram& tree, const Eigen::MatrixXd& distance,
                                const Eigen::MatrixXd& distance_error) {
  require_distances(distance, distance_error);
  require_size(tree, distance);
  const Index n = distance.rows();
  const Eigen::MatrixXd heights = cophenetic_distance(tree);
  Dendrogram errors = tree;
  for (auto& merge : errors.merges) merge.height.value = merge.height.error;
  const Eigen::MatrixXd height_errors = cophenetic_distance(errors);
  const auto below_diagonal = [n](const Eigen::MatrixXd& matrix) {
    Eigen::VectorXd values(n * (n - 1) / 2);
    Index filled = 0;
    for (Index j = 0; j < n; ++j) {
      const Index length = n - 1 - j;
      values.segment(filled, length) = matrix.col(j).tail(length);
      filled += length;
    }
    return values;
  };
  constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
  const auto spread = [](const Eigen::VectorXd& x) { return x.size() == 0 ? 0.0 : x.maxCoeff() - x.minCoeff(); };
  Eigen::VectorXd x = below_diagonal(distance);
  Eigen::VectorXd y = below_diagonal(heights);
  if (!(spread(x) > 0 && spread(y) > 0)) return {kUndefined, kUndefined};
  x.array() -= x.mean();
  y.array() -= y.mean();
  // The cosine of an angle, which turns by no more than the errors are long beside the vectors.
  return {x.dot(y) / (x.norm() * y.norm()),
          below_diagonal(distance_error).norm() / x.norm() + below_diagonal(height_errors).norm() / y.norm()};
}

}  // namespace lobe
