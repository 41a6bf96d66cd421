#include "lobe/fit/approximation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "algebra/channel_mix.hpp"
#include "energy/albedo.hpp"
#include "fit/scaled_problem.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "metric/routed_set.hpp"
#include "metric/routes.hpp"
#include "reflectance/prepared.hpp"
#include "table/as_function.hpp"
#include "table/tabulate.hpp"

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
ApproximationProblem problem_of(const Metric& metric, std::span<const Reflectance> basis, Index target) {
  const auto k = static_cast<Index>(basis.size());
  ApproximationProblem problem;
  problem.gram = metric.gram.topLeftCorner(k, k);
  problem.gram_error = metric.gram_error.topLeftCorner(k, k);
  problem.products = metric.gram.col(target).head(k);
  problem.products_error = metric.gram_error.col(target).head(k);
  problem.target_square = {metric.gram(target, target), metric.gram_error(target, target)};
  for (const auto& reflectance : basis) problem.names.push_back(reflectance.name());
  return problem;
}

/// Largest albedos of the basis, a column per system: per channel, or, for common coefficients, over all channels.
struct AlbedoBounds {
  Eigen::MatrixXd largest;  ///< surely not exceeded; empty if nobody asks
  Eigen::MatrixXd error;    ///< by how much albedos may be smaller
};

AlbedoBounds albedo_bounds(const Device& device, std::span<const Reflectance> basis, std::size_t count,
                           const ApproximationOptions& options) {
  if (!options.form.energy) return {};
  // Albedos are cheap beside products, and coefficients at the bound take their relative errors.
  constexpr double kTolerance = 1e-6;
  const AlbedoOptions albedo{.tolerance = std::min(options.metric.tolerance, kTolerance),
                             .precision = options.metric.precision};
  const auto rows = static_cast<Index>(basis.size());
  AlbedoBounds bounds{Eigen::MatrixXd(rows, static_cast<Index>(count)),
                      Eigen::MatrixXd(rows, static_cast<Index>(count))};
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const auto peaks = largest_albedo(device, basis[i], options.energy_theta_max, albedo);
    for (std::size_t c = 0; c < count; ++c) {
      double above = 0;
      double below = 0;
      for (std::size_t k = 0; k < peaks.size(); ++k) {
        if (count > 1 && k != std::min(c, peaks.size() - 1)) continue;
        above = std::max(above, peaks[k].albedo.value + peaks[k].albedo.error);
        below = std::max(below, peaks[k].albedo.value - peaks[k].albedo.error);
      }
      bounds.largest(static_cast<Index>(i), static_cast<Index>(c)) = above;
      bounds.error(static_cast<Index>(i), static_cast<Index>(c)) = std::isfinite(above) ? above - below : 0;
    }
  }
  return bounds;
}

bool are_formulas(std::span<const Reflectance> reflectances) {
  return std::ranges::all_of(reflectances, is_formula);
}

std::vector<Material> formulas_of(std::span<const Reflectance> reflectances) {
  std::vector<Material> formulas;
  for (const Reflectance& one : reflectances) formulas.push_back(*one.formula());
  return formulas;
}

/// One vector of coefficients per channel, or one for all, by reflectance: weights of its channels.
std::vector<std::vector<double>> weights_of(std::span<const VectorXd> coefficients) {
  std::vector<std::vector<double>> weights(static_cast<std::size_t>(coefficients.front().size()));
  for (std::size_t i = 0; i < weights.size(); ++i) {
    for (const VectorXd& values : coefficients) weights[i].push_back(values(static_cast<Index>(i)));
  }
  return weights;
}

