#include "hemisphere/cubature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/bisection.hpp"
#include "hemisphere/kronrod.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::RowVectorXd;

constexpr std::size_t kNodes = 7;       // of short_pair()
constexpr std::size_t kEnds = 4;        // points of a cell beside its nodes: at both ends of each axis
constexpr double kFromEnd = 1e-12;      // of these, in lengths of the cell: integrands may jump where cells meet
constexpr double kShorter = 0.75;       // of sides that touch longer ones
constexpr Eigen::Index kTellTales = 4;  // of an axis: difference of the rules, null rule, both ends

PanelPoint point_of(const PanelPart& part, double x) {
  const double length = part.to - part.from;
  PanelPoint point = panel_point(part.low, part.high, part.from + length * x);
  point.stretch *= length;
  return point;
}

double low_end(const PanelPart& part) {
  return part.from == 0 ? part.low.at : panel_point(part.low, part.high, part.from).at;
}

double high_end(const PanelPart& part) {
  return part.to == 1 ? part.high.at : panel_point(part.low, part.high, part.to).at;
}

/// Where in [0, 1] point_of() is at a place.
double share_at(const PanelPart& part, double at) {
  constexpr int kHalvings = 50;
  return bisect({0, 1}, kHalvings, [&](double x) { return point_of(part, x).at < at; }).low;
}

/// Nodes of an axis of a cell.
struct AxisNodes {
  explicit AxisNodes(const PanelPart& part) : low(low_end(part)), high(high_end(part)) {
    const std::vector<double>& nodes = short_pair().nodes;
    for (std::size_t k = 0; k < kNodes; ++k) {
      const PanelPoint point = point_of(part, nodes[k]);
      at[k] = point.at;
      stretch(static_cast<Index>(k)) = point.stretch;
    }
  }

  [[nodiscard]] double length() const { return high - low; }
  [[nodiscard]] double middle() const { return (low + high) / 2; }

  double low, high;  ///< ends of the axis
  std::array<double, kNodes> at{};
  Eigen::Matrix<double, kNodes, 1> stretch;
};

/// A rectangle and its integrals.
struct Cell {
  explicit Cell(Rectangle rectangle) : where(std::move(rectangle)), u(where.u), v(where.v) {}

  Rectangle where;
  AxisNodes u, v;
  RowVectorXd value;
  RowVectorXd error;
  Eigen::MatrixXd of_u, of_v;  ///< what tells of errors across an axis, with signs; kTellTales x integrands
  Eigen::MatrixXd at_nodes;    ///< the integrands, of nodes of u and, inside, of v
  bool across_u = true;        ///< whether to halve across u
  double weight = 0;           ///< error relative to the goal, of the integrand for which that is largest
  bool is_new = true;          ///< its sides have not been looked at
};

/// A part of a cell's side that another cell touches.
struct Touch {
  std::size_t cell;
  bool is_across_u;  ///< the side is an end of u
  bool is_high;
  double middle;  ///< middle of the part
  double length;
};

void add_points_of(const Cell& cell, std::vector<CubaturePoint>& points) {
  for (const double u : cell.u.at) {
    for (const double v : cell.v.at) points.push_back({u, v});
  }
  const double u = cell.u.at[kNodes / 2];
  const double v = cell.v.at[kNodes / 2];
  for (const double x : {kFromEnd, 1 - kFromEnd}) points.push_back({point_of(cell.where.u, x).at, v});
  for (const double y : {kFromEnd, 1 - kFromEnd}) points.push_back({u, point_of(cell.where.v, y).at});
}

constexpr auto kCellNodes = static_cast<Index>(kNodes * kNodes);
using CellWeights = Eigen::Matrix<double, 5, kCellNodes>;
using NodeWeights = Eigen::Matrix<double, 1, kCellNodes>;

/// Weights of a cell's nodes: of the integral, then of the difference of the rules and of the null rule across u, then
/// of those across v.
const CellWeights& cell_weights() {
  static const CellWeights weights = [] {
    const EmbeddedPair& rule = short_pair();
    const auto difference = [&](std::size_t k) { return rule.weights[k] - rule.coarse_weights[k]; };
    CellWeights all;
    for (std::size_t i = 0; i < kNodes; ++i) {
      for (std::size_t j = 0; j < kNodes; ++j) {
        all.col(static_cast<Index>(i * kNodes + j)) << rule.weights[i] * rule.weights[j],
            difference(i) * rule.weights[j], rule.null_weights[i] * rule.weights[j], rule.weights[i] * difference(j),
            rule.weights[i] * rule.null_weights[j];
      }
    }
    return all;
  }();
  return weights;
}

