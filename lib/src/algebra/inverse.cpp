#include "lobe/algebra/inverse.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "algebra/operands.hpp"
#include "algebra/operator_blocks.hpp"
#include "core/bisection.hpp"
#include "core/decompositions.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kHarmless = 0.1;  // share of X that errors of F and G may make up without regularisation

/// The singular value decomposition of a block of F, and the block of G in its terms: U^T G.
struct Factorised {
  VectorXd values;
  MatrixXd right;    // V
  MatrixXd target;   // U^T G
  VectorXd squares;  // of the rows of `target`
  double multiplicity = 1;
};

/// Parts of the solution, with everything that depends on lambda.
class Tikhonov {
 public:
  Tikhonov(const OperatorBlocks& f, const OperatorBlocks& g) : parts_(f.size()) {
    parallel_for(f.size(), [&](std::size_t b) {
      SingularValues svd = singular_values(f.blocks[b]);
      Factorised& part = parts_[b];
      part.values = std::move(svd.values);
      part.right = std::move(svd.right);
      part.target = svd.left.transpose() * g.blocks[b];
      part.squares = part.target.rowwise().squaredNorm();
      part.multiplicity = static_cast<double>(f.multiplicities[b]);
    });
    for (const auto& part : parts_) {
      largest_ = std::max(largest_, part.values.maxCoeff());
      smallest_ = std::min(smallest_, part.values.minCoeff());
    }
    // Below this singular values are rounding.
    floor_ = kEpsilon * static_cast<double>(f.blocks.front().rows()) * largest_;
  }

  [[nodiscard]] double largest() const { return largest_; }
  [[nodiscard]] double smallest() const { return smallest_; }
  [[nodiscard]] double floor() const { return floor_; }

  /// |F o X - G|
  [[nodiscard]] double discrepancy(double lambda) const {
    return std::sqrt(sum([&](double value, double square) { return std::pow(loss(value, lambda), 2) * square; }));
  }
  /// |X|
  [[nodiscard]] double norm(double lambda) const {
    return std::sqrt(sum([&](double value, double square) { return std::pow(filter(value, lambda), 2) * square; }));
  }
  [[nodiscard]] double amplification(double lambda) const {
    double largest = 0;
    for (const auto& part : parts_) {
      for (const double value : part.values) largest = std::max(largest, filter(value, lambda));
    }
    return largest;
  }
  /// Largest 1 / (sigma^2 + lambda^2)
  [[nodiscard]] double largest_inverse(double lambda) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& part : parts_) {
      for (const double value : part.values) {
        if (value > floor_) least = std::min(least, value * value + lambda * lambda);
      }
    }
    return 1 / least;
  }
  /// Generalised cross validation: the square of the discrepancy over that of the degrees of freedom left for it.
  [[nodiscard]] double cross_validation(double lambda) const {
    const double freedom = sum([&](double value, double) { return loss(value, lambda); });
    return std::pow(discrepancy(lambda) / freedom, 2);
  }
  [[nodiscard]] std::size_t kept(double lambda) const {
    const double above = std::max(lambda, floor_);
    return static_cast<std::size_t>(sum([&](double value, double) { return value > above ? 1.0 : 0.0; }));
  }
  [[nodiscard]] std::size_t components() const {
    return static_cast<std::size_t>(sum([](double, double) { return 1.0; }));
  }

  /// Blocks of X.
  [[nodiscard]] OperatorBlocks solution(double lambda, const OperatorBlocks& shape) const {
    OperatorBlocks x{std::vector<MatrixXd>(parts_.size()), shape.multiplicities};
    parallel_for(parts_.size(), [&](std::size_t b) {
      const VectorXd filters = parts_[b].values.unaryExpr([&](double value) { return filter(value, lambda); });
      x.blocks[b] = parts_[b].right * filters.asDiagonal() * parts_[b].target;
    });
    return x;
  }

 private:
  [[nodiscard]] double filter(double value, double lambda) const {
    return value > floor_ ? value / (value * value + lambda * lambda) : 0;
  }
  [[nodiscard]] double loss(double value, double lambda) const {
    return value > floor_ ? lambda * lambda / (value * value + lambda * lambda) : 1;
  }
  /// Over all components, of a function of the singular value and the square of G along it.
  template <typename Term>
  [[nodiscard]] double sum(const Term& term) const {
    double total = 0;
    for (const auto& part : parts_) {
      for (Index k = 0; k < part.values.size(); ++k) total += part.multiplicity * term(part.values(k), part.squares(k));
    }
    return total;
  }

  std::vector<Factorised> parts_;
  double largest_ = 0;
  double smallest_ = std::numeric_limits<double>::infinity();
  double floor_ = 0;
};

