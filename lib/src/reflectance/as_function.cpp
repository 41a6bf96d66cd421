#include "table/as_function.hpp"

#include "lobe/reflectance/adjusted.hpp"
#include "model/delta.hpp"
#include "reflectance/prepared.hpp"

namespace lobe {

BrdfFunction function_of(const Device& device, const Reflectance& reflectance, Precision precision) {
  if (const Material* formula = reflectance.formula()) return as_function(device, *formula, precision);
  if (const BrdfTable* table = reflectance.table()) return as_function(*table);
  return *reflectance.function();
}

BrdfFunction smooth_function(const Device& device, const Reflectance& reflectance, Precision precision) {
  if (!reflectance.has_delta()) return function_of(device, reflectance, precision);
  if (const Material* formula = reflectance.formula()) return as_function(device, smooth_part(*formula), precision);
  if (const BrdfFunction* function = reflectance.function()) return *function;
  BrdfTable smooth = *reflectance.table();
  smooth.mirror.clear();
  smooth.retro.clear();
  return as_function(smooth);
}

BrdfFunction as_function(const Device& device, const Reflectance& reflectance, Precision precision) {
  return function_of(device, adjusted(device, reflectance), precision);
}

}  // namespace lobe
