#pragma once

#include <algorithm>
#include <string_view>

#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/table.hpp"
#include "metric/products.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Traits of a kind of lighting that code needs (all are in lighting_traits.cpp).
struct LightingTraits {
  Lighting::Kind kind;
  std::string_view name;  ///< as the first word of Lighting::name()
  int product_power = 0;  ///< of sr, in products
  /// Only mean albedos count, so that lobes which grow as 1/(N.L) at grazing angles have norms, too.
  bool is_of_means = false;
  bool takes_deltas = true;       ///< products of delta parts are finite
  bool takes_anisotropic = true;  ///< of products of formulas
  /// W is applied as a table to what is a table: there are no products up to a largest angle.
  bool has_operator = false;
  bool takes_functions = true;       ///< there are products of functions
  bool is_tabulated = false;         ///< W is a table, on whose grid all is computed
  bool is_by_tables = false;         ///< products are sums over tables, of formulas too
  bool is_pattern = false;           ///< the light is a reflectance: point products of what it makes of others
  bool has_patch_tolerance = false;  ///< MetricOptions::patch_tolerance holds; costs far more than point light
  std::string_view rule;             ///< of the quadrature of formulas, for plans
  bool has_slabs = false;            ///< the rule parts its domain by what the lobes demand
  /// W as a table; null: there is no W.
  BrdfTable (*tabulate)(const Device& device, const Lighting& lighting, const HemisphereGrid& grid) = nullptr;
  /// Products of formulas; null: there are none.
  void (*integrate)(const Device& device, const LobeSet& lobes, const Lighting& lighting, const MetricOptions& options,
                    ProductSums& sums, WorkDone& work) = nullptr;
  /// Slabs of the quadrature of formulas that `integrate` refines independently of each other; null: there are none.
  std::size_t (*slabs)(const LobeSet& lobes, const MetricOptions& options) = nullptr;
};

[[nodiscard]] const LightingTraits& traits_of(Lighting::Kind kind);
[[nodiscard]] inline const LightingTraits& traits_of(const Lighting& lighting) {
  return traits_of(lighting.kind());
}

/// Relative tolerance for products of formulas under a lighting.
[[nodiscard]] inline double formula_tolerance(const Lighting& lighting, const MetricOptions& options) {
  return traits_of(lighting).has_patch_tolerance ? std::max(options.tolerance, options.patch_tolerance)
                                                 : options.tolerance;
}

}  // namespace lobe
