// Which route products are computed by, and the sets that take it.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "metric/channel_metric.hpp"
#include "metric/delta_products.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/material_light.hpp"
#include "metric/routed_set.hpp"
#include "metric/routes.hpp"
#include "metric/table_products.hpp"
#include "model/lobes.hpp"
#include "reflectance/prepared.hpp"

namespace lobe {
namespace {

/// Whether a reflectance can become a function.
bool has_values(const Reflectance& reflectance) {
  return !reflectance.has_delta();
}

/// Sets or adds to a product.
void enter_product(Metric& metric, Eigen::Index i, Eigen::Index j, const Estimate& product, bool is_added) {
  const double value = is_added ? metric.gram(i, j) + product.value : product.value;
  const double error = is_added ? metric.gram_error(i, j) + product.error : product.error;
  metric.gram(i, j) = metric.gram(j, i) = value;
  metric.gram_error(i, j) = metric.gram_error(j, i) = error;
}

/// Norms of infinite squares, and distances from what has one, except between those that are infinite by the same.
void set_infinite_roots(Metric& metric, const std::set<std::pair<Eigen::Index, Eigen::Index>>& equals) {
  for (Eigen::Index i = 0; i < metric.gram.rows(); ++i) {
    if (!std::isinf(metric.gram(i, i))) continue;
    metric.norm(i) = metric.gram(i, i);
    metric.norm_error(i) = 0;
    for (Eigen::Index j = 0; j < metric.gram.rows(); ++j) {
      if (j == i || equals.contains(std::minmax(i, j))) continue;
      metric.distance(i, j) = metric.distance(j, i) = metric.gram(i, i);
      metric.distance_error(i, j) = metric.distance_error(j, i) = 0;
    }
  }
}

/// The patch light that a material as light is: s times the basic patch of radius R has W = C_eta = s^2 C_{eta_R}.
/// Under patch light formulas and functions need no tables.
std::optional<Lighting> patch_light_of(const Lighting& lighting, std::span<const Reflectance> reflectances,
                                       const MetricOptions& options) {
  if (!traits_of(lighting).is_pattern || options.grid || options.route != Route::automatic) return {};
  const Material* eta = lighting.material().formula();
  if (eta == nullptr || eta->terms.size() != 1 || !eta->adjustments.empty()) return {};
  const Term& term = eta->terms.front();
  const double scale = term.weight.front();
  if (term.model != "basic_patch" || !term.factors.empty() || term.pumping || scale == 0) return {};
  const bool have_no_tables =
      std::ranges::all_of(reflectances, is_formula) || std::ranges::all_of(reflectances, is_function);
  if (!have_no_tables) return {};
  return Lighting::mixture({{term.values.front(), scale * scale}});
}

}  // namespace

bool is_function(const Reflectance& reflectance) {
  if (reflectance.table() != nullptr || reflectance.has_delta()) return false;
  return reflectance.function() == nullptr || reflectance.function()->cells == nullptr;
}

bool is_formula(const Reflectance& reflectance) {
  return reflectance.formula() != nullptr;
}

Route best_route(bool wants_tables, bool has_formulas, bool has_functions) {
  if (wants_tables) return Route::tables;
  return has_formulas ? Route::formulas : has_functions ? Route::functions : Route::tables;
}

HemisphereGrid common_grid(const ReflectanceList& reflectances, const Lighting* lighting) {
  for (const Reflectance& reflectance : reflectances) {
    if (!is_formula(reflectance)) return natural_grid(reflectance);
  }
  const bool are_isotropic = std::ranges::all_of(reflectances, &Reflectance::is_isotropic);
  if (lighting != nullptr && traits_of(*lighting).is_tabulated) return lighting->table().grid;
  if (lighting != nullptr && traits_of(*lighting).is_pattern) {
    const Reflectance& eta = lighting->material();
    if (!is_formula(eta)) return natural_grid(eta);
    return HemisphereGrid::default_grid(eta.is_isotropic() && are_isotropic);
  }
  // What is anisotropic and has delta parts is neither integrated as formulas nor as functions.
  if (lighting != nullptr && !are_isotropic && !traits_of(*lighting).takes_anisotropic) {
    return HemisphereGrid::default_grid(false);
  }
  throw ArgumentError("formulas have no grid to be tabulated on; expected one");
}

std::string_view to_string(Route route) {
  switch (route) {
    case Route::automatic:
      return "automatic";
    case Route::formulas:
      return "formulas";
    case Route::functions:
      return "functions";
    case Route::tables:
      return "tables";
  }
  return "";
}

bool takes_tables(const Lighting& lighting) {
  return traits_of(lighting).has_operator;
}

RouteChoice choose_route(const ReflectanceList& reflectances, const Lighting& lighting, const MetricOptions& options) {
  const LightingTraits& traits = traits_of(lighting);
  const bool has_table = traits.is_by_tables;
  const bool has_functions = traits.takes_functions && std::ranges::all_of(reflectances, is_function);
  const bool is_integrable = traits.takes_anisotropic || std::ranges::all_of(reflectances, &Reflectance::is_isotropic);
  const bool has_formulas = std::ranges::all_of(reflectances, is_formula) && is_integrable;
  const Route route = options.route != Route::automatic
                          ? options.route
                          : best_route(options.grid || has_table, has_formulas, has_functions);
  const auto refuse = [&](const std::string& expected) {
    throw ArgumentError("the route '" + std::string(to_string(route)) + "' under lighting '" + lighting.name() +
                        "' takes " + expected);
  };
  if (route == Route::formulas && (!has_formulas || has_table)) {
    refuse(traits.takes_anisotropic ? "formulas alone, and no tabulated lighting" : "isotropic formulas alone");
  }
  if (route == Route::functions && (!traits.takes_functions || !std::ranges::all_of(reflectances, has_values))) {
    refuse("reflectances without delta parts, and no tabulated lighting");
  }
  if (route != Route::tables) return {.route = route};
  return {route, options.grid ? *options.grid : common_grid(reflectances, &lighting),
          !options.grid && traits.is_pattern};
}

RoutedSet::RoutedSet(const Device& device, ReflectanceList reflectances, MetricOptions options)
    : device_(device), reflectances_(reflectances.begin(), reflectances.end()), options_(std::move(options)) {
  for (Reflectance& reflectance : reflectances_) {
    reflectance = adjusted(device, reflectance);
  }
}

RouteChoice RoutedSet::choice(const Lighting& lighting) {
  RouteChoice choice = choose_route(reflectances_, lighting, options_);
  if (options_.grid) return choice;
  return choice.is_first_grid ? choice : refined(std::move(choice));
}

RouteChoice RoutedSet::refined(RouteChoice choice) {
  if (!choice.grid) return choice;
  auto known = std::ranges::find(refined_, *choice.grid, [](const auto& pair) { return pair.first; });
  if (known == refined_.end()) {
    const TabulateOptions options{.precision = options_.precision, .cell_points = options_.cell_points};
    refined_.emplace_back(*choice.grid,
                          resolving_grid(device_, reflectances_, *choice.grid, TableUse::values, options));
    known = std::prev(refined_.end());
  }
  choice.grid = known->second;
  return choice;
}

void RoutedSet::require_some() const {
  if (reflectances_.empty()) throw ArgumentError("nothing to measure; expected at least one reflectance");
}

std::span<const Material> RoutedSet::formulas() {
  if (formulas_.empty()) {
    for (const Reflectance& reflectance : reflectances_) formulas_.push_back(*reflectance.formula());
  }
  return formulas_;
}

std::span<const BrdfFunction> RoutedSet::functions() {
  if (functions_.empty()) {
    for (const Reflectance& reflectance : reflectances_) functions_.push_back(function_of(device_, reflectance));
  }
  return functions_;
}

std::span<const BrdfTable* const> RoutedSet::tables(const HemisphereGrid& grid) {
  if (grid_tables_ && grid_tables_->grid == grid) return grid_tables_->tables;
  grid_tables_.reset();
  GridTables found{grid, {}, {}};
  found.made.reserve(reflectances_.size());
  const TabulateOptions options{.precision = options_.precision,
                                .allow_unresolved = options_.allow_unresolved,
                                .cell_points = options_.cell_points,
                                .progress = options_.progress};
  for (const Reflectance& reflectance : reflectances_) {
    const BrdfTable* table = reflectance.table();
    if (table == nullptr || !(table->grid == grid)) {
      found.made.push_back(table_on(device_, reflectance, grid, options));
      table = &found.made.back();
    }
    found.tables.push_back(table);
  }
  grid_tables_ = std::move(found);
  return grid_tables_->tables;
}

MetricResult RoutedSet::by_route(const RouteChoice& choice, const Lighting& lighting, const SlabStore* slabs) {
  if (choice.route == Route::formulas) return measure_formulas(device_, formulas(), lighting, options_, slabs);
  if (choice.route == Route::functions) {
    FunctionMetricOptions options{.tolerance = options_.function_tolerance,
                                  .channel_weights = options_.channel_weights,
                                  .theta_max = options_.theta_max,
                                  .progress = options_.progress};
    if (takes_tables(lighting) && std::ranges::all_of(reflectances_, is_formula)) {
      options.lobe_width = make_lobe_set(formulas(), {.with_anisotropic = true}).sharpest();
    }
    return measure_functions(functions(), lighting, options);
  }
  const auto all = tables(*choice.grid);
  MetricResult result = measure_tables(
      device_, all, lighting,
      {.channel_weights = options_.channel_weights, .theta_max = options_.theta_max, .progress = options_.progress});
  result.tolerance = formula_tolerance(lighting, options_);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i]->is_unresolved) result.coarse.push_back(i);
  }
  return result;
}

