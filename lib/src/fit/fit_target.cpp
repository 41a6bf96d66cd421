#include "fit/fit_target.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "algebra/channel_mix.hpp"
#include "compare/comparison_routes.hpp"
#include "energy/albedo.hpp"
#include "fit/remembered.hpp"
#include "fit/unit_terms.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "metric/channel_metric.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/routes.hpp"
#include "metric/table_measure.hpp"
#include "model/evaluate.hpp"
#include "model/traits.hpp"
#include "model/values.hpp"
#include "table/as_function.hpp"
#include "table/evaluate.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

constexpr std::size_t kMostShapes = 32;

TargetDistances distances_of(const LiteratureResult& result) {
  const LiteratureMatrix& matrix = result.combined;
  return {matrix.distance, matrix.distance_error, {matrix.size(0), matrix.size_error(0)}};
}

std::vector<Material> behind(const Material& target, std::span<const Material> materials) {
  std::vector<Material> list{target};
  list.insert(list.end(), materials.begin(), materials.end());
  return list;
}

/// How much work averages over cells may take in searches: they tell steps apart, which change a material by 1e-2 at
/// first and by 1e-3 at the end, and take long where a lobe ends in a jump.
CellEffort effort_for(double tolerance) {
  constexpr double kRough = 1e-4;
  constexpr std::size_t kRoughBudget = std::size_t{1} << 20U;
  CellEffort effort{.tolerance = std::min(tolerance, kRough)};
  if (tolerance >= kRough) effort.budget = kRoughBudget;
  return effort;
}
// Averages over cells may have these shares of the tolerance of distances: by scalar products, and by logarithms, whose
// searches begin with a larger one.
constexpr double kCellShare = 0.1;
constexpr double kLogCellShare = 0.01;

/// A material on the grid of a target.
/// \throws UnresolvedError
BrdfTable table_beside(const Device& device, const BrdfTable& target, const Material& material, Precision precision,
                       const CellEffort& effort) {
  auto table =
      tabulate_if_resolved(device, material, target.grid, {.precision = precision, .form = target.form}, effort);
  if (!table) throw UnresolvedError("grid " + target.grid.name() + " does not resolve '" + material.name + "'");
  return *std::move(table);
}

/// How many tables beside the target are held at a time; each is there twice.
std::size_t tables_at_once(const BrdfTable& target) {
  constexpr std::size_t kBytes = std::size_t{512} << 20;
  constexpr std::size_t kFewest = 8;
  const std::size_t bytes = 2 * sizeof(double) * std::max<std::size_t>(1, target.size());
  return std::clamp(kBytes / bytes, kFewest, kMostShapes);
}

/// The products of a target and materials from those of the target and the materials' terms.
MetricResult metric_of_sums(const UnitTerms& terms, std::span<const ChannelProducts> products,
                            std::span<const double> weights) {
  std::vector<ChannelProducts> channels;
  ChannelProducts combined;
  for (std::size_t c = 0; c < terms.factors.size(); ++c) {
    channels.push_back(products_of_sums(products[c], terms.factors[c]));
    const ChannelProducts& channel = channels.back();
    if (c == 0) {
      const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(channel.gram.rows(), channel.gram.cols());
      combined = {zero, zero, zero, zero};
    }
    combined.gram += weights[c] * channel.gram;
    combined.gram_error += weights[c] * channel.gram_error;
    combined.squared_distance += weights[c] * channel.squared_distance;
    combined.squared_distance_error += weights[c] * channel.squared_distance_error;
  }
  channels.push_back(std::move(combined));
  return metric_of(std::move(channels));
}

/// Tables of terms beside a target. As many as memory allows are kept: searches ask for some of them again.
class TermTables {
 public:
  TermTables(const Device& device, const BrdfTable& target, Precision precision)
      : device_(device), target_(target), precision_(precision) {}

  /// \param terms of scale 1
  /// \param tolerance of averages over cells
  /// \throws UnresolvedError
  [[nodiscard]] std::vector<std::shared_ptr<const BrdfTable>> of(std::span<const Material> terms, double tolerance) {
    if (tolerance != tolerance_) kept_.clear();
    tolerance_ = tolerance;
    std::vector<std::shared_ptr<const BrdfTable>> tables;
    for (const Material& term : terms) tables.push_back(table_of(term));
    return tables;
  }

 private:
  struct Kept {
    Term term;
    std::shared_ptr<const BrdfTable> table;
  };

