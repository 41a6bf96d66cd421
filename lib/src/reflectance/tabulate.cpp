#include "table/tabulate.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "reflectance/prepared.hpp"
#include "table/grid_choice.hpp"

namespace lobe {

HemisphereGrid natural_grid(const Reflectance& reflectance) {
  if (const BrdfTable* table = reflectance.table()) return table->grid;
  if (const BrdfFunction* function = reflectance.function()) return natural_grid(*function);
  return HemisphereGrid::default_grid();
}

BrdfTable table_on(const Device& device, const Reflectance& reflectance, const HemisphereGrid& grid,
                   const TabulateOptions& options) {
  if (const Material* formula = reflectance.formula()) return tabulate(device, *formula, grid, options);
  if (const BrdfFunction* function = reflectance.function()) return tabulate(*function, grid, options);
  const BrdfTable& table = *reflectance.table();
  if (options.exact_grid && !(table.grid == grid)) {
    throw ArgumentError("'" + table.expression + "' is on grid " + table.grid.name() + ", not on " + grid.name() +
                            "; expected the same grid",
                        {.fault = Fault::other_grid, .grid = grid.name()});
  }
  return resample(table, grid);
}

BrdfTable tabulate(const Device& device, const Reflectance& reflectance, const HemisphereGrid& grid,
                   const TabulateOptions& options) {
  BrdfTable table = table_on(device, adjusted(device, reflectance), grid, options);
  return options.form == TableForm::general ? to_general(table) : table;
}

namespace {

/// What grids are judged by. Tables count where their formulas are known.
struct ToTabulate {
  std::vector<Material> formulas;
  std::vector<BrdfFunction> functions;
};

ToTabulate to_tabulate(const Device& device, const ReflectanceList& reflectances) {
  ToTabulate found;
  for (const Reflectance& given : reflectances) {
    const Reflectance reflectance = adjusted(device, given);
    if (const Material* formula = reflectance.formula()) found.formulas.push_back(*formula);
    if (const BrdfFunction* function = reflectance.function()) found.functions.push_back(*function);
    if (const BrdfTable* table = reflectance.table(); table != nullptr && table->source.size() == 1) {
      found.formulas.push_back(table->source.front());
    }
  }
  return found;
}

/// Whether a reflectance has no values but on a grid of its own.
bool has_own_grid(const Reflectance& reflectance) {
  const BrdfFunction* function = reflectance.function();
  return reflectance.table() != nullptr || (function != nullptr && function->cells != nullptr);
}

}  // namespace

HemisphereGrid choose_grid(const Device& device, const ReflectanceList& reflectances, const TabulateOptions& options) {
  const ToTabulate all = to_tabulate(device, reflectances);
  return choose_grid(device, all.formulas, all.functions, options);
}

HemisphereGrid resolving_grid(const Device& device, const ReflectanceList& reflectances, const HemisphereGrid& start,
                              TableUse use, const TabulateOptions& options) {
  if (std::ranges::any_of(reflectances, has_own_grid)) return start;
  const ToTabulate all = to_tabulate(device, reflectances);
  return resolving_grid(device, all.formulas, all.functions, start, use, options);
}

HemisphereGrid resolving_grid(const Device& device, const ReflectanceList& reflectances, TableUse use,
                              const TabulateOptions& options) {
  const auto is_formula = [](const Reflectance& reflectance) { return reflectance.formula() != nullptr; };
  const auto own = std::ranges::find_if(reflectances, has_own_grid);
  if (own != reflectances.end()) return natural_grid(*own);
  const auto function = std::ranges::find_if_not(reflectances, is_formula);
  const Reflectance& first = function == reflectances.end() ? *reflectances.begin() : *function;
  return resolving_grid(device, reflectances, natural_grid(first), use, options);
}

std::string resolution_needed(const Device& device, const Reflectance& reflectance, const HemisphereGrid& grid,
                              const TabulateOptions& options) {
  const Reflectance prepared = adjusted(device, reflectance);
  if (const Material* formula = prepared.formula()) return resolution_needed(device, *formula, grid, options);
  if (const BrdfFunction* function = prepared.function()) return resolution_needed(*function, grid, options);
  return "";
}

}  // namespace lobe
