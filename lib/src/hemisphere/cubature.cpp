#include "hemisphere/cubature.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "hemisphere/kronrod.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::RowVectorXd;

/// A rectangle and its integrals.
struct Cell {
  Rectangle where;
  RowVectorXd value;
  RowVectorXd error;
  bool across_u = true;  ///< what to halve
  double weight = 0;     ///< error relative to the goal, of the integrand for which that is largest
};

PanelPoint point_of(const PanelPart& part, double x) {
  const double length = part.to - part.from;
  PanelPoint point = panel_point(part.low, part.high, part.from + length * x);
  point.stretch *= length;
  return point;
}

/// Values of a cell's nodes summed to its integrals.
void sum_nodes(Cell& cell, const Eigen::Ref<const Eigen::MatrixXd>& values, Index steering) {
  const EmbeddedPair& rule = short_pair();
  const std::size_t n = rule.nodes.size();
  const Index columns = values.cols();
  cell.value = RowVectorXd::Zero(columns);
  RowVectorXd without_u = cell.value;
  RowVectorXd without_v = cell.value;
  RowVectorXd null_u = cell.value;
  RowVectorXd null_v = cell.value;
  Index row = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double stretch_u = point_of(cell.where.u, rule.nodes[i]).stretch;
    for (std::size_t j = 0; j < n; ++j, ++row) {
      const double stretch = stretch_u * point_of(cell.where.v, rule.nodes[j]).stretch;
      cell.value += stretch * rule.weights[i] * rule.weights[j] * values.row(row);
      without_u += stretch * rule.coarse_weights[i] * rule.weights[j] * values.row(row);
      without_v += stretch * rule.weights[i] * rule.coarse_weights[j] * values.row(row);
      null_u += stretch * rule.null_weights[i] * rule.weights[j] * values.row(row);
      null_v += stretch * rule.weights[i] * rule.null_weights[j] * values.row(row);
    }
  }
  const RowVectorXd u = ((cell.value - without_u).cwiseAbs2() + null_u.cwiseAbs2()).cwiseSqrt();
  const RowVectorXd v = ((cell.value - without_v).cwiseAbs2() + null_v.cwiseAbs2()).cwiseSqrt();
  cell.error = u + v;
  cell.across_u = u.head(steering).sum() >= v.head(steering).sum();
}

class Cubature {
 public:
  Cubature(const Integrands& integrands, const CubatureGoal& goal) : integrands_(integrands), goal_(goal) {}

  CubatureSums over(std::vector<Rectangle> rectangles) {
    for (const Rectangle& rectangle : rectangles) cells_.push_back({rectangle, {}, {}, true, 0});
    evaluate(0, {});
    for (;;) {
      CubatureSums sums = summed();
      if (points_ >= goal_.most_points || !halve_worst(sums)) return sums;
    }
  }

 private:
  /// Integrals of the cells from `first` on. Two halves have a part of the error of the whole at least, because rules
  /// may agree by accident.
  /// \param earlier errors of the wholes, none at first
  void evaluate(std::size_t first, const std::vector<RowVectorXd>& earlier) {
    constexpr double kEarlier = 0.02;
    const EmbeddedPair& rule = short_pair();
    const std::size_t n = rule.nodes.size();
    std::vector<CubaturePoint> points;
    points.reserve((cells_.size() - first) * n * n);
    for (std::size_t c = first; c < cells_.size(); ++c) {
      for (std::size_t i = 0; i < n; ++i) {
        const double u = point_of(cells_[c].where.u, rule.nodes[i]).at;
        for (std::size_t j = 0; j < n; ++j) points.push_back({u, point_of(cells_[c].where.v, rule.nodes[j]).at});
      }
    }
    points_ += points.size();
    const Eigen::MatrixXd values = integrands_(points);
    const auto size = static_cast<Index>(n * n);
    for (std::size_t c = first; c < cells_.size(); ++c) {
      sum_nodes(cells_[c], values.middleRows(static_cast<Index>(c - first) * size, size), goal_.steering);
      if (!earlier.empty()) cells_[c].error = cells_[c].error.cwiseMax(kEarlier * earlier[(c - first) / 2]);
    }
  }

  [[nodiscard]] CubatureSums summed() const {
    constexpr double kDeviations = 2;
    const RowVectorXd zero = RowVectorXd::Zero(cells_.front().value.size());
    CubatureSums sums{zero, zero, points_};
    RowVectorXd largest = zero;
    for (const Cell& cell : cells_) {
      sums.value += cell.value;
      sums.error += cell.error;
      largest = largest.cwiseMax(cell.error);
    }
    // Squares of the errors themselves may vanish.
    const RowVectorXd scale = (largest.array() > 0).select(largest, 1);
    RowVectorXd squares = zero;
    for (const Cell& cell : cells_) squares += cell.error.cwiseQuotient(scale).cwiseAbs2();
    sums.error = sums.error.cwiseMin(kDeviations * scale.cwiseProduct(squares.cwiseSqrt()));
    return sums;
  }

  /// \return whether there was any need
  bool halve_worst(const CubatureSums& sums) {
    constexpr double kShare = 0.5;  // of what is too much, that is dealt with at a time
    constexpr double kBeside = 0.01;
    RowVectorXd allowed = goal_.relative * sums.value.head(goal_.steering).cwiseAbs();
    if (goal_.has_errors) {
      const auto own = sums.value.segment(goal_.steering, goal_.steering).array();
      allowed = (own > 0).select(allowed.array().max(kBeside * own), allowed.array());
    }
    if ((sums.error.head(goal_.steering).array() <= allowed.array()).all()) return false;
    double total = 0;
    for (Cell& cell : cells_) {
      const auto error = cell.error.head(goal_.steering).array();
      cell.weight = (error > 0).select(error / allowed.array().max(1e-300), 0.0).maxCoeff();
      total += cell.weight;
    }
    std::ranges::sort(cells_, std::greater<>(), &Cell::weight);
    std::vector<Cell> halves;
    std::vector<RowVectorXd> errors;
    double dealt_with = 0;
    std::size_t count = 0;
    while (count < cells_.size() && dealt_with < kShare * total) {
      const Cell& cell = cells_[count++];
      dealt_with += cell.weight;
      errors.push_back(cell.error);
      for (const bool is_upper : {false, true}) {
        Rectangle half = cell.where;
        PanelPart& part = cell.across_u ? half.u : half.v;
        (is_upper ? part.from : part.to) = (part.from + part.to) / 2;
        halves.push_back({half, {}, {}, true, 0});
      }
    }
    cells_.erase(cells_.begin(), cells_.begin() + static_cast<std::ptrdiff_t>(count));
    const std::size_t first = cells_.size();
    cells_.insert(cells_.end(), halves.begin(), halves.end());
    evaluate(first, errors);
    return true;
  }

  const Integrands& integrands_;
  const CubatureGoal& goal_;
  std::vector<Cell> cells_;
  std::size_t points_ = 0;
};

}  // namespace

CubatureSums integrate_rectangles(std::vector<Rectangle> rectangles, const Integrands& integrands,
                                  const CubatureGoal& goal) {
  return Cubature(integrands, goal).over(std::move(rectangles));
}

}  // namespace lobe
