#pragma once

#include <string>

#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/material.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/table.hpp"
#include "support/device.hpp"

namespace lobe::test {

/// A material on a grid, whether that resolves its lobes or not.
inline BrdfTable table_of(const Material& material, const HemisphereGrid& grid, TableForm form = TableForm::isotropic) {
  TabulateOptions options;
  options.allow_unresolved = true;
  options.form = form;
  return tabulate(device(), material, grid, options);
}

inline BrdfTable table_of(const std::string& specification, const HemisphereGrid& grid,
                          TableForm form = TableForm::isotropic) {
  return table_of(parse_material(specification), grid, form);
}

inline BrdfTable table_of(const std::string& specification, const std::string& grid = "gauss:16x32",
                          TableForm form = TableForm::isotropic) {
  return table_of(specification, HemisphereGrid::parse(grid), form);
}

}  // namespace lobe::test
