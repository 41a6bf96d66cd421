#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "core/decompositions.hpp"
#include "core/numbers.hpp"
#include "fit/nearest_point.hpp"
#include "fit/scaled_problem.hpp"
#include "lobe/core/error.hpp"
#include "lobe/fit/approximation.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A fit in coordinates y_i = x_i |a_i| / |f|, in which all vectors have norm 1.
struct ScaledFit {
  VectorXd y;
  bool at_energy_bound = false;
  double multiplier = 0;  ///< of the energy bound, >= 0
  MatrixXd inverse;       ///< k x k, how y answers to changes of the products, first order
  /// k, how y answers to a change of the energy bound, which is also how the multiplier answers to the products;
  /// zero unless it is reached.
  VectorXd bound_answer;
  double multiplier_answer = 0;  ///< of the multiplier to a change of the energy bound
  double kkt_residual = 0;
};

/// The target's products in these coordinates.
struct ScaledTarget {
  VectorXd products;
  VectorXd products_error;
  VectorXd energy;        ///< e_i: sum e_i |y_i| <= 1; empty without albedos
  VectorXd energy_error;  ///< by how much they may be smaller; empty without albedos
};

double sign(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// See LinearFit::kkt_residual.
double kkt_residual(const ScaledBasis& basis, const ScaledTarget& target, const ApproximationForm& form,
                    const ScaledFit& fit) {
  const VectorXd slope = target.products - basis.gram * fit.y;
  double worst = 0;
  for (Index i = 0; i < slope.size(); ++i) {
    if (!(basis.norms(i) > 0)) continue;
    if (form.energy && std::isinf(target.energy(i))) continue;
    const double push = form.energy ? fit.multiplier * target.energy(i) : 0;
    const double y = fit.y(i);
    const bool has_bound_at_zero = form.non_negative || (form.energy && fit.at_energy_bound);
    double violation = 0;
    if (y != 0 || !has_bound_at_zero) {
      violation = std::abs(slope(i) - push * sign(y));
    } else {
      violation = std::max(0.0, (form.non_negative ? slope(i) : std::abs(slope(i))) - push);
    }
    if (form.non_negative) violation = std::max(violation, -y);
    worst = std::max(worst, violation);
  }
  if (form.energy) {
    double sum = 0;
    for (Index i = 0; i < slope.size(); ++i) sum += fit.y(i) == 0 ? 0 : target.energy(i) * std::abs(fit.y(i));
    worst = std::max(worst, sum - 1);
  }
  return worst;
}

/// The minimum with the given signs: y_i = 0 where they are 0, and, at the energy bound, sum e_i sign_i y_i = 1.
ScaledFit solve_face(const ScaledBasis& basis, const ScaledTarget& target, const std::vector<Index>& free,
                     const VectorXd& signs, bool at_energy_bound) {
  const auto n = static_cast<Index>(free.size());
  const Index m = n + (at_energy_bound ? 1 : 0);
  MatrixXd system = MatrixXd::Zero(m, m);
  VectorXd right = VectorXd::Zero(m);
  for (Index i = 0; i < n; ++i) {
    const Index row = free[static_cast<std::size_t>(i)];
    for (Index j = 0; j < n; ++j) system(i, j) = basis.gram(row, free[static_cast<std::size_t>(j)]);
    right(i) = target.products(row);
    if (at_energy_bound) system(i, n) = system(n, i) = target.energy(row) * signs(row);
  }
  if (at_energy_bound) right(n) = 1;

  ScaledFit fit{.y = VectorXd::Zero(basis.size()),
                .at_energy_bound = at_energy_bound,
                .inverse = MatrixXd::Zero(basis.size(), basis.size()),
                .bound_answer = VectorXd::Zero(basis.size())};
  if (m == 0) return fit;
  const Eigen::FullPivLU<MatrixXd> lu(system);
  VectorXd solution = lu.solve(right);
  solution += lu.solve(right - system * solution);
  const MatrixXd inverse = lu.inverse();
  for (Index i = 0; i < n; ++i) {
    const Index row = free[static_cast<std::size_t>(i)];
    fit.y(row) = solution(i);
    for (Index j = 0; j < n; ++j) fit.inverse(row, free[static_cast<std::size_t>(j)]) = inverse(i, j);
    if (at_energy_bound) fit.bound_answer(row) = inverse(i, n);
  }
  if (at_energy_bound) {
    fit.multiplier = std::max(0.0, solution(n));
    fit.multiplier_answer = inverse(n, n);
  }
  return fit;
}

ScaledFit solve_free(const ScaledBasis& basis, const ScaledTarget& target) {
  ScaledFit fit;
  fit.inverse = basis.pseudo_inverse;
  fit.y = fit.inverse * target.products;
  fit.y += fit.inverse * (target.products - basis.gram * fit.y);
  return fit;
}

/// Weights z of points sign_j a_j / e_j with z >= 0 and sum z <= 1, as y = sum of sign_j z_j / e_j.
VectorXd solve_energy(const ScaledBasis& basis, const ScaledTarget& target, bool non_negative, bool& at_energy_bound) {
  std::vector<std::pair<Index, double>> points;  // material, 1 / e with sign
  for (Index i = 0; i < basis.size(); ++i) {
    if (!(basis.norms(i) > 0) || std::isinf(target.energy(i))) continue;
    points.emplace_back(i, 1 / target.energy(i));
    if (!non_negative) points.emplace_back(i, -1 / target.energy(i));
  }
  at_energy_bound = false;
  VectorXd y = VectorXd::Zero(basis.size());
  if (points.empty()) return y;
  const auto n = static_cast<Index>(points.size());
  MatrixXd gram(n, n);
  VectorXd products(n);
  for (Index a = 0; a < n; ++a) {
    const auto [i, scale] = points[static_cast<std::size_t>(a)];
    for (Index b = 0; b < n; ++b) {
      const auto [j, other] = points[static_cast<std::size_t>(b)];
      gram(a, b) = scale * other * basis.gram(i, j);
    }
    products(a) = scale * target.products(i);
  }
  const VectorXd weights = nearest_in_hull(gram, products);
  for (Index a = 0; a < n; ++a) {
    const auto [i, scale] = points[static_cast<std::size_t>(a)];
    y(i) += scale * weights(a);
  }
  double energy = 0;
  for (Index i = 0; i < basis.size(); ++i) energy += y(i) == 0 ? 0 : target.energy(i) * std::abs(y(i));
  at_energy_bound = energy >= 1 - 1e-12;
  return y;
}

/// The active set's answer, solved anew with its signs where that satisfies the conditions better.
ScaledFit solve_bounded(const ScaledBasis& basis, const ScaledTarget& target, const ApproximationForm& form) {
  bool at_energy_bound = false;
  const VectorXd y = form.energy ? solve_energy(basis, target, form.non_negative, at_energy_bound)
                                 : nearest_in_cone(basis.gram, target.products);
  if (form.energy && !form.non_negative && !at_energy_bound) {
    ScaledFit unbounded = solve_free(basis, target);
    double energy = 0;
    for (Index i = 0; i < y.size(); ++i)
      energy += unbounded.y(i) == 0 ? 0 : target.energy(i) * std::abs(unbounded.y(i));
    if (energy <= 1 && basis.rank == basis.size()) return unbounded;
  }
  std::vector<Index> free;
  for (Index i = 0; i < y.size(); ++i) {
    if (y(i) != 0) free.push_back(i);
  }
  ScaledFit polished = solve_face(basis, target, free, y.unaryExpr(&sign), at_energy_bound);
  ScaledFit raw = polished;
  raw.y = y;
  return kkt_residual(basis, target, form, polished) <= kkt_residual(basis, target, form, raw) ? polished : raw;
}

/// By how much the sum e_i |y_i| at the energy bound may be smaller, as the albedos are.
double energy_doubt(const ScaledTarget& target, const ScaledFit& fit) {
  double doubt = 0;
  for (Index i = 0; i < fit.y.size() && fit.at_energy_bound; ++i) {
    if (fit.y(i) != 0) doubt += target.energy_error(i) * std::abs(fit.y(i));
  }
  return doubt;
}

/// Bounds of |y - exact y|, first order: |inverse| (error of products + error of gram |y|), and what the errors of
/// albedos add at the energy bound.
VectorXd scaled_errors(const ScaledBasis& basis, const ScaledTarget& target, const ApproximationForm& form,
                       const ScaledFit& fit) {
  const bool is_bound = form.energy && fit.at_energy_bound;
  VectorXd disturbance = target.products_error + basis.gram_error * fit.y.cwiseAbs();
  if (is_bound && fit.multiplier > 0) disturbance += fit.multiplier * target.energy_error;
  const MatrixXd answer = fit.inverse.cwiseAbs();
  VectorXd error = answer * disturbance;
  double multiplier_error = 0;
  if (is_bound) {
    const double doubt = energy_doubt(target, fit);
    error += fit.bound_answer.cwiseAbs() * doubt;
    multiplier_error = fit.bound_answer.cwiseAbs().dot(disturbance) + std::abs(fit.multiplier_answer) * doubt;
  }
  // Beyond first order: with exact albedos the inverse of the disturbed matrix exists for sure only where this is below
  // 1.
  const double contraction = (answer * basis.gram_error).rowwise().sum().maxCoeff();
  if (contraction >= 1) {
    for (Index i = 0; i < error.size(); ++i) error(i) = error(i) > 0 ? kInfinity : 0;
    return error;
  }
  error /= 1 - contraction;
  const VectorXd further = basis.gram_error * error;
  multiplier_error += fit.bound_answer.size() > 0 ? fit.bound_answer.cwiseAbs().dot(further) : 0;
  if (!form.non_negative && !is_bound) return error;
  const VectorXd slope = target.products - basis.gram * fit.y;
  for (Index j = 0; j < error.size(); ++j) {
    if (fit.y(j) != 0 || !(basis.norms(j) > 0)) continue;
    if (form.energy && std::isinf(target.energy(j))) continue;
    const double energy = is_bound ? target.energy(j) : 0;
    const double doubt =
        disturbance(j) + further(j) + basis.gram.row(j).cwiseAbs().dot(error) + multiplier_error * energy;
    for (const double sign : {1.0, -1.0}) {
      if (sign < 0 && form.non_negative) continue;
      const double missing = doubt - fit.multiplier * energy + sign * slope(j);
      if (missing <= 0) continue;
      // How its condition answers to y_j as the others and the multiplier give way.
      double stiffness = 1 - basis.gram.row(j).dot(fit.inverse * basis.gram.col(j));
      if (is_bound) {
        stiffness -= energy * (2 * sign * fit.bound_answer.dot(basis.gram.col(j)) + energy * fit.multiplier_answer);
      }
      error(j) = std::max(error(j), stiffness > kEpsilon ? missing / stiffness : kInfinity);
    }
  }
  return error;
}

Estimate root(double square, double error) {
  const double value = std::sqrt(std::max(0.0, square));
  const double above = std::sqrt(std::max(0.0, square + error)) - value;
  const double below = value - std::sqrt(std::max(0.0, square - error));
  return {value, std::max(above, below)};
}

void require_vector(const VectorXd& vector, Index size, const char* what) {
  if (vector.size() != size) {
    throw ArgumentError(std::string(what) + " of an approximation are " + std::to_string(vector.size()) +
                        "; expected " + std::to_string(size) + ", one per basis material");
  }
}

void check(const ApproximationProblem& problem, Index size, const ApproximationForm& form) {
  require_vector(problem.products, size, "the products");
  if (problem.products_error.size() > 0) require_vector(problem.products_error, size, "the errors of products");
  if (!problem.names.empty() && problem.names.size() != static_cast<std::size_t>(size)) {
    throw ArgumentError(std::to_string(problem.names.size()) + " names for " + std::to_string(size) +
                        " basis materials; expected one each");
  }
  if (!problem.products.allFinite() || !std::isfinite(problem.target_square.value)) {
    throw ArgumentError("a product of an approximation is no finite number");
  }
  if (!(problem.target_square.value > 0)) {
    throw NumericError("the target of an approximation has norm 0, so that it has no relative residual");
  }
  if (!form.energy) return;
  require_vector(problem.largest_albedo, size, "the largest albedos");
  if (problem.largest_albedo_error.size() > 0) {
    require_vector(problem.largest_albedo_error, size, "the errors of largest albedos");
    if (!(problem.largest_albedo_error.array() >= 0).all()) {
      throw ArgumentError("an error of a largest albedo is negative or no number; expected a value >= 0");
    }
  }
  if (!(problem.largest_albedo.array() > 0).all()) {
    throw ArgumentError("a basis material's largest albedo is not positive; expected a positive value for the energy");
  }
}

ScaledTarget scaled(const ScaledBasis& basis, const ApproximationProblem& problem, double norm) {
  const Index k = basis.size();
  ScaledTarget target{VectorXd::Zero(k), VectorXd::Zero(k), {}, {}};
  for (Index i = 0; i < k; ++i) {
    if (!(basis.norms(i) > 0)) continue;
    const double size = basis.norms(i) * norm;
    target.products(i) = problem.products(i) / size;
    const double error = problem.products_error.size() > 0 ? problem.products_error(i) / size : 0;
    target.products_error(i) = error + 4 * kEpsilon;
  }
  if (problem.largest_albedo.size() == k) {
    target.energy = (problem.largest_albedo.array() / basis.norms.array()).matrix() * norm;
    target.energy_error = VectorXd::Zero(k);
    for (Index i = 0; i < k && problem.largest_albedo_error.size() == k; ++i) {
      if (std::isfinite(target.energy(i))) {
        target.energy_error(i) = problem.largest_albedo_error(i) / basis.norms(i) * norm;
      }
    }
  }
  return target;
}

std::string name_of(const ApproximationProblem& problem, std::size_t i) {
  return problem.names.empty() ? std::to_string(i + 1) : "'" + problem.names[i] + "'";
}

std::string names_of(const ApproximationProblem& problem, std::span<const std::size_t> indices) {
  std::string names;
  for (const std::size_t i : indices) names += (names.empty() ? "" : ", ") + name_of(problem, i);
  return names;
}

/// Basis materials whose squares are hardly known, if they are all that keeps a basis from full rank; else none.
std::vector<std::size_t> hardly_known(const ApproximationProblem& problem, const ScaledBasis& basis) {
  constexpr double kHardly = 0.5;  // relative error of the square
  std::vector<std::size_t> unknown;
  std::vector<Index> others;
  for (Index i = 0; i < basis.size(); ++i) {
    if (basis.gram_error(i, i) >= kHardly) {
      unknown.push_back(static_cast<std::size_t>(i));
    } else {
      others.push_back(i);
    }
  }
  if (unknown.empty() || others.empty()) return unknown;
  const ScaledBasis rest(problem.gram(others, others), problem.gram_error(others, others));
  return rest.rank == rest.size() ? unknown : std::vector<std::size_t>();
}

}  // namespace

