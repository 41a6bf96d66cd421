#include "lobe/table/cell_error.hpp"

#include <cmath>

#include "core/parallel.hpp"
#include "table/interpolator.hpp"
#include "table/norm.hpp"

namespace lobe {

bool is_constant_on_cells(const BrdfTable& table) {
  return table.grid.has_cells() && !table.grid.is_product();
}

std::vector<double> cell_error(const BrdfTable& table) {
  check(table);
  std::vector<double> errors(table.channels);
  if (!is_constant_on_cells(table)) return errors;
  const Interpolator interpolator(table);
  const auto weights = table.grid.weights();
  for (std::size_t c = 0; c < table.channels; ++c) {
    std::vector<double> squares(table.grid.nodes());
    parallel_for(squares.size(), [&](std::size_t in) {
      for (std::size_t out = 0; out < squares.size(); ++out) {
        const double change = interpolator.cell_change(c, in, out);
        squares[in] += weights[in] * weights[out] * change * change;
      }
    });
    double square = 0;
    for (const double part : squares) square += part;
    if (square > 0) errors[c] = std::sqrt(square / squared_norm(table, c));
  }
  return errors;
}

std::vector<std::vector<double>> albedo_cell_error(const BrdfTable& table, std::span<const Direction> incident) {
  check(table);
  std::vector<std::vector<double>> errors(table.channels, std::vector<double>(incident.size()));
  if (!is_constant_on_cells(table)) return errors;
  const Interpolator interpolator(table);
  for (std::size_t c = 0; c < table.channels; ++c) {
    for (std::size_t i = 0; i < incident.size(); ++i) {
      const std::size_t in = table.grid.node_at(incident[i]);
      for (std::size_t out = 0; out < table.grid.nodes(); ++out) {
        errors[c][i] += table.grid.weights()[out] * interpolator.cell_change(c, in, out);
      }
      errors[c][i] += interpolator.row_part(table.mirror, c, incident[i]).error +
                      interpolator.row_part(table.retro, c, incident[i]).error;
    }
  }
  return errors;
}

}  // namespace lobe