/// Discrepancy in F o X = G that the stated errors of F and G allow.
struct Tolerance {
  double of_f = 0;  ///< largest |error of F|, to be multiplied by |X|
  double of_g = 0;
  [[nodiscard]] double allowed(double norm) const { return of_g + of_f * norm; }
};

/// The lambda for which a function, below 0 for small lambda and above for large ones, is 0.
template <typename Function>
double root_between(double low, double high, const Function& function) {
  constexpr int kHalvings = 60;
  const auto is_below = [&](double lambda) { return function(lambda) < 0; };
  return bisect({low, high}, kHalvings, is_below, 0, [](double a, double b) { return std::sqrt(a * b); }).low;
}

double least_cross_validation(const Tikhonov& problem) {
  constexpr int kSteps = 400;
  double best = problem.largest();
  for (int step = 0; step <= kSteps; ++step) {
    const double share = static_cast<double>(step) / kSteps;
    const double lambda = problem.largest() * std::pow(problem.floor() / problem.largest(), share);
    if (problem.cross_validation(lambda) < problem.cross_validation(best)) best = lambda;
  }
  return best;
}

void choose(const Tikhonov& problem, const Tolerance& tolerance, std::optional<double> given, ChannelSolution& solution,
            const std::string& g) {
  if (given) {
    solution.regularisation = Regularisation::given;
    solution.lambda = *given;
    return;
  }
  const double norm = problem.norm(0);
  // Rounding of F and G stands for unknown errors: then only a perfectly conditioned F does without regularisation.
  const bool is_known = std::isfinite(tolerance.allowed(norm));
  const double change = problem.amplification(0) * (is_known ? tolerance.allowed(norm) : problem.floor() * norm);
  const bool sees_all = problem.smallest() > problem.floor();
  if (sees_all && change <= kHarmless * norm) {
    solution.regularisation = Regularisation::none;
    return;
  }
  if (!is_known) {
    solution.regularisation = Regularisation::cross_validation;
    solution.lambda = least_cross_validation(problem);
    return;
  }
  solution.regularisation = Regularisation::discrepancy;
  const auto excess = [&](double lambda) {
    return problem.discrepancy(lambda) - tolerance.allowed(problem.norm(lambda));
  };
  constexpr double kAlmostZero = 1e3;  // times the largest singular value: X is nothing
  const double high = kAlmostZero * problem.largest();
  if (excess(high) <= 0) throw NumericError("'" + g + "' is no larger than its stated error; nothing to solve for");
  solution.lambda = excess(problem.floor()) >= 0 ? problem.floor() : root_between(problem.floor(), high, excess);
}

/// The delta part of X: least |F x - G|^2 + lambda^2 |x|^2 for each direction and its mirror image.
Matrix2d solve_delta(const Matrix2d& f, const Matrix2d& g, double lambda, const std::string& name) {
  constexpr double kRounding = 1e-12;
  const double size = g.cwiseAbs().maxCoeff();
  if (size == 0) return Matrix2d::Zero();
  if (f.cwiseAbs().maxCoeff() == 0) {
    throw NumericError("'" + name + "' has delta parts and the given factor has none: no X makes them");
  }
  const Matrix2d least = f.completeOrthogonalDecomposition().solve(g);
  if ((f * least - g).cwiseAbs().maxCoeff() > kRounding * size) {
    throw NumericError("the delta parts of '" + name + "' come from no X: the given factor does not let them through");
  }
  if (lambda == 0) return least;
  return (f.transpose() * f + lambda * lambda * Matrix2d::Identity()).inverse() * f.transpose() * g;
}

BrdfTable solution_frame(const BrdfTable& f, const BrdfTable& g, const std::string& expression) {
  BrdfTable x;
  x.grid = f.grid;
  x.form = f.form;
  x.channels = f.channels;
  x.channel_names = f.channel_names;
  x.values.resize(x.channels * x.size());
  const std::size_t rings = x.grid.rings().size();
  x.error.assign(x.channels * rings * rings, kUnknown);
  if (g.has_delta()) {
    x.mirror.resize(x.channels * x.rows());
    x.retro.resize(x.channels * x.rows());
  }
  x.expression = expression;
  x.resolution_error = kUnknown;
  x.is_unresolved = f.is_unresolved || g.is_unresolved;
  return x;
}

