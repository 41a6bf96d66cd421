#pragma once

#include <span>

#include "lobe/compare/literature_metric.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

// compare() by each of its routes; options.route and options.grid have no effect.

/// \param materials prepared
[[nodiscard]] LiteratureResult compare_formulas(const Device& device, std::span<const Material> materials,
                                                LiteratureMetric comparison, const LiteratureOptions& options = {});

[[nodiscard]] LiteratureResult compare_functions(std::span<const BrdfFunction> functions, LiteratureMetric comparison,
                                                 const LiteratureOptions& options = {});

/// \param tables on one grid
[[nodiscard]] LiteratureResult compare_tables(std::span<const BrdfTable* const> tables, LiteratureMetric comparison,
                                              const LiteratureOptions& options = {});

}  // namespace lobe