/// Norms of columns. Squares of numbers below 1e-154 vanish.
RowVectorXd norms(const Eigen::MatrixXd& columns) {
  const RowVectorXd largest = columns.cwiseAbs().colwise().maxCoeff();
  const RowVectorXd scale = (largest.array() > 0).select(largest, 1);
  return scale.cwiseProduct((columns.array().rowwise() / scale.array()).matrix().colwise().norm());
}

/// Values of a cell's points summed to its integrals. A kink or jump between the end of an axis and its first node is
/// seen by no rule: the value at the end is not that to which the polynomial through the nodes leads.
void sum_nodes(Cell& cell, const Eigen::Ref<const Eigen::MatrixXd>& values, Index steering) {
  const EmbeddedPair& rule = short_pair();
  const Index columns = values.cols();
  const auto row_of = [](std::size_t i, std::size_t j) { return static_cast<Index>(i * kNodes + j); };
  cell.at_nodes = values.topRows(kCellNodes);
  const Eigen::Matrix<double, kNodes, kNodes> stretches = cell.v.stretch * cell.u.stretch.transpose();
  const Eigen::Matrix<double, 5, Eigen::Dynamic> sums =
      (cell_weights() * stretches.reshaped().asDiagonal()).eval().lazyProduct(cell.at_nodes);
  cell.value = sums.row(0);
  cell.of_u.resize(kTellTales, columns);
  cell.of_v.resize(kTellTales, columns);
  cell.of_u.topRows(2) = sums.middleRows(1, 2);
  cell.of_v.topRows(2) = sums.middleRows(3, 2);
  const Eigen::Map<const Eigen::Matrix<double, kNodes, 1>> weights(rule.weights.data());
  const double length_u = weights.dot(cell.u.stretch);
  const double length_v = weights.dot(cell.v.stretch);
  const std::size_t middle = kNodes / 2;
  for (std::size_t end = 0; end < 2; ++end) {
    const auto row = static_cast<Index>(end);
    const double at = end == 0 ? 0 : 1;
    const double of_u = rule.nodes.front() * point_of(cell.where.u, at).stretch * length_v;
    const double of_v = rule.nodes.front() * point_of(cell.where.v, at).stretch * length_u;
    for (Index column = 0; column < columns; ++column) {
      double beyond_u = values(kCellNodes + row, column);
      double beyond_v = values(kCellNodes + 2 + row, column);
      for (std::size_t k = 0; k < kNodes; ++k) {
        const double weight = rule.end_weights[end == 0 ? k : kNodes - 1 - k];
        beyond_u -= weight * values(row_of(k, middle), column);
        beyond_v -= weight * values(row_of(middle, k), column);
      }
      cell.of_u(2 + row, column) = of_u * beyond_u;
      cell.of_v(2 + row, column) = of_v * beyond_v;
    }
  }
  const RowVectorXd u = norms(cell.of_u);
  const RowVectorXd v = norms(cell.of_v);
  cell.error = u + v;
  cell.across_u = u.head(steering).sum() >= v.head(steering).sum();
}

/// Weights of the polynomial through all nodes at x in [0, 1].
std::array<double, kNodes> polynomial_weights(double x) {
  const std::vector<double>& nodes = short_pair().nodes;
  std::array<double, kNodes> weights{};
  for (std::size_t k = 0; k < kNodes; ++k) {
    weights[k] = 1;
    for (std::size_t j = 0; j < kNodes; ++j) {
      if (j != k) weights[k] *= (x - nodes[j]) / (nodes[k] - nodes[j]);
    }
  }
  return weights;
}

/// What a cell's nodes lead to at an end of one axis and at x of the other.
RowVectorXd expected_at_side(const Cell& cell, bool is_across_u, bool is_high, double x) {
  const std::vector<double>& end_weights = short_pair().end_weights;
  const std::array<double, kNodes> weights = polynomial_weights(x);
  NodeWeights all;
  for (std::size_t k = 0; k < kNodes; ++k) {
    const double end_weight = end_weights[is_high ? kNodes - 1 - k : k];
    for (std::size_t j = 0; j < kNodes; ++j) {
      const std::size_t row = is_across_u ? k * kNodes + j : j * kNodes + k;
      all(static_cast<Index>(row)) = end_weight * weights[j];
    }
  }
  return all.lazyProduct(cell.at_nodes);
}

bool is_same(const PanelPart& a, const PanelPart& b) {
  return a.low.at == b.low.at && a.high.at == b.high.at && a.from == b.from && a.to == b.to;
}

bool is_before(const PanelPart& a, const PanelPart& b) {
  return std::tie(a.low.at, a.high.at, a.from, a.to) < std::tie(b.low.at, b.high.at, b.from, b.to);
}