ScaledBasis::ScaledBasis(const MatrixXd& products, const MatrixXd& error) {
  const Index k = products.rows();
  if (k == 0 || products.cols() != k || (error.size() > 0 && (error.rows() != k || error.cols() != k))) {
    throw ArgumentError(
        "the Gram matrix of an approximation is empty or not square, or its errors are of another size");
  }
  if (!products.allFinite()) throw ArgumentError("the Gram matrix of an approximation has an entry that is not finite");
  norms = products.diagonal().cwiseMax(0).cwiseSqrt();
  gram = MatrixXd::Zero(k, k);
  gram_error = MatrixXd::Zero(k, k);
  for (Index j = 0; j < k; ++j) {
    for (Index i = 0; i < k; ++i) {
      if (!(norms(i) > 0 && norms(j) > 0)) continue;
      const double size = norms(i) * norms(j);
      gram(i, j) = i == j ? 1 : products(i, j) / size;
      gram_error(i, j) = (error.size() > 0 ? error(i, j) / size : 0) + 4 * kEpsilon;
    }
  }
  const Eigenpairs eigen = symmetric_eigenpairs(gram);
  const VectorXd& values = eigen.values;
  // Eigenvalues move by no more than the norm of the error.
  const double threshold = std::max(gram_error.norm(), 4 * static_cast<double>(k) * kEpsilon * values.maxCoeff());
  pseudo_inverse = MatrixXd::Zero(k, k);
  for (Index i = 0; i < k; ++i) {
    if (values(i) <= threshold) continue;
    ++rank;
    const VectorXd vector = eigen.vectors.col(i);
    pseudo_inverse += vector * vector.transpose() / values(i);
  }
  condition = rank == k ? values(k - 1) / values(0) : kInfinity;
}