  /// The one that was asked for last comes last.
  [[nodiscard]] std::shared_ptr<const BrdfTable> table_of(const Material& material) {
    const Term& term = material.terms.front();
    const auto known = std::ranges::find_if(kept_, [&](const Kept& kept) { return are_alike(kept.term, term); });
    if (known != kept_.end()) {
      std::rotate(known, known + 1, kept_.end());
    } else {
      BrdfTable table = table_beside(device_, target_, material, precision_, effort_for(tolerance_));
      kept_.push_back({term, std::make_shared<const BrdfTable>(std::move(table))});
    }
    std::shared_ptr<const BrdfTable> wanted = kept_.back().table;
    constexpr std::size_t kBytes = std::size_t{256} << 20;
    const std::size_t most =
        std::max<std::size_t>(1, kBytes / (sizeof(double) * std::max<std::size_t>(1, target_.size())));
    if (kept_.size() > most) kept_.erase(kept_.begin());
    return wanted;
  }

  const Device& device_;
  const BrdfTable& target_;
  Precision precision_;
  double tolerance_ = 0;  ///< of those that are kept
  std::vector<Kept> kept_;
};

/// Materials on the grid of a target as sums of the terms that they have.
std::vector<BrdfTable> tables_of_sums(const UnitTerms& terms, const BrdfTable& target, TermTables& term_tables,
                                      double tolerance) {
  const auto tables = term_tables.of(terms.terms, tolerance);
  std::vector<BrdfTable> sums;
  for (Eigen::Index member = 0; member < terms.factors.front().rows(); ++member) {
    std::vector<BrdfTable> parts;
    std::vector<std::vector<double>> weights;
    for (std::size_t k = 0; k < tables.size(); ++k) {
      std::vector<double> weight;
      for (const Eigen::MatrixXd& factors : terms.factors) {
        weight.push_back(factors(member, static_cast<Eigen::Index>(k)));
      }
      if (std::ranges::all_of(weight, [](double w) { return w == 0; })) continue;
      parts.push_back(*tables[k]);
      weights.push_back(std::move(weight));
    }
    sums.push_back(parts.empty() ? scale(target, 0) : mix_channels(weights, parts, true));
  }
  return sums;
}

}  // namespace

TargetDistances distances_of(const MetricResult& result) {
  const Metric& metric = result.combined;
  return {metric.distance, metric.distance_error, {metric.norm(0), metric.norm_error(0)}};
}

FitTarget fit_target(const Device& device, const Material& target, const FitOptions& options,
                     const ProgressCallback& progress) {
  const auto products_under = [&, progress](const Lighting& lighting) {
    return [&, progress, lighting](std::span<const Material> materials, double tolerance) {
      const MetricOptions metric{.tolerance = tolerance,
                                 .patch_tolerance = std::max(tolerance, MetricOptions{}.patch_tolerance),
                                 .precision = options.precision,
                                 .channel_weights = options.channel_weights,
                                 .theta_max = options.theta_max,
                                 .progress = progress};
      return measure_formulas(device, behind(target, materials), lighting, metric);
    };
  };
  // Patch lights cost far more than point light, which has no norms of delta parts.
  const auto rough_products = [&, exact = products_under(options.lighting), rough = products_under(Lighting::point())](
                                  std::span<const Material> materials, double tolerance) {
    const auto is_delta = [](const Term& term) { return traits_of(term).has_delta; };
    const auto holds_delta = [&](const Material& material) { return std::ranges::any_of(material.terms, is_delta); };
    const bool has_delta = holds_delta(target) || std::ranges::any_of(materials, holds_delta);
    const bool is_rough = traits_of(options.lighting).has_patch_tolerance && !has_delta;
    return is_rough ? rough(materials, tolerance) : exact(materials, tolerance);
  };
  return {.name = target.name,
          .channels = target.channels(),
          .is_isotropic = is_isotropic(target),
          .most_shapes = kMostShapes,
          .products = products_under(options.lighting),
          .rough_products = rough_products,
          .compared =
              [&, progress](std::span<const Material> materials, double tolerance) {
                const LiteratureOptions comparison{.tolerance = tolerance,
                                                   .precision = options.precision,
                                                   .channel_weights = options.channel_weights,
                                                   .progress = progress};
                return distances_of(compare_formulas(device, behind(target, materials), options.metric, comparison));
              },
          .values =
              [&](std::span<const Directions> directions) {
                return estimates({unchecked_values(device, target, directions, options.precision), {}});
              },
          .albedos =
              [&](std::span<const Direction> directions) {
                return albedo(device, target, directions, {.precision = options.precision});
              }};
}

