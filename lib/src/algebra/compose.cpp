#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "algebra/composition_error.hpp"
#include "algebra/function_composition.hpp"
#include "algebra/inner_factors.hpp"
#include "algebra/operands.hpp"
#include "algebra/smooth_product.hpp"
#include "algebra/source_values.hpp"
#include "core/parallel.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/model/model.hpp"
#include "table/delta_parts.hpp"
#include "table/even_error.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

// Measurements have kinks anywhere and take long: the relative error that is enough, and the values of a level beyond
// the first two.
constexpr double kFunctionTolerance = 2e-3;
constexpr double kMostFunctionValues = 5e7;

/// Brings a table to another grid: tabulated anew if its formula is known, else interpolated.
BrdfTable on_grid(const Device& device, const BrdfTable& table, const HemisphereGrid& grid, Precision precision,
                  bool allow_unresolved) {
  if (table.source.size() != 1 || !table.grid.is_product() || !grid.is_product() || table.has_delta()) {
    return resample(table, grid);
  }
  TabulateOptions options{
      .precision = precision, .allow_unresolved = allow_unresolved || table.is_unresolved, .form = table.form};
  BrdfTable moved = tabulate(device, table.source.front(), grid, options);
  moved.expression = table.expression;
  return moved;
}

/// Rows and azimuths as the ideal mirror permutes them.
struct Reflection {
  explicit Reflection(const BrdfTable& table) : table_(table) {}

  /// Row of L' for a row of L.
  [[nodiscard]] std::size_t row(std::size_t row) const {
    return table_.form == TableForm::isotropic ? row : table_.grid.opposite(row);
  }
  /// Position within a row (isotropic [theta_out][k], general [node_out]) of V' for that of V.
  [[nodiscard]] std::size_t column(std::size_t column) const {
    if (table_.form == TableForm::general) return table_.grid.opposite(column);
    const std::size_t half = table_.grid.half_azimuths();
    return column / half * half + (half - 1 - column % half);
  }
  /// Row that a position within a row belongs to.
  [[nodiscard]] std::size_t row_of_column(std::size_t column) const {
    return table_.form == TableForm::isotropic ? column / table_.grid.half_azimuths() : column;
  }

 private:
  const BrdfTable& table_;
};

/// Adds what delta parts make of smooth ones: f R_g + f I_g + R_f g + I_f g.
void add_delta_terms(const BrdfTable& f, const BrdfTable& g, BrdfTable& c) {
  if (!f.has_delta() && !g.has_delta()) return;
  const Reflection reflect(c);
  const std::size_t rows = c.rows();
  const std::size_t columns = c.size() / rows;
  parallel_for(c.channels * rows, [&](std::size_t channel_row) {
    const std::size_t channel = channel_row / rows;
    const std::size_t row = channel_row % rows;
    const double* const f_row = f.channel(channel).data() + row * columns;
    const double* const g_row = g.channel(channel).data() + row * columns;
    // R turns L around; in an isotropic table that is the same as turning V around.
    const bool is_isotropic = c.form == TableForm::isotropic;
    const double* const g_mirrored = g.channel(channel).data() + reflect.row(row) * columns;
    double* const out = c.channel(channel).data() + row * columns;
    const double f_mirror = delta_part(f.mirror, channel_row);
    const double f_retro = delta_part(f.retro, channel_row);
    for (std::size_t j = 0; j < columns; ++j) {
      const std::size_t back = reflect.column(j);
      const std::size_t g_at = channel * rows + reflect.row_of_column(j);
      const std::size_t g_back_at = channel * rows + reflect.row_of_column(back);
      double sum = out[j];
      if (!g.mirror.empty()) sum += f_row[back] * g.mirror[g_back_at];
      if (!g.retro.empty()) sum += f_row[j] * g.retro[g_at];
      if (!f.mirror.empty()) sum += f_mirror * (is_isotropic ? g_row[back] : g_mirrored[j]);
      if (!f.retro.empty()) sum += f_retro * g_row[j];
      out[j] = sum;
    }
  });
}

