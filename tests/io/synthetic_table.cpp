#include "synthetic_table.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace lobe::test {
namespace {

double reflectance(const Direction& in, const Direction& out, std::size_t channel) {
  const double cosine =
      std::cos(in.theta) * std::cos(out.theta) - std::sin(in.theta) * std::sin(out.theta) * std::cos(out.phi - in.phi);
  return 0.1 * static_cast<double>(channel + 1) + 0.3 * std::exp(-8 * (1 - cosine));
}

void fill_isotropic(BrdfTable& table) {
  for (std::size_t c = 0; c < table.channels; ++c) {
    for (const Ring& in : table.grid.rings()) {
      for (const Ring& out : table.grid.rings()) {
        for (std::size_t k = 0; k < table.grid.half_azimuths(); ++k) {
          const double delta_phi = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(in.count);
          table.values.push_back(reflectance({in.theta, 0}, {out.theta, delta_phi}, c));
        }
      }
    }
  }
}

void fill_general(BrdfTable& table) {
  for (std::size_t c = 0; c < table.channels; ++c) {
    for (const Direction& in : table.grid.directions()) {
      for (const Direction& out : table.grid.directions()) table.values.push_back(reflectance(in, out, c));
    }
  }
}

/// Different numbers, one per row and channel.
std::vector<double> by_row(const BrdfTable& table, double first) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < table.channels * table.rows(); ++i) numbers.push_back(first / static_cast<double>(i + 3));
  return numbers;
}

}  // namespace

BrdfTable synthetic_table(const HemisphereGrid& grid, TableForm form, std::size_t channels) {
  BrdfTable table;
  table.grid = grid;
  table.form = form;
  table.channels = channels;
  form == TableForm::isotropic ? fill_isotropic(table) : fill_general(table);
  const std::size_t rings = grid.rings().size();
  table.error.assign(channels * rings * rings, 1e-9);
  for (std::size_t j = 0; j < rings; ++j) table.error[j] = std::numeric_limits<double>::quiet_NaN();
  table.expression = "synthetic";
  table.resolution_error = 1.0 / 3;
  return table;
}

BrdfTable synthetic_composition(const HemisphereGrid& grid, TableForm form, std::size_t channels) {
  BrdfTable table = synthetic_table(grid, form, channels);
  table.mirror = by_row(table, 0.5);
  table.retro = by_row(table, -0.25);
  table.expression = "compose(phong:n=20, ward:m=0.2)";
  table.source = {parse_material("phong:n=20"), parse_material("lambert:scale=0.1+ward:m=0.2")};
  table.is_unresolved = true;
  table.factors = {{"phong:n=20", by_row(table, 1), by_row(table, 2)},
                   {"ward:m=0.2", by_row(table, 3), by_row(table, 4)}};
  return table;
}

}  // namespace lobe::test