MetricResult RoutedSet::with_deltas() {
  MetricOptions options = options_;
  options.allow_infinite = false;
  std::vector<Reflectance> smooth;
  for (const Reflectance& reflectance : reflectances_) smooth.push_back(without_deltas(reflectance));
  RoutedSet rest(device_, smooth, options);
  MetricResult result = rest.measure(Lighting::point());
  const std::size_t channels = std::max<std::size_t>(1, result.channels.size());
  const std::vector<double> weights = channel_weights(options_.channel_weights, channels);
  const auto full = result.grid ? tables(*result.grid) : std::span<const BrdfTable* const>();
  std::optional<TableLight> light;
  if (result.grid) light.emplace(device_, Lighting::point(), *result.grid, options_.theta_max);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto each = [&](Eigen::Index i, Eigen::Index j, const std::vector<Estimate>& products, bool is_added) {
    Estimate sum;
    for (std::size_t c = 0; c < channels; ++c) {
      sum += weights[c] * products[c];
      if (!result.channels.empty()) enter_product(result.channels[c], i, j, products[c], is_added);
    }
    enter_product(result.combined, i, j, sum, is_added);
  };
  std::set<std::pair<Eigen::Index, Eigen::Index>> equals;  // pairs whose delta parts are
  for (std::size_t i = 0; i < reflectances_.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Reflectance& f = reflectances_[i];
      const Reflectance& g = reflectances_[j];
      if (!f.has_delta() && !g.has_delta()) continue;
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(j);
      if (have_equal_deltas(device_, f, g)) equals.emplace(std::minmax(row, column));
      if (share_delta(device_, f, g)) {
        each(row, column, std::vector<Estimate>(channels, {kInfinity, 0}), false);
      } else if (!full.empty()) {
        each(row, column, light->products(*full[i], *full[j]), false);
      } else {
        each(row, column, delta_products(device_, f, smooth[j], channels, options_), true);
        each(row, column, delta_products(device_, g, smooth[i], channels, options_), true);
      }
    }
  }
  set_infinite_roots(result.combined, equals);
  for (Metric& channel : result.channels) set_infinite_roots(channel, equals);
  return result;
}

