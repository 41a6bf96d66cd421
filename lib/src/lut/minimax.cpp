#include "lut/minimax.hpp"

#include <coin/Clp_C_Interface.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kProgramTolerance = 1e-10;  // of linear programs, whose numbers are near 1
constexpr double kNothing = 1e-14;           // relative difference that is rounding
constexpr double kOptimal = 1e-8;            // of reduced costs, relative to the largest cost above 1
constexpr double kBalance = 1e-13;           // of weights that add up to 1, which is rounding
constexpr double kStep = 1e-9;               // relative progress at which the best quotient is found
constexpr int kMostSteps = 100;
constexpr int kBasic = 1;  // status of Clp

/// Minimum of cost * x where rows * x = sums and x >= 0.
struct Program {
  MatrixXd rows;
  VectorXd sums;
  VectorXd cost;
};

struct Solution {
  VectorXd x;
  VectorXd multipliers;  ///< of the rows
};

/// Solves the equations of a basis anew: what a linear program leaves of its tolerance becomes rounding.
void sharpen(const Program& program, const std::vector<int>& basis, Solution& solution) {
  const auto count = static_cast<Index>(basis.size());
  MatrixXd columns(count, count);
  VectorXd cost(count);
  for (Index k = 0; k < count; ++k) {
    columns.col(k) = program.rows.col(basis[static_cast<std::size_t>(k)]);
    cost[k] = program.cost[basis[static_cast<std::size_t>(k)]];
  }
  const Eigen::FullPivLU<MatrixXd> factors(columns);
  if (!factors.isInvertible()) return;
  VectorXd x = factors.solve(program.sums);
  x += factors.solve(program.sums - columns * x);
  if (!(x.minCoeff() > -10 * kProgramTolerance)) return;
  solution.x.setZero();
  for (Index k = 0; k < count; ++k) solution.x[basis[static_cast<std::size_t>(k)]] = std::max(x[k], 0.0);
  solution.multipliers = factors.transpose().solve(cost);
}

/// Whether no x has a smaller cost.
bool is_optimal(const Program& program, const Solution& solution) {
  const double unit = std::max(1.0, program.cost.cwiseAbs().maxCoeff());
  return (program.cost - program.rows.transpose() * solution.multipliers).minCoeff() > -kOptimal * unit;
}

