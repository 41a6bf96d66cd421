// Metrics of the literature, of materials.
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/comparison_integrator.hpp"
#include "compare/comparison_measure.hpp"
#include "compare/comparison_refinement.hpp"
#include "compare/comparison_result.hpp"
#include "compare/comparison_routes.hpp"
#include "compare/comparison_tiles.hpp"
#include "core/stopwatch.hpp"
#include "device/rounding.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "metric/products.hpp"
#include "model/lobes.hpp"

namespace lobe {
namespace {

std::size_t channels_of(std::span<const Material> materials) {
  std::size_t channels = 1;
  for (const auto& material : materials) channels = std::max(channels, material.channels());
  return channels;
}

/// Weights for a tile, whose materials may have one channel where others of the set have more.
std::vector<double> tile_weights(const std::vector<double>& weights, std::size_t channels) {
  if (channels == weights.size()) return weights;
  return {std::accumulate(weights.begin(), weights.end(), 0.0)};
}

LobeSet tile_lobes(std::span<const Material> materials, const ComparisonTile& tile) {
  const auto part = [&](const MaterialRange& range) { return materials.subspan(range.first, range.size()); };
  if (tile.is_triangle()) return make_lobe_set(part(tile.rows));
  std::vector<Material> both(part(tile.rows).begin(), part(tile.rows).end());
  both.insert(both.end(), part(tile.columns).begin(), part(tile.columns).end());
  return make_lobe_set(both);
}

/// \param lobes of the tile's materials
/// \param weights of the channels of all materials
TileIntegrals integrate_tile(const Device& device, const LobeSet& lobes, const ComparisonTile& tile,
                             LiteratureMetric comparison, const std::vector<double>& weights,
                             const LiteratureOptions& options, WorkDone& work) {
  const WorkDone before = work;
  const std::size_t split = tile.is_triangle() ? 0 : tile.rows.size();
  ComparisonIntegrator integrator(device, lobes, split, comparison, options, work);
  TileIntegrals integrals;
  integrals.channels = refined_integrals(integrator, comparison, tile_weights(weights, lobes.channels()), options);
  integrals.nodes = work.nodes - before.nodes;
  integrals.evaluations = work.evaluations - before.evaluations;
  return integrals;
}

}  // namespace

TileIntegrals compare_tile(const Device& device, std::span<const Material> materials, const ComparisonTile& tile,
                           LiteratureMetric comparison, const LiteratureOptions& options) {
  check(options);
  report_progress(options, comparison, 0);
  WorkDone work;
  const auto weights = comparison_weights(options, channels_of(materials));
  TileIntegrals integrals =
      integrate_tile(device, tile_lobes(materials, tile), tile, comparison, weights, options, work);
  report_progress(options, comparison, 1);
  return integrals;
}

LiteratureResult compare_formulas(const Device& device, std::span<const Material> materials,
                                  LiteratureMetric comparison, const LiteratureOptions& options, const TileStore* store,
                                  std::size_t most_in_tile) {
  check(options);
  report_progress(options, comparison, 0);
  const LobeSet lobes = make_lobe_set(materials);  // refuses what cannot be compared before any tile is computed
  const auto weights = comparison_weights(options, lobes.channels());
  std::vector<std::string> names;
  for (const auto& material : materials) names.push_back(material.name);

  WorkDone work;
  const auto tiles = comparison_tiles(materials.size(), most_in_tile);
  TiledIntegrals totals(materials.size(), lobes.channels());
  LiteratureOptions of_tile = options;
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    if (store != nullptr && store->has(k)) {
      const TileIntegrals known = store->get(k);
      work.nodes += known.nodes;
      work.evaluations += known.evaluations;
      totals.add(tiles[k], known);
      continue;
    }
    of_tile.progress = [&, k](std::string_view stage, double fraction) {
      const double done = (static_cast<double>(k) + fraction) / static_cast<double>(tiles.size());
      return !options.progress || options.progress(stage, done);
    };
    Stopwatch watch;
    const LobeSet own = tiles.size() == 1 ? lobes : tile_lobes(materials, tiles[k]);
    const TileIntegrals computed = integrate_tile(device, own, tiles[k], comparison, weights, of_tile, work);
    totals.add(tiles[k], computed);
    if (store != nullptr) store->keep(k, computed, watch.lap());
  }

  Stopwatch watch;
  const ComparisonRecipe recipe = recipe_of(comparison);
  for (auto& total : totals.channels()) {
    const Eigen::Index black = total.value.rows() - 1;
    for (Eigen::Index j = 0; j <= black; ++j) {
      for (Eigen::Index i = 0; i <= black; ++i) {
        const double value = total.value(i, j);
        if (value == 0) continue;  // identical materials, sample by sample
        total.error(i, j) += rounding_of_integral(recipe, value, total.value(i, black) + total.value(j, black),
                                                  product_rounding(options.precision) / 4);
      }
    }
  }
  LiteratureResult result = make_comparison_result(comparison, totals.channels(), names, options);
  work.seconds_host += watch.lap();
  result.work = work;
  report_progress(options, comparison, 1);
  return result;
}

}  // namespace lobe