/// sum x_i f_i
BrdfFunction combined_function(std::vector<BrdfFunction> parts, std::vector<std::vector<double>> weights,
                               std::string name) {
  BrdfFunction sum;
  sum.name = std::move(name);
  sum.is_bilateral = true;
  for (const BrdfFunction& part : parts) {
    if (part.channels.size() > sum.channels.size()) sum.channels = part.channels;
    sum.is_isotropic = sum.is_isotropic && part.is_isotropic;
    sum.is_bilateral = sum.is_bilateral && part.is_bilateral;
    sum.is_concurrent = sum.is_concurrent && part.is_concurrent;
  }
  for (std::size_t c = sum.channels.size(); c < weights.front().size(); ++c)
    sum.channels.push_back(std::to_string(c + 1));
  const auto channels = static_cast<Index>(sum.channels.size());
  sum.at = [parts = std::move(parts), weights = std::move(weights), channels](std::span<const Directions> pairs) {
    const auto rows = static_cast<Index>(pairs.size());
    BrdfValues values{Eigen::MatrixXd::Zero(rows, channels), Eigen::MatrixXd::Zero(rows, channels)};
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const BrdfValues part = parts[i].at(pairs);
      for (Index c = 0; c < channels; ++c) {
        const double weight = weights[i][weights[i].size() == 1 ? 0 : static_cast<std::size_t>(c)];
        if (weight == 0) continue;
        const Index own = part.value.cols() == 1 ? 0 : c;
        values.value.col(c) += weight * part.value.col(own);
        if (part.error.size() > 0) values.error.col(c) += std::abs(weight) * part.error.col(own);
      }
    }
    return values;
  };
  return sum;
}

/// Targets of an approximation, and how products with them are taken.
struct Targets {
  std::vector<std::string> names;
  /// Products of reflectances and, behind them, all targets.
  std::function<MetricResult(std::span<const Reflectance>)> measure_with;
  /// sum x_i a_i of a basis that has others than formulas.
  std::function<Reflectance(std::span<const Reflectance>, std::span<const VectorXd>, std::string)> combine = {};
  /// Whether those among the materials are better taken by their formulas: the rule for measurements is rougher.
  bool has_rough_products = false;

  RouteChoice choice = {};
  bool is_coarse = false;
};

Targets targets_of(const Device& device, std::vector<Material> targets, const Lighting& lighting,
                   const MetricOptions& options) {
  Targets result;
  for (const auto& target : targets) result.names.push_back(target.name);
  result.measure_with = [&device, &options, targets = std::move(targets),
                         lighting](std::span<const Reflectance> basis) {
    std::vector<Material> all = formulas_of(basis);
    all.insert(all.end(), targets.begin(), targets.end());
    return measure_formulas(device, all, lighting, options);
  };
  return result;
}

Targets targets_of(const Device& device, const BrdfFunction& target, const Lighting& lighting,
                   const MetricOptions& options) {
  const auto functions_of = [&device](std::span<const Reflectance> basis) {
    std::vector<BrdfFunction> functions;
    for (const Reflectance& one : basis) functions.push_back(function_of(device, one));
    return functions;
  };
  Targets result{
      .names = {target.name}, .measure_with = {}, .has_rough_products = true, .choice = {Route::functions, {}}};
  result.measure_with = [&options, functions_of, target, lighting](std::span<const Reflectance> basis) {
    std::vector<BrdfFunction> all = functions_of(basis);
    all.push_back(target);
    return measure_functions(all, lighting,
                             {.tolerance = options.function_tolerance,
                              .channel_weights = options.channel_weights,
                              .theta_max = options.theta_max,
                              .progress = options.progress});
  };
  result.combine = [functions_of](std::span<const Reflectance> basis, std::span<const VectorXd> coefficients,
                                  std::string name) {
    return combined_function(functions_of(basis), weights_of(coefficients), std::move(name));
  };
  return result;
}