/// Products of delta parts: R R = I, R I = I R = R.
void multiply_delta(const BrdfTable& f, const BrdfTable& g, BrdfTable& c) {
  if (!f.has_delta() || !g.has_delta()) return;
  const Reflection reflect(c);
  const std::size_t rows = c.rows();
  std::vector<double> mirror(c.channels * rows);
  std::vector<double> retro(c.channels * rows);
  for (std::size_t at = 0; at < mirror.size(); ++at) {
    const std::size_t turned = at / rows * rows + reflect.row(at % rows);
    retro[at] =
        delta_part(f.mirror, at) * delta_part(g.mirror, turned) + delta_part(f.retro, at) * delta_part(g.retro, at);
    mirror[at] =
        delta_part(f.mirror, at) * delta_part(g.retro, turned) + delta_part(f.retro, at) * delta_part(g.mirror, at);
  }
  const auto is_zero = [](double x) { return x == 0; };
  if (!std::ranges::all_of(mirror, is_zero)) c.mirror = std::move(mirror);
  if (!std::ranges::all_of(retro, is_zero)) c.retro = std::move(retro);
}

/// Largest delta factors of a channel's rings.
std::vector<double> delta_by_ring(const BrdfTable& table, std::size_t channel) {
  std::vector<double> largest(table.grid.rings().size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::size_t ring = table.form == TableForm::isotropic ? row : table.grid.ring_of(row);
    const std::size_t at = channel * table.rows() + row;
    largest[ring] =
        std::max(largest[ring], std::abs(delta_part(table.mirror, at)) + std::abs(delta_part(table.retro, at)));
  }
  return largest;
}

/// Errors of the smooth parts as the delta parts pass them on.
void add_delta_errors(const BrdfTable& f, const BrdfTable& g, BrdfTable& c) {
  if (!f.has_delta() && !g.has_delta()) return;
  forget_odd_part(c);
  const std::size_t rings = c.grid.rings().size();
  for (std::size_t channel = 0; channel < c.channels; ++channel) {
    const auto f_delta = delta_by_ring(f, channel);
    const auto g_delta = delta_by_ring(g, channel);
    for (std::size_t i = 0; i < rings; ++i) {
      for (std::size_t j = 0; j < rings; ++j) {
        const std::size_t at = (channel * rings + i) * rings + j;
        if (g_delta[j] != 0) c.error[at] += f.error[at] * g_delta[j];
        if (f_delta[i] != 0) c.error[at] += f_delta[i] * g.error[at];
      }
    }
  }
}

/// Whether the product of the smooth parts can be that of their formulas.
bool can_resolve(const BrdfTable& f, const BrdfTable& g, const ComposeOptions& options) {
  const auto is_formula = [](const BrdfTable& table) {
    return table.form == TableForm::isotropic && table.source.size() == 1 && can_be_factor(table.source.front());
  };
  return options.resolve_formulas && is_formula(f) && is_formula(g) && !f.grid.has_cells() &&
         std::max(f.source.front().channels(), g.source.front().channels()) == f.channels;
}

/// The product of the smooth parts by their formulas.
ResolvedProduct multiply_formulas(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                  const ComposeOptions& options) {
  const InnerFactor left = formula_factor(device, f.source.front(), f.grid, options.precision);
  const bool is_square = &f == &g || f.values == g.values;
  const InnerFactor right = is_square ? left : formula_factor(device, g.source.front(), g.grid, options.precision);
  return resolved_product(left, right, f.grid,
                          {.is_square = is_square, .tolerance = options.tolerance, .progress = options.progress});
}

/// A product whose quadrature is known, with what the errors of the operands make of it.
void take_resolved(ResolvedProduct product, const BrdfTable& f, const BrdfTable& g, Precision precision, BrdfTable& c) {
  c.values = std::move(product.values);
  c.error = propagated_error(f, g, precision);
  if (!product.odd.empty()) {
    c.even_error = c.error;
    c.odd_part = std::move(product.odd);
  }
  for (std::size_t at = 0; at < c.error.size(); ++at) {
    c.error[at] += product.error[at];
    if (c.odd_part.empty()) continue;
    c.error[at] += product.largest_odd[at];
    c.even_error[at] += product.mean_error[at];
  }
}

