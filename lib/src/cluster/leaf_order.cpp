#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "lobe/cluster/clustering.hpp"
#include "lobe/core/error.hpp"
#include "metric/distance_matrix.hpp"

// Bar-Joseph, Gifford and Jaakkola 2001. The leaves of a cluster can be ordered to begin with any leaf u of its one
// part and to end with any leaf w of the other; the shortest such order is the shortest from u to some m of the first
// part, the step from m to some k of the second, and the shortest from k to w (their eq. 2). Where u lies in one half
// of its part, m lies in the other half. Lengths are found from the leaves upwards, the ends of the best order then
// downwards. In one drawing of the tree every cluster is a range of places, so that all the minima run along columns.

namespace lobe {
namespace {

using Eigen::Index;

/// Places of a cluster's leaves in the drawing: those of its first part, then those of its second.
struct Range {
  Index begin = 0;
  Index middle = 0;
  Index end = 0;

  [[nodiscard]] bool is_leaf() const { return end - begin == 1; }
};

/// Places [begin, end).
struct Side {
  Index begin = 0;
  Index end = 0;

  [[nodiscard]] Index size() const { return end - begin; }
};

/// Where an order of a cluster may end that begins at a place.
Side opposite(const Range& range, Index place) {
  if (range.is_leaf()) return {range.begin, range.end};
  return place < range.middle ? Side{range.middle, range.end} : Side{range.begin, range.middle};
}

/// A drawing of the tree: the ranges of all clusters, and the leaves in it.
struct Drawing {
  std::vector<Range> range;
  std::vector<std::size_t> leaf;
};

Drawing draw(const Dendrogram& tree) {
  const std::size_t count = tree.leaves();
  const auto size = [&](std::size_t cluster) {
    return cluster < count ? Index{1} : static_cast<Index>(tree.merges[cluster - count].size);
  };
  Drawing drawing{std::vector<Range>(count + tree.merges.size()), std::vector<std::size_t>(count)};
  drawing.range.back() = {0, 1, static_cast<Index>(count)};
  for (std::size_t i = tree.merges.size(); i-- > 0;) {
    const Merge& merge = tree.merges[i];
    Range& whole = drawing.range[count + i];
    whole.middle = whole.begin + size(merge.first);
    drawing.range[merge.first] = {whole.begin, whole.middle, whole.middle};
    drawing.range[merge.second] = {whole.middle, whole.end, whole.end};
  }
  for (std::size_t i = 0; i < count; ++i) drawing.leaf[static_cast<std::size_t>(drawing.range[i].begin)] = i;
  return drawing;
}

/// Fills in the shortest orders of a cluster from those of its parts.
/// \param length per pair of places, the shortest order of the smallest cluster that holds both, with these ends
void find_lengths(const Range& whole, const Range& first, const Range& second, const Eigen::MatrixXd& distance,
                  Eigen::MatrixXd& length) {
  Eigen::VectorXd to(whole.end - whole.middle);  // shortest from u through the first part to places of the second
  for (Index u = whole.begin; u < whole.middle; ++u) {
    to.setConstant(std::numeric_limits<double>::infinity());
    const Side left = opposite(first, u);
    for (Index m = left.begin; m < left.end; ++m) {
      const double before = length(m, u);
      to = to.cwiseMin((distance.col(m).segment(whole.middle, to.size()).array() + before).matrix());
    }
    for (Index w = whole.middle; w < whole.end; ++w) {
      const Side right = opposite(second, w);
      length(w, u) =
          (to.segment(right.begin - whole.middle, right.size()) + length.col(w).segment(right.begin, right.size()))
              .minCoeff();
    }
  }
  const Index a = whole.middle - whole.begin;
  const Index b = whole.end - whole.middle;
  length.block(whole.begin, whole.middle, a, b) = length.block(whole.middle, whole.begin, b, a).transpose();
}

/// First and last place of an order.
using Ends = std::pair<Index, Index>;

/// The ends of the shortest order of a whole tree.
Ends best_ends(const Range& whole, const Eigen::MatrixXd& length) {
  Index u = 0;
  Index w = 0;
  length.block(whole.begin, whole.middle, whole.middle - whole.begin, whole.end - whole.middle).minCoeff(&u, &w);
  return {whole.begin + u, whole.middle + w};
}

/// Where the shortest order from u in the first part to w in the second passes from part to part.
Ends best_step(const Range& first, const Range& second, Index u, Index w, const Eigen::MatrixXd& distance,
               const Eigen::MatrixXd& length) {
  const Side left = opposite(first, u);
  const Side right = opposite(second, w);
  double shortest = std::numeric_limits<double>::infinity();
  Ends step{left.begin, right.begin};
  for (Index m = left.begin; m < left.end; ++m) {
    Index k = 0;
    const double value = length(m, u) + (distance.col(m).segment(right.begin, right.size()) +
                                         length.col(w).segment(right.begin, right.size()))
                                            .minCoeff(&k);
    if (value < shortest) {
      shortest = value;
      step = {m, right.begin + k};
    }
  }
  return step;
}

}  // namespace

std::vector<std::size_t> optimal_leaf_order(const Dendrogram& tree, const Eigen::MatrixXd& distance) {
  require_distances(distance);
  const std::size_t count = tree.leaves();
  if (static_cast<Index>(count) != distance.rows()) {
    throw ArgumentError("tree of " + std::to_string(count) + " materials with distances of " +
                        std::to_string(distance.rows()) + "; expected as many");
  }
  if (count == 1) return {0};
  const Drawing drawing = draw(tree);
  const auto& range = drawing.range;
  const auto n = static_cast<Index>(count);
  Eigen::MatrixXd drawn(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const auto [low, high] =
          std::minmax(drawing.leaf[static_cast<std::size_t>(i)], drawing.leaf[static_cast<std::size_t>(j)]);
      drawn(i, j) = distance(static_cast<Index>(high), static_cast<Index>(low));
    }
  }

  Eigen::MatrixXd length = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < tree.merges.size(); ++i) {
    find_lengths(range[count + i], range[tree.merges[i].first], range[tree.merges[i].second], drawn, length);
  }

  std::vector<Ends> ends(range.size());
  std::vector<Index> place(range.size(), 0);  // where the cluster begins in the best order
  ends.back() = best_ends(range.back(), length);
  for (std::size_t i = tree.merges.size(); i-- > 0;) {
    const Merge& merge = tree.merges[i];
    const std::size_t whole = count + i;
    auto [begin, end] = ends[whole];
    std::size_t left = merge.first;
    std::size_t right = merge.second;
    if (begin >= range[whole].middle) std::swap(left, right);
    const auto [last, next] = best_step(range[left], range[right], begin, end, drawn, length);
    ends[left] = {begin, last};
    ends[right] = {next, end};
    place[left] = place[whole];
    place[right] = place[whole] + range[left].end - range[left].begin;
  }
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[static_cast<std::size_t>(place[i])] = i;
  if (order.back() < order.front()) std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace lobe