/// Squares of errors that are independent of each other, by integrand.
struct SquareSums {
  RowVectorXd squares;
  RowVectorXd fourth;      ///< sum of their squares: how few of them matter
  RowVectorXd unresolved;  ///< part of the squares that is of cells whose errors may have one sign

  void add(const RowVectorXd& one) {
    squares += one;
    fourth += one.cwiseAbs2();
  }
};

/// Adds what squares of errors miss for a kink along the other axis: its errors in all cells of the same part of this
/// one have one sign, and add up.
/// \param scale by integrand, that squares do not vanish
void add_common_part(const std::vector<Cell>& cells, PanelPart Rectangle::*axis, Eigen::MatrixXd Cell::*tell_tales,
                     const RowVectorXd& scale, SquareSums& sums) {
  std::vector<const Cell*> sorted;
  for (const Cell& cell : cells) sorted.push_back(&cell);
  const auto part = [axis](const Cell* cell) -> const PanelPart& { return cell->where.*axis; };
  std::ranges::sort(sorted, is_before, part);
  for (std::size_t first = 0; first < sorted.size();) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(kTellTales, scale.size());
    RowVectorXd apart = RowVectorXd::Zero(scale.size());
    const PanelPart& common = part(sorted[first]);
    for (; first < sorted.size() && is_same(part(sorted[first]), common); ++first) {
      const Eigen::MatrixXd own = (sorted[first]->*tell_tales).array().rowwise() / scale.array();
      sum += own;
      apart += own.colwise().squaredNorm();
    }
    sums.add((sum.colwise().squaredNorm() - apart).cwiseMax(0));
  }
}

/// The error of a sum. A single part may be off by what it tells of and more; of many that are about equal, a third is
/// off in the mean, with either sign.
RowVectorXd error_of(const SquareSums& sums) {
  constexpr double kOfOne = 2;
  constexpr double kOfMany = 1;
  // How many equal parts would have these sums.
  const Eigen::Array<double, 1, Eigen::Dynamic> count =
      (sums.fourth.array() > 0).select(sums.squares.array().square() / sums.fourth.array(), 1);
  const auto of_many = kOfMany + (kOfOne - kOfMany) / count.sqrt();
  const auto resolved = (sums.squares - sums.unresolved).array();
  return (of_many.square() * resolved + kOfOne * kOfOne * sums.unresolved.array()).sqrt();
}

class Cubature {
 public:
  Cubature(const Integrands& integrands, const CubatureGoal& goal) : integrands_(integrands), goal_(goal) {}

  CubatureSums over(std::vector<Rectangle> rectangles) {
    for (const Rectangle& rectangle : rectangles) cells_.emplace_back(rectangle);
    evaluate(0, {});
    constexpr std::size_t kLookGrowth = 2;  // of the points, before what they have missed is looked for again
    std::size_t next_look = kLookGrowth * points_;
    for (;;) {
      if (points_ < std::min(goal_.most_points, next_look) && halve_worst(summed(false))) continue;
      next_look = kLookGrowth * points_;
      if (look_beside()) continue;
      if (points_ < goal_.most_points && halve_worst(summed(false))) continue;
      CubatureSums sums = summed(true);
      if (points_ >= goal_.most_points || !halve_worst(sums)) return sums;
    }
  }

 private:
  /// Integrals of the cells from `first` on. Two halves have a part of the error of the whole at least, because rules
  /// may agree by accident.
  /// \param earlier errors of the wholes, none at first
  void evaluate(std::size_t first, const std::vector<RowVectorXd>& earlier) {
    constexpr double kEarlier = 0.02;
    constexpr std::size_t kPoints = kNodes * kNodes + kEnds;
    std::vector<CubaturePoint> points;
    points.reserve(kPoints * (cells_.size() - first));
    for (std::size_t c = first; c < cells_.size(); ++c) add_points_of(cells_[c], points);
    points_ += points.size();
    const Eigen::MatrixXd values = integrands_(points);
    constexpr auto size = static_cast<Index>(kPoints);
    for (std::size_t c = first; c < cells_.size(); ++c) {
      sum_nodes(cells_[c], values.middleRows(static_cast<Index>(c - first) * size, size), goal_.steering);
      if (!earlier.empty()) cells_[c].error = cells_[c].error.cwiseMax(kEarlier * earlier[(c - first) / 2]);
    }
  }

