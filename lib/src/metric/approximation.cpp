#include "lobe/approximation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lobe/error.hpp"
#include "metric/scaled_problem.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The channels of a result, or the weighted sum where coefficients are common or there is a single channel.
std::vector<const Metric*> systems(const MetricResult& result, ChannelCoefficients channels) {
  std::vector<const Metric*> list;
  if (channels == ChannelCoefficients::separate) {
    for (const Metric& metric : result.channels) list.push_back(&metric);
  }
  if (list.empty()) list.push_back(&result.combined);
  return list;
}

/// \param target row of the target, behind the k rows of the basis
ApproximationProblem problem_of(const Metric& metric, std::span<const Material> basis, Index target) {
  const auto k = static_cast<Index>(basis.size());
  ApproximationProblem problem;
  problem.gram = metric.gram.topLeftCorner(k, k);
  problem.gram_error = metric.gram_error.topLeftCorner(k, k);
  problem.products = metric.gram.col(target).head(k);
  problem.products_error = metric.gram_error.col(target).head(k);
  problem.target_square = {metric.gram(target, target), metric.gram_error(target, target)};
  for (const auto& material : basis) problem.names.push_back(material.name);
  return problem;
}

/// Bounds of the largest albedos of the basis, a column per system: per channel, or, for common coefficients, over all
/// channels.
Eigen::MatrixXd albedo_bounds(const Device& device, std::span<const Material> basis, std::size_t count,
                              const ApproximationOptions& options) {
  if (!options.form.energy) return {};
  Eigen::MatrixXd bounds(static_cast<Index>(basis.size()), static_cast<Index>(count));
  const AlbedoOptions albedo{.tolerance = options.metric.tolerance, .precision = options.metric.precision};
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const auto peaks = largest_albedo(device, basis[i], options.energy_theta_max, albedo);
    double largest = 0;
    for (const auto& peak : peaks) largest = std::max(largest, peak.albedo.value + peak.albedo.error);
    for (std::size_t c = 0; c < count; ++c) {
      const AlbedoPeak& own = peaks[peaks.size() == 1 ? 0 : std::min(c, peaks.size() - 1)];
      const double bound = count == 1 ? largest : own.albedo.value + own.albedo.error;
      bounds(static_cast<Index>(i), static_cast<Index>(c)) = bound;
    }
  }
  return bounds;
}

std::vector<Material> joined(std::span<const Material> first, std::span<const Material> second) {
  std::vector<Material> list(first.begin(), first.end());
  list.insert(list.end(), second.begin(), second.end());
  return list;
}

Estimate quotient(const Estimate& a, const Estimate& b) {
  const double value = a.value / b.value;
  return {value, (a.error + value * b.error) / b.value};
}

/// Products of the basis and all targets, and what approximations of them share.
class Measured {
 public:
  Measured(const Device& device, std::span<const Material> targets, std::span<const Material> basis,
           const Lighting& lighting, const ApproximationOptions& options)
      : device_(device), targets_(targets), basis_(basis), options_(options) {
    if (basis.empty()) throw ArgumentError("an approximation has no basis; expected at least one material");
    if (targets.empty()) throw ArgumentError("no target to approximate; expected at least one material");
    result_ = measure(device, joined(basis, targets), lighting, options.metric);
    for (std::size_t t = 0; t < targets.size(); ++t) {
      if (result_.combined.gram(row(t), row(t)) > 0) continue;
      throw NumericError("'" + targets[t].name + "' has norm 0 under lighting '" + lighting.name() +
                         "'; expected a target that is not black");
    }
    bounds_ = albedo_bounds(device, basis, systems(result_, options.channels).size(), options);
  }

  /// One per system.
  [[nodiscard]] std::vector<ApproximationProblem> problems(std::size_t target) const {
    std::vector<ApproximationProblem> problems;
    for (const Metric* metric : systems(result_, options_.channels)) {
      problems.push_back(problem_of(*metric, basis_, row(target)));
      const auto c = static_cast<Index>(problems.size()) - 1;
      if (bounds_.size() > 0) problems.back().largest_albedo = bounds_.col(c);
    }
    return problems;
  }

  /// Weights of the systems in the sum over channels.
  [[nodiscard]] std::vector<double> weights() const {
    const std::size_t count = systems(result_, options_.channels).size();
    if (count == 1) return {1};
    if (!options_.metric.channel_weights.empty()) return options_.metric.channel_weights;
    return std::vector<double>(count, 1.0 / static_cast<double>(count));
  }

