#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"
#include "metric/slab_store.hpp"

namespace lobe {

/// Whether a reflectance is a function with values at any directions, or formulas that become one, for which no table
/// would do better.
[[nodiscard]] bool is_function(const Reflectance& reflectance);
[[nodiscard]] bool is_formula(const Reflectance& reflectance);

/// The route of a set of which these hold.
[[nodiscard]] Route best_route(bool wants_tables, bool has_formulas, bool has_functions);

/// The grid of the first reflectance that has one of its own; else that of a tabulated lighting, where there is one.
/// \throws ArgumentError for formulas alone
[[nodiscard]] HemisphereGrid common_grid(const ReflectanceList& reflectances, const Lighting* lighting = nullptr);

/// measure() by the route `formulas`; `options.route` and `options.grid` have no effect.
/// \param materials prepared
/// \param slabs all slabs of the rule, of which those that are known are taken from there; none: all are refined
[[nodiscard]] MetricResult measure_formulas(const Device& device, std::span<const Material> materials,
                                            const Lighting& lighting, const MetricOptions& options,
                                            const SlabStore* slabs = nullptr);

/// How many slabs measure_formulas() refines independently of each other; 0 where it cannot, or refuses the materials.
[[nodiscard]] std::size_t formula_slabs(std::span<const Material> materials, const Lighting& lighting,
                                        const MetricOptions& options);

/// Refines the slabs that a store wants, which it is given to keep.
/// \throws as measure_formulas()
void refine_formula_slabs(const Device& device, std::span<const Material> materials, const Lighting& lighting,
                          const MetricOptions& options, const SlabStore& slabs);

/// How products of functions are computed.
struct FunctionMetricOptions {
  /// Slabs of the quadrature are refined until the error estimate of every f.f is below tolerance times f.f, or until
  /// the finest level.
  double tolerance = MetricOptions{}.function_tolerance;
  std::vector<double> channel_weights = {};  ///< as in MetricOptions
  /// Smallest half-vector width of lobes that the quadrature follows, radians.
  double lobe_width = 0.005;
  double theta_max = std::numbers::pi / 2;  ///< as in MetricOptions
  ProgressCallback progress = {};
};

/// measure() by the route `functions`.
[[nodiscard]] MetricResult measure_functions(std::span<const BrdfFunction> functions, const Lighting& lighting,
                                             const FunctionMetricOptions& options = {});

/// How products of tables are combined.
struct TableMetricOptions {
  std::vector<double> channel_weights = {};  ///< as in MetricOptions
  /// As in MetricOptions. On grids without cells sums are over the interpolated values; on grids of cells it must be
  /// the limit of a ring.
  double theta_max = std::numbers::pi / 2;
  ProgressCallback progress = {};
};

/// measure() by the route `tables`, of tables on one grid.
[[nodiscard]] MetricResult measure_tables(const Device& device, std::span<const BrdfTable* const> tables,
                                          const Lighting& lighting, const TableMetricOptions& options = {});

/// A distance over the norm whose square is given; NaN where that is 0 and the distance is not.
[[nodiscard]] Estimate share_of(const Estimate& distance, const Estimate& square);

/// displacement() by the route `tables`, of tables on one grid.
[[nodiscard]] Displacement table_displacement(const BrdfTable& before, const BrdfTable& after);

}  // namespace lobe