std::vector<std::size_t> ScaledBasis::dependent() const {
  // Elimination by the largest pivot: what is left when the rank is used up depends on the rest.
  MatrixXd rest = gram;
  std::vector<Index> left(static_cast<std::size_t>(size()));
  std::iota(left.begin(), left.end(), Index{0});
  for (Index step = 0; step < rank; ++step) {
    // Among equal ones the first stays.
    const auto best = std::ranges::max_element(
        left, [&](Index a, Index b) { return rest(a, a) < rest(b, b) - 1e-9 * std::abs(rest(b, b)); });
    const Index pivot = *best;
    left.erase(best);
    if (!(rest(pivot, pivot) > 0)) break;
    rest -= (rest.col(pivot) * rest.row(pivot) / rest(pivot, pivot)).eval();
  }
  return {left.begin(), left.end()};
}

double fall_of(const Estimate& residual, double slack) {
  const double low = std::max(0.0, residual.value - residual.error);
  return low - std::sqrt(std::max(0.0, low * low - slack));
}

LinearFit fit(const ScaledBasis& basis, const ApproximationProblem& problem, const ApproximationForm& form) {
  check(problem, basis.size(), form);
  const double norm = std::sqrt(problem.target_square.value);
  const ScaledTarget target = scaled(basis, problem, norm);
  const ScaledFit solution =
      form.non_negative || form.energy ? solve_bounded(basis, target, form) : solve_free(basis, target);

  LinearFit result;
  const Index k = basis.size();
  const VectorXd error = scaled_errors(basis, target, form, solution);
  result.coefficients = result.coefficients_error = VectorXd::Zero(k);
  for (Index i = 0; i < k; ++i) {
    const bool is_zero = !(basis.norms(i) > 0);
    const double scale = is_zero ? 0 : norm / basis.norms(i);
    result.coefficients(i) = scale * solution.y(i);
    result.coefficients_error(i) = is_zero ? kInfinity : scale * error(i);
    const bool has_bound = form.non_negative || (form.energy && solution.at_energy_bound);
    result.at_zero.push_back(has_bound && solution.y(i) == 0);
  }
  result.at_energy_bound = solution.at_energy_bound;
  for (Index i = 0; i < k && problem.largest_albedo.size() == k; ++i) {
    const double x = std::abs(result.coefficients(i));
    if (x > 0) result.energy += x * problem.largest_albedo(i);
  }
  // |f - sum y a|^2 over |f|^2, and what the errors of the products make of it: to first order y does not matter.
  const VectorXd size = solution.y.cwiseAbs();
  const double target_error = problem.target_square.error / problem.target_square.value + 4 * kEpsilon;
  const double square = 1 - 2 * solution.y.dot(target.products) + solution.y.dot(basis.gram * solution.y);
  const double square_error = target_error + 2 * size.dot(target.products_error) + size.dot(basis.gram_error * size);
  result.relative_residual = root(square, square_error);
  result.residual = {norm * result.relative_residual.value,
                     norm * (result.relative_residual.error + result.relative_residual.value * target_error / 2)};
  if (form.energy) {
    // The square falls by twice the multiplier as the bound grows.
    result.energy_slack = norm * norm * 2 * solution.multiplier * energy_doubt(target, solution);
    const double fall = fall_of(result.residual, result.energy_slack);
    result.residual.error += fall;
    result.relative_residual.error += fall / norm;
  }
  result.rank = basis.rank;
  result.condition = basis.condition;
  if (basis.rank < k) result.dependent = basis.dependent();
  result.kkt_residual = kkt_residual(basis, target, form, solution);
  return result;
}

