#include "table/tabulate.hpp"

#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "reflectance/prepared.hpp"

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

HemisphereGrid choose_grid(const Device& device, const ReflectanceList& reflectances, const TabulateOptions& options) {
  std::vector<Material> formulas;
  std::vector<BrdfFunction> functions;
  for (const Reflectance& given : reflectances) {
    const Reflectance reflectance = adjusted(device, given);
    if (const Material* formula = reflectance.formula()) formulas.push_back(*formula);
    if (const BrdfFunction* function = reflectance.function()) functions.push_back(*function);
    if (const BrdfTable* table = reflectance.table(); table != nullptr && table->source.size() == 1) {
      formulas.push_back(table->source.front());
    }
  }
  return choose_grid(device, formulas, functions, options);
}

}  // namespace lobe
