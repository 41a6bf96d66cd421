#include "fit/nearest_point.hpp"
#include "core/numbers.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class ActiveSet {
 public:
  /// In a hull the last point is the origin, which takes what the other weights leave of 1.
  ActiveSet(const MatrixXd& gram, const VectorXd& products, bool is_hull)
      : gram_(gram), products_(products), is_hull_(is_hull), weights_(VectorXd::Zero(gram.rows())) {
    // Points of a hull are moved apart from the origin along an axis of their own. Where weights sum to 1 this adds a
    // constant to the objective, and affine independence becomes linear independence.
    lift_ = is_hull ? std::max(gram.diagonal().maxCoeff(), 1e-300) : 0;
    norms_ = gram.diagonal().cwiseMax(0).cwiseSqrt();
    if (!is_hull) return;
    support_ = {gram.rows() - 1};
    weights_(support_.front()) = 1;
  }

  VectorXd solve() {
    // Every step lowers the distance, so that no support comes twice; the limit is for rounding.
    for (Index step = 0; step < 20 * (gram_.rows() + 10); ++step) {
      const Index entering = steepest();
      if (entering < 0) break;
      if (!enter(entering)) refused_.push_back(entering);
    }
    return weights_;
  }

 private:
  /// The point towards which the distance falls fastest; -1 where it falls towards none.
  [[nodiscard]] Index steepest() const {
    const VectorXd slope = products_ - gram_ * weights_;
    const double here = is_hull_ ? weights_.dot(slope) : 0;
    const double size = 1 + weights_.dot(norms_);
    Index best = -1;
    double largest = 64 * kEpsilon * size;
    for (Index j = 0; j < slope.size(); ++j) {
      if (contains(support_, j) || contains(refused_, j)) continue;
      const double scale = is_hull_ ? std::max(norms_(j), size - 1) : norms_(j);
      const double steepness = scale > 0 ? (slope(j) - here) / scale : 0;
      if (steepness > largest) {
        largest = steepness;
        best = j;
      }
    }
    return best;
  }

  bool enter(Index entering) {
    support_.push_back(entering);
    VectorXd goal;
    if (!minimise(goal) || !(goal(goal.size() - 1) > 0)) {
      support_.pop_back();
      return false;
    }
    for (;;) {
      // As far towards the minimum over the support's plane as all weights stay non-negative.
      double step = 1;
      for (std::size_t i = 0; i < support_.size(); ++i) {
        const double weight = weights_(support_[i]);
        const double wanted = goal(static_cast<Index>(i));
        if (wanted <= 0) step = std::min(step, weight / (weight - wanted));
      }
      std::vector<Index> kept;
      for (std::size_t i = 0; i < support_.size(); ++i) {
        double& weight = weights_(support_[i]);
        const double wanted = goal(static_cast<Index>(i));
        const bool is_stopped = wanted <= 0 && weight <= step * (weight - wanted) * (1 + 4 * kEpsilon);
        weight = is_stopped ? 0 : weight + step * (wanted - weight);
        if (!is_stopped) kept.push_back(support_[i]);
      }
      const bool is_there = kept.size() == support_.size();
      support_ = std::move(kept);
      if (is_there || support_.empty() || !minimise(goal)) break;
    }
    refused_.clear();
    return true;
  }

  /// The weights of the support's points without regard to signs; false where these depend on each other.
  bool minimise(VectorXd& goal) const {
    const auto n = static_cast<Index>(support_.size());
    MatrixXd gram(n, n);
    VectorXd products(n);
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j) gram(i, j) = gram_(at(i), at(j)) + lift_;
      products(i) = products_(at(i));
    }
    const Eigen::LLT<MatrixXd> cholesky(gram);
    if (cholesky.info() != Eigen::Success) return false;
    const VectorXd pivots = cholesky.matrixLLT().diagonal().array().square();
    const double least = 64 * kEpsilon * static_cast<double>(n);
    if (((pivots.array() / gram.diagonal().array()) <= least).any()) return false;
    const auto solved = [&](const VectorXd& right) {
      VectorXd solution = cholesky.solve(right);
      solution += cholesky.solve(right - gram * solution);
      return solution;
    };
    goal = solved(products);
    if (is_hull_) {
      const VectorXd even = solved(VectorXd::Ones(n));
      goal += (1 - goal.sum()) / even.sum() * even;
    }
    return true;
  }

  [[nodiscard]] Index at(Index i) const { return support_[static_cast<std::size_t>(i)]; }

  static bool contains(const std::vector<Index>& list, Index j) {
    return std::find(list.begin(), list.end(), j) != list.end();
  }

  const MatrixXd& gram_;
  const VectorXd& products_;
  bool is_hull_;
  double lift_ = 0;
  VectorXd norms_;
  VectorXd weights_;
  std::vector<Index> support_;
  std::vector<Index> refused_;  ///< since the last step that was made
};

}  // namespace

VectorXd nearest_in_cone(const MatrixXd& gram, const VectorXd& products) {
  return ActiveSet(gram, products, false).solve();
}

VectorXd nearest_in_hull(const MatrixXd& gram, const VectorXd& products) {
  const Index n = gram.rows();
  MatrixXd with_origin = MatrixXd::Zero(n + 1, n + 1);
  with_origin.topLeftCorner(n, n) = gram;
  VectorXd products_with_origin = VectorXd::Zero(n + 1);
  products_with_origin.head(n) = products;
  return ActiveSet(with_origin, products_with_origin, true).solve().head(n);
}

}  // namespace lobe
