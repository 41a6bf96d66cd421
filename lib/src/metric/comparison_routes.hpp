#pragma once

#include <span>

#include "lobe/device/device.hpp"
#include "lobe/metric/comparison.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

// compare() by each of its routes; options.route and options.grid have no effect.

/// \param materials prepared
[[nodiscard]] ComparisonResult compare_formulas(const Device& device, std::span<const Material> materials,
                                                Comparison comparison, const ComparisonOptions& options = {});

[[nodiscard]] ComparisonResult compare_functions(std::span<const BrdfFunction> functions, Comparison comparison,
                                                 const ComparisonOptions& options = {});

/// \param tables on one grid, of one form, all with as many channels
[[nodiscard]] ComparisonResult compare_tables(std::span<const BrdfTable* const> tables, Comparison comparison,
                                              const ComparisonOptions& options = {});

}  // namespace lobe