  /// Approximations from their coefficients. Residuals are measured as distances between materials.
  /// \param fits by target and system, of the materials chosen for the target
  [[nodiscard]] std::vector<Approximation> finish(std::vector<std::vector<LinearFit>> fits,
                                                  const std::vector<std::vector<Material>>& chosen) const {
    std::vector<Material> approximations;
    for (std::size_t t = 0; t < targets_.size(); ++t) {
      std::vector<VectorXd> coefficients;
      for (const auto& fit : fits[t]) coefficients.push_back(fit.coefficients);
      approximations.push_back(linear_combination(chosen[t], coefficients, "approximation of " + targets_[t].name));
    }
    const auto check = measure(device_, joined(approximations, targets_), result_.lighting, options_.metric);
    const auto measured = systems(check, options_.channels);
    std::vector<Approximation> list;
    for (std::size_t t = 0; t < targets_.size(); ++t) {
      const auto i = static_cast<Index>(t);
      const auto j = static_cast<Index>(targets_.size() + t);
      const auto residual = [&](const Metric& metric) {
        return Estimate{metric.distance(i, j), metric.distance_error(i, j)};
      };
      const auto norm = [&](const Metric& metric) { return Estimate{metric.norm(j), metric.norm_error(j)}; };
      Approximation approximation{result_.lighting, std::move(approximations[t]), std::move(fits[t]), {}, {}, {}, {}};
      for (std::size_t c = 0; c < approximation.fits.size(); ++c) {
        LinearFit& fit = approximation.fits[c];
        fit.residual = residual(*measured[c]);
        const Estimate size = norm(*measured[c]);
        fit.relative_residual = size.value > 0 ? quotient(fit.residual, size) : Estimate{};
      }
      approximation.target_norm = norm(check.combined);
      approximation.residual = residual(check.combined);
      approximation.relative_residual = quotient(approximation.residual, approximation.target_norm);
      for (const auto& pair : result_.unresolved) {
        if (is_relevant(pair.first, t) && is_relevant(pair.second, t)) approximation.unresolved.push_back(pair);
      }
      for (auto& pair : approximation.unresolved) {
        pair.first = std::min(pair.first, basis_.size());
        pair.second = std::min(pair.second, basis_.size());
      }
      list.push_back(std::move(approximation));
    }
    return list;
  }

 private:
  [[nodiscard]] Index row(std::size_t target) const { return static_cast<Index>(basis_.size() + target); }

  [[nodiscard]] bool is_relevant(std::size_t material, std::size_t target) const {
    return material < basis_.size() || material == basis_.size() + target;
  }

  const Device& device_;
  std::span<const Material> targets_;
  std::span<const Material> basis_;
  const ApproximationOptions& options_;
  MetricResult result_;
  Eigen::MatrixXd bounds_;
};

void require_coefficients(std::span<const Material> basis, std::span<const VectorXd> coefficients) {
  if (coefficients.empty()) throw ArgumentError("a combination of materials has no coefficients");
  for (const auto& values : coefficients) {
    if (values.size() != static_cast<Index>(basis.size())) {
      throw ArgumentError(std::to_string(values.size()) + " coefficients for " + std::to_string(basis.size()) +
                          " materials; expected one each");
    }
  }
}

}  // namespace

Material linear_combination(std::span<const Material> basis, std::span<const VectorXd> coefficients, std::string name) {
  require_coefficients(basis, coefficients);
  Material sum{std::move(name), "approximation", {}};
  for (const bool keeps_zeros : {false, true}) {
    for (std::size_t i = 0; i < basis.size(); ++i) {
      const auto at = static_cast<Index>(i);
      const bool is_used = std::ranges::any_of(coefficients, [&](const VectorXd& values) { return values(at) != 0; });
      if (!is_used && !keeps_zeros) continue;
      for (const Term& term : basis[i].terms) {
        const std::size_t channels = std::max(term.weight.size(), coefficients.size());
        if ((term.weight.size() != 1 && term.weight.size() != channels) ||
            (coefficients.size() != 1 && coefficients.size() != channels)) {
          throw ArgumentError("coefficients for " + std::to_string(coefficients.size()) + " channels do not fit '" +
                              basis[i].name + "', which has " + std::to_string(term.weight.size()));
        }
        Term scaled = term;
        scaled.weight.clear();
        for (std::size_t c = 0; c < channels; ++c) {
          scaled.weight.push_back(coefficients[coefficients.size() == 1 ? 0 : c](at) *
                                  term.weight[term.weight.size() == 1 ? 0 : c]);
        }
        sum.terms.push_back(std::move(scaled));
      }
    }
    if (!sum.terms.empty()) break;
  }
  return sum;
}

std::vector<Approximation> approximate(const Device& device, std::span<const Material> targets,
                                       std::span<const Material> basis, const Lighting& lighting,
                                       const ApproximationOptions& options) {
  const Measured measured(device, targets, basis, lighting, options);
  std::vector<std::vector<LinearFit>> fits(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    for (const auto& problem : measured.problems(t)) fits[t].push_back(best_of_channel(problem, options.form));
  }
  const std::vector<Material> all(basis.begin(), basis.end());
  return measured.finish(std::move(fits), std::vector<std::vector<Material>>(targets.size(), all));
}

Approximation approximate(const Device& device, const Material& target, std::span<const Material> basis,
                          const Lighting& lighting, const ApproximationOptions& options) {
  return std::move(approximate(device, {&target, 1}, basis, lighting, options).front());
}

std::vector<GreedyApproximation> greedy_basis(const Device& device, std::span<const Material> targets,
                                              std::span<const Material> candidates, std::size_t count,
                                              const Lighting& lighting, const ApproximationOptions& options) {
  const Measured measured(device, targets, candidates, lighting, options);
  std::vector<GreedyApproximation> list(targets.size());
  std::vector<std::vector<LinearFit>> fits;
  std::vector<std::vector<Material>> chosen(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    GreedyBasis greedy = greedy_combination(measured.problems(t), measured.weights(), count, options.form);
    list[t].steps = std::move(greedy.steps);
    fits.push_back(std::move(greedy.fits));
    for (const auto& step : list[t].steps) chosen[t].push_back(candidates[step.chosen]);
  }
  auto approximations = measured.finish(std::move(fits), chosen);
  for (std::size_t t = 0; t < targets.size(); ++t) list[t].approximation = std::move(approximations[t]);
  return list;
}

}  // namespace lobe
