#pragma once

#include <cstddef>
#include <span>

#include "compare/comparison_tiles.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

// compare() by each of its routes; options.route and options.grid have no effect.

/// \param materials prepared
/// \param store provides tiles and keeps others; null: all are computed
[[nodiscard]] LiteratureResult compare_formulas(const Device& device, std::span<const Material> materials,
                                                LiteratureMetric comparison, const LiteratureOptions& options = {},
                                                const TileStore* store = nullptr,
                                                std::size_t most_in_tile = kTileMaterials);

/// Computes a tile of comparison_tiles() as compare_formulas() does.
/// \param materials of the whole set, prepared
[[nodiscard]] TileIntegrals compare_tile(const Device& device, std::span<const Material> materials,
                                         const ComparisonTile& tile, LiteratureMetric comparison,
                                         const LiteratureOptions& options);

[[nodiscard]] LiteratureResult compare_functions(std::span<const BrdfFunction> functions, LiteratureMetric comparison,
                                                 const LiteratureOptions& options = {});

/// \param tables on one grid
[[nodiscard]] LiteratureResult compare_tables(std::span<const BrdfTable* const> tables, LiteratureMetric comparison,
                                              const LiteratureOptions& options = {});

}  // namespace lobe