/// None where the program has no solution.
std::optional<Solution> solution_of(const Program& program) {
  const auto rows = static_cast<int>(program.rows.rows());
  const auto columns = static_cast<int>(program.rows.cols());
  std::vector<CoinBigIndex> starts(static_cast<std::size_t>(columns) + 1);
  std::vector<int> indices(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (std::size_t c = 0; c < starts.size(); ++c) starts[c] = static_cast<CoinBigIndex>(c) * rows;
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<int>(i % static_cast<std::size_t>(rows));
  for (const bool is_dual : {false, true}) {
    const std::unique_ptr<Clp_Simplex, decltype(&Clp_deleteModel)> model(Clp_newModel(), &Clp_deleteModel);
    Clp_setLogLevel(model.get(), 0);
    Clp_scaling(model.get(), 0);  // near zeros of polynomials it spoils the program
    Clp_setPrimalTolerance(model.get(), kProgramTolerance);
    Clp_setDualTolerance(model.get(), kProgramTolerance);
    Clp_loadProblem(model.get(), columns, rows, starts.data(), indices.data(), program.rows.data(), nullptr, nullptr,
                    program.cost.data(), program.sums.data(), program.sums.data());
    (void)(is_dual ? Clp_dual(model.get(), 0) : Clp_primal(model.get(), 0));
    if (Clp_status(model.get()) != 0) continue;
    Solution solution{Eigen::Map<const VectorXd>(Clp_primalColumnSolution(model.get()), columns),
                      Eigen::Map<const VectorXd>(Clp_dualRowSolution(model.get()), rows)};
    std::vector<int> basis;
    for (int c = 0; c < columns; ++c) {
      if (Clp_getColumnStatus(model.get(), c) == kBasic) basis.push_back(c);
    }
    if (static_cast<int>(basis.size()) == rows) sharpen(program, basis, solution);
    if (is_optimal(program, solution)) return solution;
  }
  return std::nullopt;
}

/// Weights of the points where a difference is the largest, with its signs.
VectorXd signed_weights(const VectorXd& x, Index points) {
  return x.head(points) - x.segment(points, points);
}

/// The least change of the weights, each in proportion to itself, after which they see nothing of the functions.
VectorXd balanced(VectorXd weights, const MatrixXd& functions) {
  const MatrixXd moments = functions.transpose() * weights.cwiseAbs().asDiagonal() * functions;
  const VectorXd seen = functions.transpose() * weights;
  const VectorXd change = moments.completeOrthogonalDecomposition().solve(seen);
  return weights - weights.cwiseAbs().cwiseProduct(functions * change);
}

/// The largest error of values at points that count.
double error_at(const VectorXd& weights, const VectorXd& errors) {
  return (weights.array() != 0).select(errors, 0).maxCoeff();
}

/// With weights v that see nothing of any p, the sum of v * (y - p) is that of v * y: some |y - p| is as large as that
/// sum, for weights whose absolute values add up to 1.
double linear_bound(const VectorXd& weights, const MatrixXd& functions, const VectorXd& values,
                    const VectorXd& errors) {
  const VectorXd v = balanced(weights, functions);
  return std::max(0.0, std::abs(v.dot(values)) / v.cwiseAbs().sum() - error_at(v, errors));
}

/// Whether no quotient that is positive at the points is off by less than L everywhere: for such a one, the sum of
/// v * (y q - p) - L |v| q would be negative. With weights v that see nothing of any p it is that of (v y - L |v|) * q,
/// which is positive if it equals that of m * q for all q, with all m >= 0.
bool is_out_of_reach(double limit, const MatrixXd& numerator, const MatrixXd& denominator, const VectorXd& values) {
  const Index points = values.size();
  const Index count = numerator.cols();
  const Index below = denominator.cols();
  Program program;
  program.rows.setZero(count + below + 1, 3 * points);
  program.cost = VectorXd::Zero(3 * points);
  for (const bool is_above : {true, false}) {
    const Index first = is_above ? 0 : points;
    const double sign = is_above ? 1 : -1;
    program.rows.block(0, first, count, points) = sign * numerator.transpose();
    program.rows.block(count, first, below, points) =
        (denominator.array().colwise() * (sign * values.array() - limit)).matrix().transpose();
  }
  program.rows.block(count, 2 * points, below, points) = -denominator.transpose();
  program.rows.row(count + below).head(2 * points).setOnes();
  program.sums = VectorXd::Unit(count + below + 1, count + below);
  const auto solution = solution_of(program);
  return solution && (program.rows * solution->x - program.sums).cwiseAbs().maxCoeff() < kBalance;
}

double quotient_bound(const MatrixXd& numerator, const MatrixXd& denominator, const VectorXd& values, double largest) {
  for (const double gap : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    if (is_out_of_reach(largest * (1 - gap), numerator, denominator, values)) return largest * (1 - gap);
  }
  return 0;
}

/// The best p: weights of points and signs that see nothing of any function, and most of the values.
std::pair<VectorXd, VectorXd> best_polynomial(const MatrixXd& functions, const VectorXd& values) {
  const Index points = values.size();
  const Index count = functions.cols();
  Program program;
  program.rows.resize(count + 1, 2 * points);
  program.rows.topLeftCorner(count, points) = functions.transpose();
  program.rows.topRightCorner(count, points) = -functions.transpose();
  program.rows.row(count).setOnes();
  program.sums = VectorXd::Unit(count + 1, count);
  program.cost.resize(2 * points);
  program.cost << -values, values;
  const auto solution = solution_of(program);
  if (!solution) {
    throw NumericError("the linear program of a fit could not be solved; expected another degree or other entries");
  }
  return {-solution->multipliers.head(count), signed_weights(solution->x, points)};
}

/// A quotient on its way to the best one.
class Quotient {
 public:
  Quotient(const MatrixXd& numerator, const MatrixXd& denominator, const VectorXd& values, Minimax start)
      : numerator_(numerator), denominator_(denominator), values_(values), best_(std::move(start)) {}

  [[nodiscard]] Minimax improved() {
    for (int step = 0; step < kMostSteps; ++step) {
      if (best_.largest <= kNothing * values_.cwiseAbs().maxCoeff() || !improve()) break;
    }
    return best_;
  }

 private:
  /// One step of the differential correction: the q and p, each as a change in units of the largest difference t, that
  /// lower |y q - p| - t q most, in units of t times the q so far. Solved as its dual program, which has few rows.
  bool improve() {
    const Index points = values_.size();
    const Index count = numerator_.cols();
    const Index below = denominator_.cols();
    const double t = best_.largest;
    const VectorXd p = numerator_ * best_.numerator;
    const VectorXd q = denominator_ * best_.denominator;
    const VectorXd difference = (values_ - p.cwiseQuotient(q)) / t;
    const MatrixXd above_q = (numerator_.array().colwise() / q.array()).matrix();
    const MatrixXd below_q = (denominator_.array().colwise() / q.array()).matrix();

    Program program;
    program.rows.setZero(count + below + 1, 2 * points + 2 * below);
    program.cost.resize(2 * points + 2 * below);
    for (const bool is_above : {true, false}) {
      const Index first = is_above ? 0 : points;
      const double sign = is_above ? 1 : -1;
      program.rows.block(0, first, count, points) = sign * above_q.transpose();
      program.rows.block(count, first, below, points) =
          (below_q.array().colwise() * (sign * values_.array() - t)).matrix().transpose();
      program.cost.segment(first, points) = VectorXd::Ones(points) - sign * difference;
    }
    program.rows.row(count + below).head(2 * points).setOnes();
    // Coefficients of q stay within -1 and 1.
    program.rows.block(count, 2 * points, below, below).setIdentity();
    program.rows.block(count, 2 * points + below, below, below) = -MatrixXd::Identity(below, below);
    program.cost.segment(2 * points, below) = (VectorXd::Ones(below) - best_.denominator) / t;
    program.cost.segment(2 * points + below, below) = (VectorXd::Ones(below) + best_.denominator) / t;
    program.sums = VectorXd::Unit(count + below + 1, count + below);
    const auto solution = solution_of(program);
    if (!solution) return false;
    Minimax next = best_;
    next.numerator -= t * solution->multipliers.head(count);
    next.denominator += t * solution->multipliers.segment(count, below);
    const double scale = next.denominator.cwiseAbs().maxCoeff();
    if (!(scale > 0)) return false;
    next.numerator /= scale;
    next.denominator /= scale;
    const VectorXd next_q = denominator_ * next.denominator;
    if (!(next_q.minCoeff() > 0)) return false;
    next.largest = (values_ - (numerator_ * next.numerator).cwiseQuotient(next_q)).cwiseAbs().maxCoeff();
    if (!(next.largest < t)) return false;
    best_ = next;
    return next.largest < t * (1 - kStep);
  }

  const MatrixXd& numerator_;
  const MatrixXd& denominator_;
  const VectorXd& values_;
  Minimax best_;
};

}  // namespace

Minimax minimax(const MatrixXd& numerator, const MatrixXd& denominator, const VectorXd& values,
                const VectorXd& errors) {
  // The differences from least squares, in units of the largest, are numbers that a linear program solves to its
  // tolerance.
  Minimax fit;
  fit.numerator = numerator.colPivHouseholderQr().solve(values);
  fit.denominator = VectorXd::Unit(denominator.cols(), 0);
  const VectorXd difference = values - numerator * fit.numerator;
  fit.largest = difference.cwiseAbs().maxCoeff();
  if (fit.largest <= kNothing * values.cwiseAbs().maxCoeff()) return fit;
  const auto [change, weights] = best_polynomial(numerator, difference / fit.largest);
  fit.numerator += fit.largest * change;
  fit.largest = (values - numerator * fit.numerator).cwiseAbs().maxCoeff();
  if (denominator.cols() == 1) {
    fit.bound = std::min(fit.largest, linear_bound(weights, numerator, values, errors));
    return fit;
  }
  fit = Quotient(numerator, denominator, values, fit).improved();
  fit.bound = std::max(0.0, quotient_bound(numerator, denominator, values, fit.largest) - errors.maxCoeff());
  return fit;
}

}  // namespace lobe
