#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/table.hpp"
#include "model/delta.hpp"
#include "table/resolution.hpp"

namespace lobe {
namespace {

/// first_column of tabulate_pairs() for the upper triangle; none where all values are needed.
std::vector<unsigned> upper_triangle(std::size_t rows, std::size_t columns_per_row, bool is_reciprocal) {
  std::vector<unsigned> first;
  for (std::size_t i = 0; is_reciprocal && i < rows; ++i) first.push_back(static_cast<unsigned>(i * columns_per_row));
  return first;
}

/// Copies the upper triangle of rows x rows blocks to the lower one: reciprocal to the last bit.
void symmetrise(std::span<double> values, std::size_t rows, std::size_t block) {
  parallel_for(rows, [&](std::size_t i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::copy_n(values.data() + (j * rows + i) * block, block, values.data() + (i * rows + j) * block);
    }
  });
}

void fill_values(BrdfTable& table, const LobeTabulator& tabulator, std::size_t samples) {
  const bool is_isotropic = table.form == TableForm::isotropic;
  const NodeSet rows = is_isotropic ? ring_nodes(table.grid, samples) : all_nodes(table.grid, samples);
  const NodeSet columns = is_isotropic ? half_nodes(table.grid, samples) : rows;
  const std::size_t block = is_isotropic ? table.grid.half_azimuths() : 1;
  const auto first = upper_triangle(table.rows(), block, tabulator.is_reciprocal());
  table.values.resize(table.channels * table.size());
  for (std::size_t c = 0; c < table.channels; ++c) {
    tabulator.channel(c, rows.directions, columns.directions, first, table.channel(c));
    if (tabulator.is_reciprocal()) symmetrise(table.channel(c), table.rows(), block);
  }
}

/// Largest |value| and, on grids of cells, largest change from halved sampling, by pair of rings.
class ErrorOfValues {
 public:
  ErrorOfValues(const BrdfTable& table, const LobeTabulator& tabulator, std::size_t samples, Precision precision)
      : grid_(table.grid),
        // Rounding grows with the steepness of the lobe, see the error contracts of kernels/models/.
        relative_((precision == Precision::double_precision ? 2.2e-16 : 1.2e-7) *
                  (2 + 1 / std::pow(tabulator.lobes().narrowest, 2))) {
    const std::size_t rings = grid_.rings().size();
    table_error.assign(table.channels * rings * rings, 0);
    if (tabulator.lobes().lobes() == 0) return;
    const NodeSet rows = ring_nodes(grid_, samples);
    const NodeSet columns = row_nodes(grid_, samples);
    std::vector<double> fine(rows.weights.size() * columns.weights.size());
    std::vector<double> coarse(grid_.has_cells() && samples > 1 ? fine.size() : 0);
    for (std::size_t c = 0; c < table.channels; ++c) {
      tabulator.channel(c, rows.directions, columns.directions, {}, fine);
      if (!coarse.empty()) {
        tabulator.channel(c, ring_nodes(grid_, samples / 2).directions, row_nodes(grid_, samples / 2).directions, {},
                          coarse);
      }
      add(fine, coarse, c * rings * rings);
    }
  }

  std::vector<double> table_error;

 private:
  void add(std::span<const double> fine, std::span<const double> coarse, std::size_t offset) {
    const std::size_t rings = grid_.rings().size();
    const std::size_t columns = fine.size() / rings;
    for (std::size_t i = 0; i < rings; ++i) {
      for (std::size_t j = 0; j < columns; ++j) {
        const std::size_t ring = grid_.is_product() ? j / grid_.half_azimuths() : grid_.ring_of(j);
        const double value = fine[i * columns + j];
        // Halving the samples makes their error four times as large where f is smooth, twice where it jumps.
        const double sampling = coarse.empty() ? 0 : 0.5 * std::abs(value - coarse[i * columns + j]);
        double& error = table_error[offset + i * rings + ring];
        error = std::max(error, relative_ * std::abs(value) + sampling);
      }
    }
  }

  const HemisphereGrid& grid_;
  double relative_;
};

/// channels x rows of one factor per channel; none where all are zero.
std::vector<double> delta_rows(std::span<const double> factors, std::size_t rows) {
  std::vector<double> parts;
  if (std::ranges::all_of(factors, [](double factor) { return factor == 0; })) return parts;
  for (const double factor : factors) parts.insert(parts.end(), rows, factor);
  return parts;
}

void require_resolved(BrdfTable& table, const LobeTabulator& tabulator, const std::string& name,
                      const TabulateOptions& options) {
  const Resolution worst = measure_resolution(tabulator, table.grid, options.samples);
  table.resolution_error = worst.error;
  if (worst.error <= options.tolerance) return;
  if (!options.allow_unresolved) {
    throw NumericError("grid " + table.grid.name() + " does not resolve the lobe " +
                       tabulator.lobes().names[worst.lobe] + " of '" + name + "' (its squared norm is off by " +
                       shortest(std::round(worst.error * 1000) / 10) + " %, expected at most " +
                       shortest(options.tolerance * 100) + " %); it needs " +
                       resolution_needed(tabulator, table.grid, options.tolerance));
  }
  table.is_unresolved = true;
}

}  // namespace

BrdfTable tabulate(const Device& device, const Material& material, const HemisphereGrid& grid,
                   const TabulateOptions& options) {
  if (options.samples < 1) throw ArgumentError("0 samples per cell; expected at least 1");
  const DeltaSplit split = split_delta(material);
  const LobeTabulator tabulator(device, split.smooth, options.precision);
  BrdfTable table;
  table.grid = grid;
  table.form = grid.is_product() ? TableForm::isotropic : TableForm::general;
  table.channels = material.channels();
  table.expression = material.name;
  table.mirror = delta_rows(split.mirror, table.rows());
  table.retro = delta_rows(split.retro, table.rows());
  if (!split.smooth.terms.empty()) {
    require_resolved(table, tabulator, material.name, options);
    table.source = {split.smooth};
  }
  fill_values(table, tabulator, options.samples);
  table.error = ErrorOfValues(table, tabulator, options.samples, options.precision).table_error;
  if (options.form == TableForm::general) return to_general(table);
  return table;
}

HemisphereGrid choose_grid(const Device& device, std::span<const Material> materials, const TabulateOptions& options) {
  std::vector<LobeTabulator> tabulators;
  for (const auto& material : materials) {
    const auto smooth = split_delta(material).smooth;
    if (!smooth.terms.empty()) tabulators.emplace_back(device, smooth, options.precision);
  }
  constexpr std::size_t kLargest = 1024;
  double reached = 0;
  const LobeTabulator* worst = nullptr;
  std::size_t worst_lobe = 0;
  for (std::size_t rings = 8; rings <= kLargest; rings = (rings & (rings - 1)) == 0 ? rings / 2 * 3 : rings / 3 * 4) {
    auto grid = HemisphereGrid::gauss(rings, 2 * rings);
    bool is_fine = true;
    for (const auto& tabulator : tabulators) {
      const Resolution found = measure_resolution(tabulator, grid, 1);
      if (found.error <= options.tolerance) continue;
      is_fine = false;
      reached = found.error;
      worst = &tabulator;
      worst_lobe = found.lobe;
      break;
    }
    if (is_fine) return grid;
  }
  throw NumericError("lobe " + worst->lobes().names[worst_lobe] + " is resolved to " + shortest(reached) +
                     " only by gauss:1024x2048; expected " + shortest(options.tolerance) + ", give a larger tolerance");
}

}  // namespace lobe
