// Which route distances of the literature are computed by.
#include "compare/compare.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "compare/comparison_routes.hpp"
#include "lobe/core/error.hpp"
#include "metric/routes.hpp"
#include "table/mixed_channels.hpp"

namespace lobe {

RouteChoice choose_route(const ReflectanceList& reflectances, const LiteratureOptions& options) {
  const bool has_functions = std::ranges::all_of(reflectances, is_function);
  const bool is_isotropic = std::ranges::all_of(reflectances, &Reflectance::is_isotropic);
  const bool has_formulas = std::ranges::all_of(reflectances, is_formula) && (is_isotropic || !has_functions);
  const Route route = options.route != Route::automatic
                          ? options.route
                          : best_route(options.grid.has_value(), has_formulas, has_functions);
  if (route == Route::formulas && !has_formulas) {
    throw ArgumentError("the route 'formulas' of comparisons takes isotropic formulas alone");
  }
  if (route != Route::tables) return {route, {}};
  return {route, options.grid ? *options.grid : common_grid(reflectances)};
}

LiteratureResult compare(RoutedSet& set, LiteratureMetric comparison, const LiteratureOptions& options,
                         const TileStore* store) {
  set.require_some();
  RouteChoice choice = choose_route(set.reflectances(), options);
  if (!options.grid) choice = set.refined(std::move(choice));
  const auto by_route = [&] {
    if (choice.route == Route::formulas) {
      const bool has_tiles = comparison_tiles(set.reflectances().size()).size() > 1;
      return compare_formulas(set.device(), set.formulas(), comparison, options, has_tiles ? store : nullptr);
    }
    if (choice.route == Route::functions) return compare_functions(set.functions(), comparison, options);
    const auto all = set.tables(*choice.grid);
    std::size_t channels = 1;
    for (const BrdfTable* table : all) channels = std::max(channels, table->channels);
    std::vector<BrdfTable> widened;
    widened.reserve(all.size());
    std::vector<const BrdfTable*> comparable;
    for (const BrdfTable* table : all) {
      if (table->channels == 1 && channels > 1) {
        widened.push_back(mixed_channels(*table, Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(channels), 1)));
        table = &widened.back();
      }
      comparable.push_back(table);
    }
    return compare_tables(comparable, comparison, options);
  };
  LiteratureResult result = by_route();
  result.route = choice.route;
  result.grid = choice.grid;
  return result;
}

std::vector<ComparisonTile> independent_tiles(const RoutedSet& set, const LiteratureOptions& options) {
  const std::size_t materials = set.reflectances().size();
  if (materials == 0 || choose_route(set.reflectances(), options).route != Route::formulas) return {};
  auto tiles = comparison_tiles(materials);
  if (tiles.size() == 1) tiles.clear();
  return tiles;
}

TileIntegrals compare_tile(RoutedSet& set, const ComparisonTile& tile, LiteratureMetric comparison,
                           const LiteratureOptions& options) {
  return compare_tile(set.device(), set.formulas(), tile, comparison, options);
}

LiteratureResult compare(const Device& device, const ReflectanceList& reflectances, LiteratureMetric comparison,
                         const LiteratureOptions& options) {
  const MetricOptions tabulation{
      .precision = options.precision, .progress = options.progress, .allow_unresolved = options.allow_unresolved};
  RoutedSet set(device, reflectances, tabulation);
  return compare(set, comparison, options);
}

std::vector<LiteratureResult> compare(const Device& device, const ReflectanceList& reflectances,
                                      std::span<const std::string> names, const LiteratureOptions& options) {
  std::vector<LiteratureMetric> comparisons;
  for (const auto& name : names) comparisons.push_back(parse_literature_metric(name));
  const MetricOptions tabulation{
      .precision = options.precision, .progress = options.progress, .allow_unresolved = options.allow_unresolved};
  RoutedSet set(device, reflectances, tabulation);
  std::vector<LiteratureResult> results;
  for (const LiteratureMetric comparison : comparisons) results.push_back(compare(set, comparison, options));
  return results;
}

}  // namespace lobe
