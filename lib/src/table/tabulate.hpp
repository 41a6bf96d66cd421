#pragma once

#include <optional>
#include <span>
#include <string>

#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"
#include "table/cell_average.hpp"

namespace lobe {

// Overloads of tabulate() for each kind of reflectance. They throw as the public function does.

/// \param material prepared
[[nodiscard]] BrdfTable tabulate(const Device& device, const Material& material, const HemisphereGrid& grid,
                                 const TabulateOptions& options = {});
/// The same, or nothing where the grid does not resolve a lobe, without looking for a grid that would, which takes
/// longer than the table.
/// \param effort for averages over cells
[[nodiscard]] std::optional<BrdfTable> tabulate_if_resolved(const Device& device, const Material& material,
                                                            const HemisphereGrid& grid, const TabulateOptions& options,
                                                            const CellEffort& effort);
/// Cells as they are on their own grid.
[[nodiscard]] BrdfTable tabulate(const BrdfFunction& brdf, const HemisphereGrid& grid,
                                 const TabulateOptions& options = {});
/// A table on another grid.
[[nodiscard]] BrdfTable resample(const BrdfTable& table, const HemisphereGrid& grid);

[[nodiscard]] HemisphereGrid natural_grid(const BrdfFunction& brdf);

/// A function as the table by which albedos of rows, samples and plausibility are told: on its natural_grid(), which
/// need not resolve it.
[[nodiscard]] BrdfTable natural_table(const BrdfFunction& brdf, const ProgressCallback& progress = {});

/// How well a grid resolves a function, as BrdfTable::resolution_error.
[[nodiscard]] double resolution_of(const BrdfFunction& brdf, const HemisphereGrid& grid, std::size_t points);

/// Grids that would resolve these, as texts for messages.
/// \param material prepared
[[nodiscard]] std::string resolution_needed(const Device& device, const Material& material, const HemisphereGrid& grid,
                                            const TabulateOptions& options);
[[nodiscard]] std::string resolution_needed(const BrdfFunction& brdf, const HemisphereGrid& grid,
                                            const TabulateOptions& options);

/// \param materials prepared
[[nodiscard]] HemisphereGrid choose_grid(const Device& device, std::span<const Material> materials,
                                         std::span<const BrdfFunction> functions, const TabulateOptions& options = {});

}  // namespace lobe