FitTarget fit_target(const Device& device, const BrdfFunction& target, const FitOptions& options,
                     const ProgressCallback& progress) {
  constexpr std::size_t kRemembered = std::size_t{256} << 20;
  const auto measured = [&, progress, known = remembered(target, kRemembered)](std::span<const Material> materials,
                                                                               NodeMaking making) {
    std::vector<BrdfFunction> list{known};
    for (const Material& material : materials) {
      list.push_back(kept_function(device, material, Precision::double_precision, making));
    }
    // Searches are long: what the first two levels of quadrature give must do.
    return measure_functions(list, options.lighting,
                             {.tolerance = 0.1,
                              .channel_weights = options.channel_weights,
                              .theta_max = options.theta_max,
                              .progress = progress});
  };
  const auto rough_products = [&, measured](std::span<const Material> materials, double) {
    const UnitTerms terms = unit_terms(materials, target.channels.size());
    const MetricResult metric = measured(terms.terms, NodeMaking::quickly);
    std::vector<ChannelProducts> channels;
    for (const Metric& channel : metric.channels) channels.push_back(products_of(channel));
    if (!channels.empty()) {
      return metric_of_sums(terms, channels, channel_weights(options.channel_weights, channels.size()));
    }
    // Those of a single channel have its weight already.
    channels.push_back(products_of(metric.combined));
    return metric_of_sums(terms, channels, std::array{1.0});
  };
  // What is measured alone is a result.
  const auto products = [measured, rough_products](std::span<const Material> materials, double tolerance) {
    return materials.size() == 1 ? measured(materials, NodeMaking::closely) : rough_products(materials, tolerance);
  };
  return {.name = target.name,
          .channels = target.channels.size(),
          .is_isotropic = target.is_isotropic,
          .most_shapes = kMostShapes,
          .products = products,
          .rough_products = rough_products,
          .compared = {},
          .values = [&](std::span<const Directions> directions) { return estimates(target.at(directions)); },
          .albedos = [&](std::span<const Direction> directions) { return albedo(target, directions); }};
}

FitTarget fit_target(const Device& device, const BrdfTable& target, const FitOptions& options,
                     const ProgressCallback& progress) {
  const auto term_tables = std::make_shared<TermTables>(device, target, options.precision);
  const auto result = [&](const Material& material) {
    return tabulate(device, material, target.grid, {.precision = options.precision, .form = target.form});
  };
  const auto rough_products = [&, progress, term_tables](std::span<const Material> materials, double tolerance) {
    const UnitTerms terms = unit_terms(materials, target.channels);
    std::vector<const BrdfTable*> tables{&target};
    const auto kept = term_tables->of(terms.terms, kCellShare * tolerance);
    for (const auto& table : kept) tables.push_back(table.get());
    const TableMetricOptions metric{.theta_max = options.theta_max, .progress = progress};
    return metric_of_sums(terms, products_of_tables(device, tables, options.lighting, metric),
                          channel_weights(options.channel_weights, target.channels));
  };
  // What is measured alone is a result.
  const auto products = [&, progress, result, rough_products](std::span<const Material> materials, double tolerance) {
    if (materials.size() > 1) return rough_products(materials, tolerance);
    const BrdfTable member = result(materials.front());
    const TableMetricOptions metric{
        .channel_weights = options.channel_weights, .theta_max = options.theta_max, .progress = progress};
    return measure_tables(device, std::array{&target, &member}, options.lighting, metric);
  };
  const auto compared = [&, progress, result, term_tables](std::span<const Material> materials, double tolerance) {
    const LiteratureOptions comparison{
        .tolerance = tolerance, .channel_weights = options.channel_weights, .progress = progress};
    const UnitTerms terms = unit_terms(materials, target.channels);
    std::vector<BrdfTable> members;
    if (materials.size() == 1) {
      members.push_back(result(materials.front()));
    } else {
      members = tables_of_sums(terms, target, *term_tables, kLogCellShare * tolerance);
    }
    std::vector<const BrdfTable*> tables{&target};
    for (const BrdfTable& member : members) tables.push_back(&member);
    return distances_of(compare_tables(tables, options.metric, comparison));
  };
  return {.name = target.expression,
          .channels = target.channels,
          .is_isotropic = target.form == TableForm::isotropic,
          .most_shapes = tables_at_once(target),
          .products = products,
          .rough_products = rough_products,
          .compared = compared,
          .values = [&](std::span<const Directions> directions) { return evaluate(target, directions); },
          .albedos = [&](std::span<const Direction> directions) { return albedo(target, directions); },
          .refusal = [result](const Material& material) -> std::optional<std::string> {
            try {
              (void)result(material);
              return std::nullopt;
            } catch (const UnresolvedError& error) {
              return error.what();
            }
          }};
}

}  // namespace lobe