/// Fills the smooth part with that of the product, and its errors but for those of delta parts.
void multiply_smooth_parts(const Device& device, const BrdfTable& f, const BrdfTable& g, const ComposeOptions& options,
                           BrdfTable& c) {
  const std::size_t rings = c.grid.rings().size();
  c.values.resize(c.channels * c.size());
  c.error.assign(c.channels * rings * rings, 0);
  if (can_resolve(f, g, options)) {
    take_resolved(multiply_formulas(device, f, g, options), f, g, options.precision, c);
    return;
  }
  bool has_product = false;
  for (std::size_t channel = 0; channel < c.channels; ++channel) {
    if (has_smooth_part(f, channel) && has_smooth_part(g, channel)) {
      multiply_smooth(device, f, g, channel, c.channel(channel), options.precision, options.progress);
      has_product = true;
    } else {
      std::ranges::fill(c.channel(channel), 0.0);
    }
  }
  if (!has_product) return;
  if (options.estimate_error) {
    CompositionErrors errors = composition_error(device, f, g, c.values, options.precision);
    c.error = std::move(errors.largest);
    c.even_error = std::move(errors.even);
    c.odd_part = std::move(errors.odd);
  } else {
    std::ranges::fill(c.error, std::numeric_limits<double>::quiet_NaN());
  }
}

/// A composition without values.
BrdfTable frame_of(const BrdfTable& f, const BrdfTable& g, const std::string& f_name, const std::string& g_name) {
  BrdfTable c;
  c.grid = f.grid;
  c.form = f.form;
  c.channels = f.channels;
  c.channel_names = f.channel_names.empty() ? g.channel_names : f.channel_names;
  c.expression = "compose(" + f_name + ", " + g_name + ")";
  c.resolution_error = std::numeric_limits<double>::quiet_NaN();
  return c;
}

bool is_non_negative(const BrdfTable& table) {
  const auto all = [](const auto& numbers) { return std::ranges::none_of(numbers, [](double x) { return x < 0; }); };
  return all(table.values) && all(table.mirror) && all(table.retro);
}

FactorAlbedo factor_albedo(const BrdfTable& table) {
  FactorAlbedo factor{table.expression, {}, {}};
  const TableAlbedo albedos = row_albedos(table);
  for (std::size_t c = 0; c < table.channels; ++c) {
    for (const Estimate& a : albedos.in[c]) factor.in.push_back(a.value);
    for (const Estimate& a : albedos.out[c]) factor.out.push_back(a.value);
  }
  return factor;
}

}  // namespace

BrdfTable compose(const Device& device, const BrdfTable& given_f, const BrdfTable& given_g,
                  const ComposeOptions& options) {
  check(given_f);
  check(given_g);
  require_source_values(device, given_f);
  if (&given_f != &given_g) require_source_values(device, given_g);
  const BrdfTable* const given[] = {&given_f, &given_g};
  const Operands operands(given, common_shape(given, options.exact_grid),
                          [&](const BrdfTable& table, const HemisphereGrid& grid) {
                            return on_grid(device, table, grid, options.precision, options.allow_unresolved);
                          });
  const BrdfTable& f = operands[0];
  const BrdfTable& g = operands[1];

  BrdfTable c = frame_of(f, g, given_f.expression, given_g.expression);
  c.is_unresolved = f.is_unresolved || g.is_unresolved;
  multiply_smooth_parts(device, f, g, options, c);
  add_delta_errors(f, g, c);
  add_delta_terms(f, g, c);
  multiply_delta(f, g, c);
  if (!f.has_delta() && !g.has_delta() && !f.source.empty() && !g.source.empty()) {
    c.source = f.source;
    c.source.insert(c.source.end(), g.source.begin(), g.source.end());
  }
  // The bounds on albedos, which is what the factors are kept for, hold for reflectances without negative values.
  if (is_non_negative(f) && is_non_negative(g)) c.factors = {factor_albedo(f), factor_albedo(g)};
  return c;
}

bool can_be_factor(const Reflectance& reflectance) {
  if (reflectance.table() != nullptr) return false;
  if (const Material* material = reflectance.formula()) {
    return can_be_factor(*material) &&
           std::ranges::none_of(material->terms, [](const Term& term) { return traits_of(term).has_delta; });
  }
  const BrdfFunction& brdf = *reflectance.function();
  if (brdf.cells || !brdf.is_isotropic) return false;
  const Directions normal{};
  return brdf.at({&normal, 1}).error.size() == 0;
}