  /// Where shorter sides touch longer ones, and one of both cells is new.
  [[nodiscard]] std::vector<Touch> touches() const {
    std::vector<Touch> found;
    for (const bool is_across_u : {true, false}) {
      const auto normal = is_across_u ? &Cell::u : &Cell::v;
      const auto along = is_across_u ? &Cell::v : &Cell::u;
      std::map<double, std::array<std::vector<std::size_t>, 2>> sides;  // cells that begin and end there
      for (std::size_t c = 0; c < cells_.size(); ++c) {
        sides[(cells_[c].*normal).low][0].push_back(c);
        sides[(cells_[c].*normal).high][1].push_back(c);
      }
      for (const auto& [at, beside] : sides) {
        for (const bool is_high : {false, true}) {
          auto shorter = beside.at(is_high ? 0 : 1);
          const auto middle_of = [&](std::size_t c) { return (cells_[c].*along).middle(); };
          std::ranges::sort(shorter, {}, middle_of);
          for (const std::size_t c : beside.at(is_high ? 1 : 0)) {
            const AxisNodes& own = cells_[c].*along;
            auto next = std::ranges::lower_bound(shorter, own.low, {}, middle_of);
            for (; next != shorter.end() && middle_of(*next) < own.high; ++next) {
              if (!(cells_[c].is_new || cells_[*next].is_new)) continue;
              const double length = (cells_[*next].*along).length();
              if (length <= kShorter * own.length())
                found.push_back({c, is_across_u, is_high, middle_of(*next), length});
            }
          }
        }
      }
    }
    return found;
  }

  /// A curve of kinks or jumps may leave small cells for a large one between two of its nodes and before the first.
  /// There the integrand is looked at between the end and the first node: second differences count as error. A ridge
  /// may do the same and run on between nodes: where the value on the side is not that to which the polynomial through
  /// the nodes leads, and the cell's own error has no room for it, a ridge as wide as the small cell, across the whole
  /// of the large one, counts as error. To find it the large one is cut lengthwise.
  /// \return whether there was any place to look at
  bool look_beside() {
    const auto places = touches();
    for (Cell& cell : cells_) cell.is_new = false;
    if (places.empty()) return false;
    const double width = short_pair().nodes.front();
    std::vector<CubaturePoint> points;
    for (const Touch& place : places) {
      const Rectangle& where = cells_[place.cell].where;
      for (const double depth : {kFromEnd, width / 2, width}) {
        const double x = place.is_high ? 1 - depth : depth;
        points.push_back(place.is_across_u ? CubaturePoint{point_of(where.u, x).at, place.middle}
                                           : CubaturePoint{place.middle, point_of(where.v, x).at});
      }
    }
    points_ += points.size();
    const Eigen::MatrixXd values = integrands_(points);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Touch& place = places[k];
      Cell& cell = cells_[place.cell];
      const PanelPart& part = place.is_across_u ? cell.where.u : cell.where.v;
      const double end = place.is_high ? 1 : 0;
      const double depth = std::abs(point_of(part, end + (place.is_high ? -width : width)).at - point_of(part, end).at);
      const auto row = static_cast<Index>(3 * k);
      const RowVectorXd error =
          depth * place.length * (values.row(row) - 2 * values.row(row + 1) + values.row(row + 2)).cwiseAbs();
      const PanelPart& along = place.is_across_u ? cell.where.v : cell.where.u;
      const RowVectorXd expected =
          expected_at_side(cell, place.is_across_u, place.is_high, share_at(along, place.middle));
      const RowVectorXd of_ridge =
          (place.is_across_u ? cell.u : cell.v).length() * place.length * (values.row(row) - expected).cwiseAbs();
      const RowVectorXd unseen = (of_ridge - cell.error).cwiseMax(0);
      const auto sum_of = [&](const RowVectorXd& errors) { return errors.head(goal_.steering).sum(); };
      if (((error + unseen).head(goal_.steering).array() > cell.error.head(goal_.steering).array()).any()) {
        cell.across_u = place.is_across_u != (sum_of(unseen) > sum_of(error));
      }
      cell.error += error + unseen;
    }
    return true;
  }

  /// \param with_common with what the errors of cells beside each other have in common, which is some work
  [[nodiscard]] CubatureSums summed(bool with_common) const {
    constexpr double kUnresolved = 0.05;
    constexpr double kOfSum = 1.5;  // of one jump the error is 1.34 times that of its cells at most
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
    SquareSums apart{zero, zero, zero};
    for (const Cell& cell : cells_) {
      const RowVectorXd square = cell.error.cwiseQuotient(scale).cwiseAbs2();
      apart.add(square);
      // Rules that miss much of a ridge do so in all cells along it.
      const auto is_unresolved = cell.error.array() > kUnresolved * cell.value.array().abs();
      apart.unresolved += is_unresolved.select(square, zero);
    }
    if (with_common) {
      add_common_part(cells_, &Rectangle::u, &Cell::of_u, scale, apart);
      add_common_part(cells_, &Rectangle::v, &Cell::of_v, scale, apart);
    }
    sums.error = (kOfSum * sums.error).cwiseMin(error_of(apart).cwiseProduct(scale));
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
        halves.emplace_back(half);
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