LinearFit best_of_channel(const ApproximationProblem& problem, const ApproximationForm& form) {
  if (problem.target_square.value > 0 || !std::isfinite(problem.target_square.value)) {
    return best_combination(problem, form);
  }
  // A target that correlates with nothing has the same combination at any size.
  ApproximationProblem other = problem;
  other.products.setZero();
  other.target_square = {1, 0};
  LinearFit result = best_combination(other, form);
  result.residual = {0, std::sqrt(problem.target_square.error)};
  result.relative_residual = {0, 0};
  return result;
}

LinearFit best_combination(const ApproximationProblem& problem, const ApproximationForm& form) {
  const ScaledBasis basis(problem.gram, problem.gram_error);
  check(problem, basis.size(), form);
  if (basis.rank < basis.size() && !form.allow_dependent) {
    if (const auto unknown = hardly_known(problem, basis); !unknown.empty()) {
      double worst = 0;
      for (const std::size_t i : unknown) worst = std::max(worst, basis.gram_error(Index(i), Index(i)));
      throw NumericError(
          "the squared norm of " + names_of(problem, unknown) + " in the basis has an error of " +
          (worst < 10 ? std::to_string(std::lround(100 * worst)) + " % of itself" : "many times itself") +
          ", which hides what it shares with others; expected one below 50 %: resolve it better, by a " +
          "finer grid or a smaller tolerance, leave it out, or allow dependent materials");
    }
    throw NumericError("the basis is linearly dependent within the errors of its scalar products (rank " +
                       std::to_string(basis.rank) + " of " + std::to_string(basis.size()) +
                       "): " + names_of(problem, basis.dependent()) +
                       (basis.size() - basis.rank == 1 ? " depends on the others" : " depend on the others") +
                       "; leave them out, ask for a smaller tolerance, or allow dependent materials");
  }
  return fit(basis, problem, form);
}

}  // namespace lobe