/// States what a change of X in the Hilbert-Schmidt norm can be at a node: all of it between two nodes, for isotropic
/// tables between two rings at one azimuth or, in the root mean square over azimuth, at all of them.
void state_errors(double change, std::size_t channel, BrdfTable& x) {
  const auto rings = x.grid.rings();
  const bool is_isotropic = x.form == TableForm::isotropic;
  x.even_error.resize(is_isotropic ? x.error.size() : 0);
  x.odd_part.assign(x.even_error.size(), 0);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (std::size_t j = 0; j < rings.size(); ++j) {
      const std::size_t at = (channel * rings.size() + i) * rings.size() + j;
      const double nodes = std::sqrt(rings[i].weight * rings[j].weight);
      const double counts = std::sqrt(static_cast<double>(rings[i].count) * static_cast<double>(rings[j].count));
      if (is_isotropic) x.even_error[at] = change / (nodes * counts);
      x.error[at] = is_isotropic ? std::sqrt(counts) * x.even_error[at] : change / nodes;
    }
  }
}

ChannelSolution solve_channel(const BrdfTable& f, const BrdfTable& g, std::size_t channel, const SolveOptions& options,
                              BrdfTable& x) {
  OperatorBlocks f_blocks = smooth_blocks(f, channel);
  OperatorBlocks g_blocks = smooth_blocks(g, channel);
  const double g_norm = std::sqrt(squared_norm(g_blocks));
  add_delta(f, channel, 1, f_blocks);
  add_delta(g, channel, 1, g_blocks);
  if (squared_norm(f_blocks) == 0) throw NumericError("'" + f.expression + "' is zero; no X gives anything by it");
  if (squared_norm(g_blocks) == 0) throw NumericError("'" + g.expression + "' is zero, and so would be X");

  const Tikhonov problem(f_blocks, g_blocks);
  ChannelSolution solution;
  const Tolerance tolerance{error_norms(f, channel).largest, error_norms(g, channel).hilbert_schmidt};
  choose(problem, tolerance, options.lambda, solution, g.expression);
  const double lambda = solution.lambda;

  OperatorBlocks blocks = problem.solution(lambda, f_blocks);
  for (std::size_t row = 0; g.has_delta() && row < g.rows(); ++row) {
    set_delta(solve_delta(delta_matrix(f, channel, row), delta_matrix(g, channel, row), lambda, g.expression), channel,
              row, x);
  }
  solution.discrepancy = problem.discrepancy(lambda);
  if (lambda == 0) {  // the sum over components knows no rounding
    OperatorBlocks residual = g_blocks;
    parallel_for(residual.size(), [&](std::size_t b) { residual.blocks[b] -= f_blocks.blocks[b] * blocks.blocks[b]; });
    solution.discrepancy = std::sqrt(squared_norm(residual));
  }
  add_delta(x, channel, -1, blocks);
  store_smooth(blocks, channel, x);

  solution.relative_discrepancy = g.has_delta() ? kUnknown : solution.discrepancy / g_norm;
  solution.norm = std::sqrt(squared_norm(blocks));
  solution.expected_discrepancy = tolerance.allowed(problem.norm(lambda));
  solution.condition = problem.largest() / problem.smallest();
  solution.amplification = problem.amplification(lambda);
  // Of (F* F + lambda^2) X = F* G, to first order.
  state_errors(solution.amplification * solution.expected_discrepancy +
                   tolerance.of_f * problem.largest_inverse(lambda) * solution.discrepancy,
               channel, x);
  solution.kept = problem.kept(lambda);
  solution.components = problem.components();
  solution.least_value = least_value(x, channel);
  return solution;
}

}  // namespace

Solution solve(const BrdfTable& given_f, const BrdfTable& given_g, const SolveOptions& options) {
  check(given_f);
  check(given_g);
  if (options.lambda && !(*options.lambda >= 0 && std::isfinite(*options.lambda))) {
    throw ArgumentError("lambda " + shortest(*options.lambda) + "; expected a number, 0 or more");
  }
  const std::array<const BrdfTable*, 2> given{&given_f, &given_g};
  const Operands operands(given, common_shape(given, options.exact_grid), resample);
  const BrdfTable& f = operands[0];
  const BrdfTable& g = operands[1];
  Solution result{solution_frame(f, g, "solve(" + given_f.expression + ", " + given_g.expression + ")"), {}};
  for (std::size_t c = 0; c < f.channels; ++c) {
    if (options.progress && !options.progress("solve", static_cast<double>(c) / static_cast<double>(f.channels))) {
      throw Cancelled("solve interrupted");
    }
    result.channels.push_back(solve_channel(f, g, c, options, result.table));
  }
  drop_zeros(result.table.mirror);
  drop_zeros(result.table.retro);
  return result;
}

}  // namespace lobe
