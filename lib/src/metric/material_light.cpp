// Light of the pattern of a reflectance: what it makes of others.
#include "metric/material_light.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "algebra/function_composition.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "metric/channel_metric.hpp"
#include "metric/domain.hpp"
#include "metric/grazing_growth.hpp"
#include "metric/grid_products.hpp"
#include "metric/routes.hpp"
#include "metric/table_measure.hpp"
#include "model/delta.hpp"
#include "model/lobes.hpp"
#include "reflectance/prepared.hpp"
#include "table/grid_choice.hpp"

namespace lobe {
namespace {

// Grids: the first one, and the most rings.
constexpr std::size_t kFirstRings = 8;
constexpr std::size_t kMostRings = 128;
constexpr std::size_t kMostFunctionRings = 64;  // of functions, whose values take several times as long
constexpr std::size_t kMostGeneralRings = 48;   // of tables of all four angles
constexpr double kFunctionCaution = 4;  // of files, whose narrow features are where no grid looks; chosen, not measured
constexpr double kTableShare = 4;       // of the tolerance of products, that of the tables
constexpr double kGain = 0.7;           // of an error, above which a finer grid is not worth its time

bool are_nodes(const HemisphereGrid& grid) {
  return grid.is_product() && !grid.has_cells();
}

/// Whether a reflectance grows towards the horizon such that C_{eta,f} has no norm, for any eta.
bool has_no_lit_norm(const Device& device, const Reflectance& reflectance) {
  if (const Material* formula = reflectance.formula()) {
    const LobeKinds all{.with_deltas = true, .with_anisotropic = true};
    if (!make_lobe_set({formula, 1}, all).infinite.empty()) return true;
    const bool has_own = std::ranges::any_of(formula->terms, [](const Term& term) { return term.formula.has_value(); });
    return has_own && has_infinite_norm(as_function(device, smooth_part(*formula)), Lighting::daylight());
  }
  const BrdfFunction* function = reflectance.function();
  return function != nullptr && function->cells == nullptr && function->ring_cells == nullptr &&
         has_infinite_norm(*function, Lighting::daylight());
}

}  // namespace

MaterialLight::MaterialLight(const Device& device, const Lighting& lighting, const HemisphereGrid& grid,
                             MaterialLightOptions options)
    : device_(device), grid_(grid), options_(std::move(options)), eta_(adjusted(device, lighting.material())) {}

const BrdfTable& MaterialLight::eta_table() const {
  if (!table_) {
    table_ = table_on(device_, eta_, grid_,
                      {.precision = options_.precision, .allow_unresolved = true, .cell_points = options_.cell_points});
  }
  return *table_;
}

BrdfTable MaterialLight::lit(const Reflectance& f) const {
  if (are_nodes(grid_) && can_be_factor(eta_) && can_be_factor(f)) {
    return compose_factors(
        device_, eta_, f, grid_,
        {.precision = options_.precision, .tolerance = options_.tolerance, .progress = options_.progress});
  }
  if (f.table() != nullptr && f.table()->grid == grid_) return lit(*f.table());
  return lit(
      table_on(device_, f, grid_,
               {.precision = options_.precision, .allow_unresolved = true, .cell_points = options_.cell_points}));
}

BrdfTable MaterialLight::lit(const BrdfTable& f) const {
  return compose(device_, eta_table(), f,
                 {.precision = options_.precision,
                  .allow_unresolved = true,
                  .resolve_formulas = true,
                  .tolerance = options_.tolerance,
                  .progress = options_.progress});
}

namespace {

void require_lit_norms(const Device& device, const Lighting& lighting, std::span<const Reflectance> all) {
  for (const Reflectance& reflectance : all) {
    if (!has_no_lit_norm(device, reflectance)) continue;
    throw NumericError("the norm of '" + reflectance.name() + "' under lighting '" + lighting.name() +
                           "' is infinite: it grows as 1/(N.L) at grazing angles; 'mean-albedo' takes it, or " +
                           domain_advice(lighting),
                       {.fault = Fault::infinite_norm});
  }
}

bool is_on_grid(const Reflectance& reflectance) {
  const BrdfFunction* function = reflectance.function();
  return reflectance.table() != nullptr || (function != nullptr && function->cells != nullptr);
}

GridProducts lit_products(const MaterialLight& light, const Device& device, std::span<const Reflectance> reflectances,
                          const MetricOptions& options) {
  std::vector<BrdfTable> lit;
  for (const Reflectance& reflectance : reflectances) lit.push_back(light.lit(reflectance));
  std::vector<const BrdfTable*> all;
  for (const BrdfTable& table : lit) all.push_back(&table);
  const TableMetricOptions own{.channel_weights = options.channel_weights, .progress = options.progress};
  GridProducts result{products_of_tables(device, all, Lighting::point(), own), {}};
  for (BrdfTable& table : lit) {
    std::ranges::fill(table.error, 0.0);
    table.even_error.clear();
    table.odd_part.clear();
  }
  result.sums = products_of_tables(device, all, Lighting::point(), own);
  return result;
}

/// All channels together, with the errors of the values that are summed alone.
ChannelProducts values_alone(const GridProducts& level) {
  ChannelProducts products = level.products.back();
  products.gram_error -= level.sums.back().gram_error;
  return products;
}

}  // namespace

MetricResult measure_lit(const Device& device, std::span<const Reflectance> reflectances, const Lighting& lighting,
                         const RouteChoice& choice, const MetricOptions& options) {
  static_cast<void>(cos_of_domain(options.theta_max, lighting));
  std::vector<Reflectance> all(reflectances.begin(), reflectances.end());
  all.push_back(adjusted(device, lighting.material()));
  require_lit_norms(device, lighting, all);
  const bool are_formulas = std::ranges::all_of(all, is_formula);
  const double tolerance =
      std::max(options.tolerance, are_formulas ? options.patch_tolerance : options.function_tolerance);
  const auto on_grid = [&](const HemisphereGrid& grid) {
    const MaterialLight light(device, lighting, grid,
                              {.precision = options.precision,
                               .tolerance = tolerance / kTableShare,
                               .cell_points = options.cell_points,
                               .progress = options.progress});
    return lit_products(light, device, reflectances, options);
  };
  const bool is_fixed = options.grid || std::ranges::any_of(all, is_on_grid);
  HemisphereGrid grid = is_fixed ? *choice.grid : HemisphereGrid::gauss(kFirstRings, 2 * kFirstRings);
  const double caution = are_formulas ? 1 : kFunctionCaution;
  std::vector<GridProducts> levels{on_grid(grid)};
  std::vector<ChannelProducts> best = with_grid_errors(levels, caution);
  const bool are_isotropic = std::ranges::all_of(all, &Reflectance::is_isotropic);
  // Values of resolved compositions are as good on any grid.
  const bool are_resolved = std::ranges::all_of(all, can_be_factor);
  const std::size_t most = !are_isotropic ? kMostGeneralRings : are_formulas ? kMostRings : kMostFunctionRings;
  HemisphereGrid finer = next_gauss(grid);
  while (!is_fixed && finer.n_theta() <= most &&
         (levels.size() < kLevelsKept || worst_error(best.back()) > tolerance)) {
    levels.push_back(on_grid(finer));
    std::vector<ChannelProducts> next = with_grid_errors(levels, caution);
    const double before = worst_error(best.back());
    const double now = worst_error(next.back());
    if (levels.size() <= kLevelsKept || !(now >= before)) {
      best = std::move(next);
      grid = finer;
    }
    if (levels.size() > kLevelsKept && !(now < kGain * before)) break;
    if (are_resolved && levels.size() >= kLevelsKept && !(now > 2 * worst_error(values_alone(levels.back())))) break;
    finer = next_gauss(finer);
  }
  MetricResult result = metric_of(std::move(best));
  result.lighting = lighting;
  result.route = Route::tables;
  result.grid = grid;
  result.tolerance = tolerance;
  if (!is_fixed) result.unresolved = find_unresolved(result.combined, tolerance);
  return result;
}

}  // namespace lobe
