#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lobe/table/table.hpp"

namespace lobe {

/// A dimension of a table's file, with its coordinate.
struct TableAxis {
  std::string name;
  std::string long_name;
  std::size_t length = 0;
  std::vector<double> radians;  ///< the coordinate; empty: the numbers 1 .. length
};

/// Numbers along one axis that follow from the grid.
struct TableVariable {
  std::string name;
  std::string long_name;
  const char* units = "1";
  std::size_t axis = 0;  ///< index of its axis
  std::vector<double> values;
};

/// Names and shapes in the file of a table (docs/file-formats.md): the same for writing and reading.
struct TableLayout {
  std::vector<TableAxis> axes;  ///< by order of creation; the others are indices into this list
  std::vector<std::size_t> in;  ///< of brdf, first those of L
  std::vector<std::size_t> out;
  std::vector<std::size_t> viewer;  ///< of numbers by V: those of `out` without the difference of azimuths
  std::size_t ring_in = 0;          ///< of brdf_error
  std::size_t ring_out = 0;
  std::vector<TableVariable> variables;
  std::string coordinates;  ///< names of the variables that say where the nodes of brdf lie; empty: its axes do

  [[nodiscard]] std::vector<std::size_t> lengths(const std::vector<std::size_t>& indices) const;
};

[[nodiscard]] TableLayout table_layout(const HemisphereGrid& grid, TableForm form);

}  // namespace lobe