Targets targets_of(const Device& device, BrdfTable target, const Lighting& lighting, const MetricOptions& options) {
  Targets result{.names = {target.expression},
                 .measure_with = {},
                 .choice = {Route::tables, target.grid},
                 .is_coarse = target.is_unresolved};
  const auto own = std::make_shared<const BrdfTable>(std::move(target));
  const auto tables_of = [&device, &options, own](std::span<const Reflectance> basis) {
    const TabulateOptions tabulation{.precision = options.precision,
                                     .allow_unresolved = options.allow_unresolved,
                                     .form = own->form,
                                     .cell_points = options.cell_points,
                                     .progress = options.progress};
    std::vector<BrdfTable> tables;
    for (const Reflectance& one : basis) tables.push_back(table_on(device, one, own->grid, tabulation));
    return tables;
  };
  result.measure_with = [&device, &options, lighting, own, tables_of](std::span<const Reflectance> basis) {
    const std::vector<BrdfTable> tables = tables_of(basis);
    std::vector<const BrdfTable*> all;
    for (const auto& table : tables) all.push_back(&table);
    all.push_back(own.get());
    return measure_tables(
        device, all, lighting,
        {.channel_weights = options.channel_weights, .theta_max = options.theta_max, .progress = options.progress});
  };
  result.combine = [tables_of](std::span<const Reflectance> basis, std::span<const VectorXd> coefficients,
                               std::string name) {
    BrdfTable sum = mix_channels(weights_of(coefficients), tables_of(basis));
    sum.expression = std::move(name);
    return sum;
  };
  return result;
}

/// All targets in one where all are formulas, else each by itself.
std::vector<Targets> targets_of(const Device& device, const ReflectanceList& targets,
                                std::span<const Reflectance> basis, const Lighting& lighting,
                                const MetricOptions& options) {
  if (targets.empty()) throw ArgumentError("no target to approximate; expected at least one");
  const auto choice_with = [&](const Reflectance& target) {
    std::vector<Reflectance> all{target};
    all.insert(all.end(), basis.begin(), basis.end());
    return choose_route(all, lighting, options);
  };
  std::vector<Material> formulas;
  std::vector<Targets> others;
  // A grid may be too coarse for a target, which the result says.
  const TabulateOptions tabulation{.precision = options.precision,
                                   .allow_unresolved = true,
                                   .cell_points = options.cell_points,
                                   .progress = options.progress};
  for (const Reflectance& given : targets) {
    const Reflectance target = adjusted(device, given);
    const RouteChoice choice = choice_with(target);
    if (choice.route == Route::formulas) {
      formulas.push_back(*target.formula());
    } else if (choice.route == Route::tables) {
      others.push_back(targets_of(device, table_on(device, target, *choice.grid, tabulation), lighting, options));
    } else {
      others.push_back(targets_of(device, function_of(device, target), lighting, options));
    }
  }
  if (formulas.empty()) return others;
  if (!others.empty() || formulas.size() != targets.size()) {
    throw ArgumentError("targets that are formulas and others are approximated one by one; expected one kind");
  }
  return {targets_of(device, std::move(formulas), lighting, options)};
}