std::size_t RoutedSet::slabs(const Lighting& lighting) {
  if (reflectances_.empty() || traits_of(lighting).slabs == nullptr) return 0;
  if (options_.allow_infinite || choose_route(reflectances_, lighting, options_).route != Route::formulas) return 0;
  return formula_slabs(formulas(), lighting, options_);
}

void RoutedSet::refine_slabs(const Lighting& lighting, const SlabStore& slabs) {
  refine_formula_slabs(device_, formulas(), lighting, options_, slabs);
}

MetricResult RoutedSet::measure(const Lighting& lighting, const SlabStore* slabs) {
  require_some();
  if (options_.allow_infinite && lighting == Lighting::point() &&
      std::ranges::any_of(reflectances_, &Reflectance::has_delta)) {
    return with_deltas();
  }
  if (const auto patch = patch_light_of(lighting, reflectances_, options_)) {
    MetricResult result = measure(*patch);
    result.lighting = lighting;
    return result;
  }
  const RouteChoice taken = choice(lighting);
  if (traits_of(lighting).is_pattern) return measure_lit(device_, reflectances_, lighting, taken, options_);
  MetricResult result = by_route(taken, lighting, slabs);
  result.route = taken.route;
  result.grid = taken.grid;
  return result;
}

Displacement displacement(const Device& device, const Reflectance& before, const Reflectance& after,
                          const MetricOptions& options) {
  const Reflectance from = adjusted(device, before);
  const Reflectance to = adjusted(device, after);
  const Lighting lighting = from.has_delta() || to.has_delta() ? Lighting::daylight() : Lighting::point();
  if (choose_route({from, to}, lighting, options).route == Route::tables) {
    RoutedSet set(device, {from, to}, options);
    const auto tables = set.tables(*set.choice(lighting).grid);
    return table_displacement(*tables[0], *tables[1]);
  }
  const Metric metric = measure(device, {from, to}, lighting, options).combined;
  Displacement result{lighting, {metric.distance(0, 1), metric.distance_error(0, 1)}, {}};
  result.relative = share_of(result.absolute, {metric.gram(0, 0), metric.gram_error(0, 0)});
  return result;
}

MetricResult measure(const Device& device, const ReflectanceList& reflectances, const Lighting& lighting,
                     const MetricOptions& options) {
  return RoutedSet(device, reflectances, options).measure(lighting);
}

std::vector<MetricResult> measure(const Device& device, const ReflectanceList& reflectances,
                                  std::span<const Lighting> lightings, const MetricOptions& options) {
  RoutedSet set(device, reflectances, options);
  std::vector<MetricResult> results;
  for (const Lighting& lighting : lightings) results.push_back(set.measure(lighting));
  return results;
}

Estimate scalar_product(const Device& device, const Reflectance& f, const Reflectance& g, const Lighting& lighting,
                        const MetricOptions& options) {
  const auto result = measure(device, {f, g}, lighting, options);
  return {result.combined.gram(0, 1), result.combined.gram_error(0, 1)};
}

Estimate distance(const Device& device, const Reflectance& f, const Reflectance& g, const Lighting& lighting,
                  const MetricOptions& options) {
  MetricOptions own = options;
  own.allow_infinite = options.allow_infinite || have_equal_deltas(device, f, g);
  const auto result = measure(device, {f, g}, lighting, own);
  return {result.combined.distance(0, 1), result.combined.distance_error(0, 1)};
}

}  // namespace lobe
