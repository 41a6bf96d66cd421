#pragma once

#include "energy/prepare.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// One call operator for each of several types.
template <typename... Functions>
struct Cases : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Cases(Functions...) -> Cases<Functions...>;

/// Calls `on` with what a reflectance is known as: its formulas, prepared, a function of values, or a table, as which
/// functions that are constant on cells are known, too.
/// \throws as prepare()
template <typename Function>
auto known_as(const Device& device, const Reflectance& reflectance, const Function& on) {
  if (const Material* formula = reflectance.formula()) {
    return needs_preparation(*formula) ? on(prepare(device, *formula)) : on(*formula);
  }
  if (const BrdfTable* table = reflectance.table()) return on(*table);
  const BrdfFunction& function = *reflectance.function();
  return function.cells ? on(*function.cells) : on(function);
}

}  // namespace lobe
