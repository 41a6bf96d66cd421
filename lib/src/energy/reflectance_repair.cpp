// Repairs of reflectances, however these are known.
#include <span>
#include <utility>

#include "energy/known_as.hpp"
#include "energy/repair.hpp"
#include "lobe/core/error.hpp"
#include "table/grid_choice.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

/// The grid for one formula, prepared, or one function.
HemisphereGrid grid_of(const Device& device, std::span<const Material> formula, std::span<const BrdfFunction> function,
                       const RepairGrid& where) {
  if (where.grid) return *where.grid;
  const auto start = function.empty() ? HemisphereGrid::default_grid() : natural_grid(function.front());
  return resolving_grid(device, formula, function, start, TableUse::values, where.tabulation);
}

/// Calls work(table) with a reflectance as a table.
template <typename Work>
auto with_table(const Device& device, const Reflectance& reflectance, const RepairGrid& where, const Work& work) {
  const BrdfTable* own = reflectance.table();
  if (own != nullptr && (!where.grid || *where.grid == own->grid)) return work(*own);
  return known_as(
      device, reflectance,
      Cases{[&](const Material& formula) {
              return work(tabulate(device, formula, grid_of(device, {&formula, 1}, {}, where), where.tabulation));
            },
            [&](const BrdfFunction& function) {
              return work(tabulate(function, grid_of(device, {}, {&function, 1}, where), where.tabulation));
            },
            [&](const BrdfTable& table) { return work(resample(table, where.grid.value_or(table.grid))); }});
}

Pumped pumped_formulas(const Device& device, const Material& material, Correction correction,
                       const PumpOptions& options) {
  PumpedMaterial pumped = pump(device, material, correction, options);
  auto steps = pump_curves(device, pumped, options.theta_in);
  return {.result = std::move(pumped.steps.back()),
          .theta_in = options.theta_in,
          .steps = std::move(steps),
          .is_converged = pumped.is_converged,
          .obstacle = std::move(pumped.obstacle)};
}

Pumped pumped_table(const BrdfTable& table, Correction correction, const PumpOptions& options) {
  PumpedTable pumped = pump(table, correction, options);
  Pumped result{.result = std::move(pumped.table),
                .theta_in = {},
                .steps = std::move(pumped.steps),
                .change = pumped.change,
                .is_converged = pumped.is_converged,
                .obstacle = {}};
  const bool is_isotropic = table.form == TableForm::isotropic;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    result.theta_in.push_back(table.grid.rings()[is_isotropic ? row : table.grid.ring_of(row)].theta);
  }
  if (!options.times && !pumped.is_converged) {
    result.obstacle = "an albedo changed by " + std::to_string(pumped.change) + " in the last step";
  }
  return result;
}

}  // namespace

Pumped pump(const Device& device, const Reflectance& reflectance, Correction correction, const PumpOptions& options) {
  if (correction == Correction::complement || correction == Correction::viewer) {
    throw ArgumentError("'" + std::string(to_string(correction)) +
                        "' is no correction for pumping-up; expected g1, g2 or controlled");
  }
  // Albedos of anisotropic formulas depend on azimuth, too; those of their tables are known by row.
  if (const Material* formula = reflectance.formula(); formula != nullptr && reflectance.is_isotropic()) {
    return pumped_formulas(device, *formula, correction, options);
  }
  return with_table(device, reflectance, options.table,
                    [&](const BrdfTable& table) { return pumped_table(table, correction, options); });
}

BrdfTable normalise(const Device& device, const Reflectance& reflectance, const RepairGrid& table) {
  return with_table(device, reflectance, table, [](const BrdfTable& own) { return normalise(own); });
}

BrdfTable symmetrise(const Device& device, const Reflectance& reflectance, const RepairGrid& table) {
  return with_table(device, reflectance, table, [](const BrdfTable& own) { return symmetrise(own); });
}

BalancedTable scale_symmetrically(const Device& device, const Reflectance& reflectance, const BalanceOptions& options) {
  return with_table(device, reflectance, options.table,
                    [&](const BrdfTable& own) { return scale_symmetrically(own, options); });
}

}  // namespace lobe
