#include "fit/fit_target.hpp"

#include <algorithm>
#include <utility>

#include "compare/comparison_routes.hpp"
#include "energy/albedo.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/routes.hpp"
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

/// The target and the materials on its grid.
/// \throws NumericError where that does not resolve one
std::vector<BrdfTable> tables_behind(const Device& device, const BrdfTable& target, std::span<const Material> materials,
                                     Precision precision) {
  std::vector<BrdfTable> list{target};
  const TabulateOptions options{.precision = precision, .form = target.form};
  for (const Material& material : materials) list.push_back(tabulate(device, material, target.grid, options));
  return list;
}

std::vector<const BrdfTable*> pointers_to(std::span<const BrdfTable> tables) {
  std::vector<const BrdfTable*> pointers;
  for (const BrdfTable& table : tables) pointers.push_back(&table);
  return pointers;
}

/// How many tables beside the target are held at a time; each is there twice.
std::size_t tables_at_once(const BrdfTable& target) {
  constexpr std::size_t kBytes = std::size_t{512} << 20;
  constexpr std::size_t kFewest = 8;
  const std::size_t bytes = 2 * sizeof(double) * std::max<std::size_t>(1, target.size());
  return std::clamp(kBytes / bytes, kFewest, kMostShapes);
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
  const auto products = [&, progress](std::span<const Material> materials, double) {
    std::vector<BrdfFunction> list{target};
    for (const Material& material : materials) list.push_back(as_function(device, material));
    // Searches are long: what the first two levels of quadrature give must do.
    return measure_functions(list, options.lighting,
                             {.tolerance = 0.1,
                              .channel_weights = options.channel_weights,
                              .theta_max = options.theta_max,
                              .progress = progress});
  };
  return {.name = target.name,
          .channels = target.channels.size(),
          .is_isotropic = target.is_isotropic,
          .most_shapes = kMostShapes,
          .products = products,
          .rough_products = products,
          .compared = {},
          .values = [&](std::span<const Directions> directions) { return estimates(target.at(directions)); },
          .albedos = [&](std::span<const Direction> directions) { return albedo(target, directions); }};
}

FitTarget fit_target(const Device& device, const BrdfTable& target, const FitOptions& options,
                     const ProgressCallback& progress) {
  const auto products = [&, progress](std::span<const Material> materials, double) {
    const TableMetricOptions metric{
        .channel_weights = options.channel_weights, .theta_max = options.theta_max, .progress = progress};
    const auto tables = tables_behind(device, target, materials, options.precision);
    return measure_tables(device, pointers_to(tables), options.lighting, metric);
  };
  return {.name = target.expression,
          .channels = target.channels,
          .is_isotropic = target.form == TableForm::isotropic,
          .most_shapes = tables_at_once(target),
          .products = products,
          .rough_products = products,
          .compared =
              [&, progress](std::span<const Material> materials, double tolerance) {
                const LiteratureOptions comparison{
                    .tolerance = tolerance, .channel_weights = options.channel_weights, .progress = progress};
                const auto tables = tables_behind(device, target, materials, options.precision);
                return distances_of(compare_tables(pointers_to(tables), options.metric, comparison));
              },
          .values = [&](std::span<const Directions> directions) { return evaluate(target, directions); },
          .albedos = [&](std::span<const Direction> directions) { return albedo(target, directions); }};
}

}  // namespace lobe
