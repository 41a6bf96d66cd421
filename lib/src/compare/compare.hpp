#pragma once

#include <vector>

#include "compare/comparison_tiles.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "metric/routed_set.hpp"

namespace lobe {

/// compare() of a set, by the route of `options`, whatever the set's own are.
/// \param store provides tiles and keeps others, where independent_tiles() has any; null: all are computed
[[nodiscard]] LiteratureResult compare(RoutedSet& set, LiteratureMetric comparison, const LiteratureOptions& options,
                                       const TileStore* store = nullptr);

/// Tiles that compare() computes independently of each other; none where it computes all pairs at once.
/// \throws as choose_route()
[[nodiscard]] std::vector<ComparisonTile> independent_tiles(const RoutedSet& set, const LiteratureOptions& options);

/// Computes a tile of independent_tiles().
/// \throws as compare()
[[nodiscard]] TileIntegrals compare_tile(RoutedSet& set, const ComparisonTile& tile, LiteratureMetric comparison,
                                         const LiteratureOptions& options);

}  // namespace lobe