BrdfTable compose_factors(const Device& device, const Reflectance& f, const Reflectance& g, const HemisphereGrid& grid,
                          const ComposeOptions& options) {
  if (!grid.is_product() || grid.has_cells()) {
    throw ArgumentError("functions are composed on " + grid.name() + "; expected a gauss or uniform grid");
  }
  for (const Reflectance* reflectance : {&f, &g}) {
    if (can_be_factor(*reflectance)) continue;
    throw ArgumentError("'" + reflectance->name() +
                        "' is composed as a function; expected an isotropic reflectance without delta parts " +
                        "whose values are known at all directions");
  }
  const TabulateOptions tabulation{.precision = options.precision, .allow_unresolved = true};
  const auto table_of = [&](const Reflectance& reflectance) {
    const Material* material = reflectance.formula();
    return material != nullptr ? tabulate(device, *material, grid, tabulation)
                               : tabulate(*reflectance.function(), grid, tabulation);
  };
  const auto factor_of = [&](const Reflectance& reflectance, FactorPlace place) {
    const Material* material = reflectance.formula();
    return material != nullptr ? formula_factor(device, *material, grid, options.precision)
                               : function_factor(*reflectance.function(), grid, place);
  };
  std::array tables{table_of(f), table_of(g)};
  for (BrdfTable& table : tables) {
    // Odd parts are composed, and no error.
    if (!table.even_error.empty()) table.error = table.even_error;
    forget_odd_part(table);
  }
  const BrdfTable* const given[] = {tables.data(), &tables[1]};
  const Operands operands(given, common_shape(given, true),
                          [](const BrdfTable& table, const HemisphereGrid&) { return table; });
  BrdfTable c = frame_of(operands[0], operands[1], tables[0].expression, tables[1].expression);
  const bool has_function = f.function() != nullptr || g.function() != nullptr;
  take_resolved(
      resolved_product(factor_of(f, FactorPlace::first), factor_of(g, FactorPlace::second), grid,
                       {.tolerance = has_function ? std::max(options.tolerance, kFunctionTolerance) : options.tolerance,
                        .most_values = has_function ? kMostFunctionValues : ResolvedOptions{}.most_values,
                        .progress = options.progress}),
      operands[0], operands[1], options.precision, c);
  if (is_non_negative(operands[0]) && is_non_negative(operands[1])) {
    c.factors = {factor_albedo(operands[0]), factor_albedo(operands[1])};
  }
  return c;
}

BrdfTable self_compose(const Device& device, const BrdfTable& f, unsigned times, const ComposeOptions& options) {
  if (times < 1) throw ArgumentError("self-composition 0 times; expected at least 1");
  BrdfTable power = compose(device, f, f, options);
  for (unsigned k = 1; k < times; ++k) power = compose(device, power, f, options);
  power.expression = "self_compose(" + f.expression + ", times=" + std::to_string(times) + ")";
  return power;
}

std::uint64_t compose_bytes(const Device& device, const BrdfTable& f, const BrdfTable& g,
                            const ComposeOptions& options) {
  const bool is_general = f.form == TableForm::general || g.form == TableForm::general;
  BrdfTable shape;
  shape.grid = f.grid;
  shape.form = is_general ? TableForm::general : TableForm::isotropic;
  shape.channels = std::max(f.channels, g.channels);
  const std::uint64_t table_bytes = std::uint64_t{sizeof(double)} * shape.channels * shape.size();
  std::uint64_t copies = 0;  // operands that have to be brought to the grid, form and channels of the product
  for (const BrdfTable* operand : {&f, &g}) {
    if (!(operand->grid == f.grid) || operand->form != shape.form || operand->channels != shape.channels) {
      copies += table_bytes;
    }
  }
  std::uint64_t product = smooth_product_bytes(device, shape, options.precision);
  if (options.resolve_formulas && !is_general && shape.grid.is_product()) {
    product = std::max(product, resolved_product_bytes(shape.grid, shape.channels));
  }
  const std::uint64_t estimate = options.estimate_error ? composition_error_bytes(device, f, g, options.precision) : 0;
  return table_bytes + copies + std::max(product, estimate);
}

}  // namespace lobe