/// Puts the products of the first materials by their formulas in place of the rough ones.
void take_products(MetricResult& rough, const Device& device, std::span<const Reflectance> basis,
                   MetricOptions options) {
  if (!are_formulas(basis)) return;
  const std::vector<Material> materials = formulas_of(basis);
  if (choose_route(materials, rough.lighting, options).route != Route::formulas) return;
  const std::vector<double> weights = std::exchange(options.channel_weights, {});
  const MetricResult exact = measure_formulas(device, materials, rough.lighting, options);
  const auto k = static_cast<Index>(materials.size());
  const auto take = [k](Metric& metric, const Eigen::MatrixXd& gram, const Eigen::MatrixXd& error) {
    metric.gram.topLeftCorner(k, k) = gram;
    metric.gram_error.topLeftCorner(k, k) = error;
  };
  const std::size_t channels = std::max<std::size_t>(1, rough.channels.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(k, k);
  Eigen::MatrixXd error = Eigen::MatrixXd::Zero(k, k);
  for (std::size_t c = 0; c < channels; ++c) {
    const Metric& channel = exact.channels.empty() ? exact.combined : exact.channels[c];
    const double weight = weights.empty() ? 1.0 / static_cast<double>(channels) : weights[c];
    gram += weight * channel.gram;
    error += weight * channel.gram_error;
    if (!rough.channels.empty()) take(rough.channels[c], channel.gram, channel.gram_error);
  }
  take(rough.combined, gram, error);
  rough.unresolved = exact.unresolved;
}

/// Products of the basis and all targets, and what approximations of them share.
class Measured {
 public:
  Measured(const Device& device, Targets targets, std::span<const Reflectance> basis, const Lighting& lighting,
           const ApproximationOptions& options)
      : targets_(std::move(targets)), basis_(basis), options_(options) {
    if (basis.empty()) throw ArgumentError("an approximation has no basis; expected at least one material");
    if (count() == 0) throw ArgumentError("no target to approximate; expected at least one material");
    result_ = targets_.measure_with(basis);
    if (targets_.has_rough_products) take_products(result_, device, basis, options.metric);
    for (std::size_t t = 0; t < count(); ++t) {
      if (result_.combined.gram(row(t), row(t)) > 0) continue;
      throw NumericError("'" + targets_.names[t] + "' has norm 0 under lighting '" + lighting.name() +
                         "'; expected a target that is not black");
    }
    bounds_ = albedo_bounds(device, basis, systems(result_, options.channels).size(), options);
  }

  /// Number of targets.
  [[nodiscard]] std::size_t count() const { return targets_.names.size(); }

  /// One per system.
  [[nodiscard]] std::vector<ApproximationProblem> problems(std::size_t target) const {
    std::vector<ApproximationProblem> problems;
    for (const Metric* metric : systems(result_, options_.channels)) {
      problems.push_back(problem_of(*metric, basis_, row(target)));
      const auto c = static_cast<Index>(problems.size()) - 1;
      if (bounds_.largest.size() == 0) continue;
      problems.back().largest_albedo = bounds_.largest.col(c);
      problems.back().largest_albedo_error = bounds_.error.col(c);
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
                                                  const std::vector<std::vector<Reflectance>>& chosen) const {
    std::vector<Reflectance> approximations;
    for (std::size_t t = 0; t < count(); ++t) {
      std::vector<VectorXd> coefficients;
      for (const auto& fit : fits[t]) coefficients.push_back(fit.coefficients);
      const std::string name = "approximation of " + targets_.names[t];
      approximations.push_back(are_formulas(chosen[t])
                                   ? Reflectance(linear_combination(formulas_of(chosen[t]), coefficients, name))
                                   : targets_.combine(chosen[t], coefficients, name));
    }
    const auto check = targets_.measure_with(approximations);
    const auto measured = systems(check, options_.channels);
    const std::vector<double> weights = this->weights();
    std::vector<Approximation> list;
    for (std::size_t t = 0; t < count(); ++t) {
      const auto i = static_cast<Index>(t);
      const auto j = static_cast<Index>(count() + t);
      const auto residual = [&](const Metric& metric) {
        return Estimate{metric.distance(i, j), metric.distance_error(i, j)};
      };
      const auto norm = [&](const Metric& metric) { return Estimate{metric.norm(j), metric.norm_error(j)}; };
      Approximation approximation{.lighting = result_.lighting,
                                  .material = {},
                                  .combination = approximations[t],
                                  .fits = std::move(fits[t]),
                                  .target_norm = {},
                                  .residual = {},
                                  .relative_residual = {},
                                  .tolerance = result_.tolerance,
                                  .unresolved = {},
                                  .route = targets_.choice.route,
                                  .grid = targets_.choice.grid,
                                  .is_coarse = targets_.is_coarse};
      if (const Material* material = approximation.combination.formula()) approximation.material = *material;
      for (std::size_t c = 0; c < approximation.fits.size(); ++c) {
        LinearFit& fit = approximation.fits[c];
        fit.residual = residual(*measured[c]);
        fit.residual.error += fall_of(fit.residual, fit.energy_slack);
        const Estimate size = norm(*measured[c]);
        fit.relative_residual = size.value > 0 ? fit.residual / size : Estimate{};
      }
      approximation.target_norm = norm(check.combined);
      approximation.residual = residual(check.combined);
      double slack = 0;
      for (std::size_t c = 0; c < approximation.fits.size(); ++c) {
        slack += weights[c] * approximation.fits[c].energy_slack;
      }
      approximation.residual.error += fall_of(approximation.residual, slack);
      approximation.relative_residual = approximation.residual / approximation.target_norm;
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

  Targets targets_;
  std::span<const Reflectance> basis_;
  const ApproximationOptions& options_;
  MetricResult result_;
  AlbedoBounds bounds_;
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

namespace {

std::vector<Reflectance> adjusted_basis(const Device& device, const ReflectanceList& basis) {
  std::vector<Reflectance> all;
  for (const Reflectance& one : basis) all.push_back(adjusted(device, one));
  return all;
}

std::vector<Approximation> approximations_of(const Measured& measured, std::span<const Reflectance> basis,
                                             const ApproximationForm& form) {
  std::vector<std::vector<LinearFit>> fits(measured.count());
  for (std::size_t t = 0; t < fits.size(); ++t) {
    for (const auto& problem : measured.problems(t)) fits[t].push_back(best_of_channel(problem, form));
  }
  const std::vector<std::vector<Reflectance>> chosen(fits.size(), {basis.begin(), basis.end()});
  return measured.finish(std::move(fits), chosen);
}

std::vector<GreedyApproximation> greedy_of(const Measured& measured, std::span<const Reflectance> candidates,
                                           std::size_t count, const ApproximationForm& form) {
  std::vector<GreedyApproximation> list(measured.count());
  std::vector<std::vector<LinearFit>> fits;
  std::vector<std::vector<Reflectance>> chosen(list.size());
  for (std::size_t t = 0; t < list.size(); ++t) {
    GreedyBasis greedy = greedy_combination(measured.problems(t), measured.weights(), count, form);
    list[t].steps = std::move(greedy.steps);
    fits.push_back(std::move(greedy.fits));
    for (const auto& step : list[t].steps) chosen[t].push_back(candidates[step.chosen]);
  }
  auto approximations = measured.finish(std::move(fits), chosen);
  for (std::size_t t = 0; t < list.size(); ++t) list[t].approximation = std::move(approximations[t]);
  return list;
}

}  // namespace

std::vector<Approximation> approximate(const Device& device, const ReflectanceList& targets,
                                       const ReflectanceList& basis, const Lighting& lighting,
                                       const ApproximationOptions& options) {
  std::vector<Approximation> list;
  const std::vector<Reflectance> own = adjusted_basis(device, basis);
  for (Targets& part : targets_of(device, targets, own, lighting, options.metric)) {
    const Measured measured(device, std::move(part), own, lighting, options);
    std::ranges::move(approximations_of(measured, own, options.form), std::back_inserter(list));
  }
  return list;
}

Approximation approximate(const Device& device, const Reflectance& target, const ReflectanceList& basis,
                          const Lighting& lighting, const ApproximationOptions& options) {
  return std::move(approximate(device, ReflectanceList{target}, basis, lighting, options).front());
}

std::vector<GreedyApproximation> greedy_basis(const Device& device, const ReflectanceList& targets,
                                              const ReflectanceList& candidates, std::size_t count,
                                              const Lighting& lighting, const ApproximationOptions& options) {
  std::vector<GreedyApproximation> list;
  const std::vector<Reflectance> own = adjusted_basis(device, candidates);
  for (Targets& part : targets_of(device, targets, own, lighting, options.metric)) {
    const Measured measured(device, std::move(part), own, lighting, options);
    std::ranges::move(greedy_of(measured, own, count, options.form), std::back_inserter(list));
  }
  return list;
}

GreedyApproximation greedy_basis(const Device& device, const Reflectance& target, const ReflectanceList& candidates,
                                 std::size_t count, const Lighting& lighting, const ApproximationOptions& options) {
  return std::move(greedy_basis(device, ReflectanceList{target}, candidates, count, lighting, options).front());
}

}  // namespace lobe
