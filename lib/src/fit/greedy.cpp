#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/scaled_problem.hpp"
#include "lobe/core/error.hpp"
#include "lobe/fit/approximation.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The problem of some of the materials, in the given order.
ApproximationProblem part(const ApproximationProblem& whole, const std::vector<Index>& chosen) {
  ApproximationProblem problem;
  problem.gram = whole.gram(chosen, chosen);
  if (whole.gram_error.size() > 0) problem.gram_error = whole.gram_error(chosen, chosen);
  problem.products = whole.products(chosen);
  if (whole.products_error.size() > 0) problem.products_error = whole.products_error(chosen);
  problem.target_square = whole.target_square;
  if (whole.largest_albedo.size() > 0) problem.largest_albedo = whole.largest_albedo(chosen);
  if (whole.largest_albedo_error.size() > 0) problem.largest_albedo_error = whole.largest_albedo_error(chosen);
  for (const Index i : chosen) {
    if (!whole.names.empty()) problem.names.push_back(whole.names[static_cast<std::size_t>(i)]);
  }
  return problem;
}

/// (a_i . r)^2 / |a_i|^2 for every material, zero where the product is within its error.
VectorXd correlations(const ApproximationProblem& problem, const std::vector<Index>& chosen, const VectorXd& x,
                      bool non_negative) {
  constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
  VectorXd result = VectorXd::Zero(problem.products.size());
  const double norm = std::sqrt(problem.target_square.value);
  for (Index i = 0; i < result.size(); ++i) {
    const double square = problem.gram(i, i);
    if (!(square > 0)) continue;
    double product = problem.products(i);
    double error = kRounding * norm * std::sqrt(square);
    if (problem.products_error.size() > 0) error += problem.products_error(i);
    for (std::size_t j = 0; j < chosen.size(); ++j) {
      const double share = x(static_cast<Index>(j));
      product -= problem.gram(i, chosen[j]) * share;
      if (problem.gram_error.size() > 0) error += problem.gram_error(i, chosen[j]) * std::abs(share);
      error += kRounding * std::abs(problem.gram(i, chosen[j]) * share);
    }
    if ((non_negative ? product : std::abs(product)) > error) result(i) = product * product / square;
  }
  return result;
}

GreedyStep step_of(std::size_t chosen, std::span<const ApproximationProblem> channels, std::span<const double> weights,
                   const std::vector<LinearFit>& fits) {
  double square = 0;
  double square_error = 0;
  double target = 0;
  double target_error = 0;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto [value, error] = fits[c].residual;
    square += weights[c] * value * value;
    square_error += weights[c] * (2 * value + error) * error;
    target += weights[c] * channels[c].target_square.value;
    target_error += weights[c] * channels[c].target_square.error;
  }
  const double residual = std::sqrt(square);
  const double residual_error =
      std::max(std::sqrt(square + square_error) - residual, residual - std::sqrt(std::max(0.0, square - square_error)));
  const double norm = std::sqrt(target);
  const double relative = residual / norm;
  return {
      chosen, {residual, residual_error}, {relative, residual_error / norm + relative * target_error / (2 * target)}};
}

bool is_independent(std::span<const ApproximationProblem> channels, const std::vector<Index>& chosen) {
  return std::ranges::any_of(channels, [&](const ApproximationProblem& whole) {
    const auto problem = part(whole, chosen);
    return ScaledBasis(problem.gram, problem.gram_error).rank == static_cast<Index>(chosen.size());
  });
}

}  // namespace

GreedyBasis greedy_combination(std::span<const ApproximationProblem> channels, std::span<const double> weights,
                               std::size_t count, const ApproximationForm& form) {
  if (channels.empty() || channels.size() != weights.size()) {
    throw ArgumentError("greedy selection has " + std::to_string(channels.size()) + " problems and " +
                        std::to_string(weights.size()) + " weights; expected as many, at least one");
  }
  if (count == 0) throw ArgumentError("greedy selection of 0 materials; expected at least 1");
  for (const auto& problem : channels) {
    if (problem.products.size() != channels.front().products.size()) {
      throw ArgumentError("the problems of a greedy selection have different numbers of materials");
    }
    (void)ScaledBasis(problem.gram, problem.gram_error);
  }
  if (std::ranges::none_of(channels, [](const auto& problem) { return problem.target_square.value > 0; })) {
    throw NumericError("the target of a greedy selection has norm 0, so that it has no relative residual");
  }
  // A channel may see materials as dependent that another tells apart.
  ApproximationForm inner = form;
  inner.allow_dependent = true;

  GreedyBasis result;
  std::vector<Index> chosen;
  std::vector<bool> is_spent(static_cast<std::size_t>(channels.front().products.size()));
  while (chosen.size() < count) {
    VectorXd gain = VectorXd::Zero(channels.front().products.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const VectorXd x = chosen.empty() ? VectorXd() : result.fits[c].coefficients;
      gain += weights[c] * correlations(channels[c], chosen, x, form.non_negative);
    }
    for (Index i = 0; i < gain.size(); ++i) {
      if (is_spent[static_cast<std::size_t>(i)]) gain(i) = 0;
    }
    Index best = 0;
    if (!(gain.maxCoeff(&best) > 0)) break;
    is_spent[static_cast<std::size_t>(best)] = true;
    chosen.push_back(best);
    if (!is_independent(channels, chosen)) {
      chosen.pop_back();
      continue;
    }
    result.fits.clear();
    for (const auto& problem : channels) result.fits.push_back(best_of_channel(part(problem, chosen), inner));
    result.steps.push_back(step_of(static_cast<std::size_t>(best), channels, weights, result.fits));
  }
  if (chosen.empty())
    throw NumericError("no basis material correlates with the target; expected at least one that does");
  return result;
}

}  // namespace lobe
