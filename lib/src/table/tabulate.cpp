#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/table.hpp"
#include "model/delta_shares.hpp"
#include "table/resolution.hpp"

namespace lobe {
namespace {

constexpr std::size_t kLargestSamples = 64;

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

/// Rounding of values relative to them: it grows with the steepness of the lobe, see the error contracts of
/// kernels/models/.
double rounding(const LobeTabulator& tabulator, Precision precision) {
  const double eps = precision == Precision::double_precision ? 2.2e-16 : 1.2e-7;
  return eps * (2 + 1 / std::pow(tabulator.lobes().sharpest(), 2));
}

/// Values of a channel between one node per ring and all nodes of a row; where the azimuth of L counts, between all.
TableValues ring_values(const LobeTabulator& tabulator, std::size_t channel, const HemisphereGrid& grid,
                        std::size_t samples) {
  const bool is_isotropic = tabulator.is_isotropic();
  const NodeSet rows = is_isotropic ? ring_nodes(grid, samples) : all_nodes(grid, samples);
  const NodeSet columns = is_isotropic ? row_nodes(grid, samples) : rows;
  TableValues values(rows.weights.size() * columns.weights.size());
  tabulator.channel(channel, rows.directions, columns.directions, {}, values);
  return values;
}

/// Bounds on the errors of a table's values, [channel][ring][ring]: rounding and, on grids of cells, what halving the
/// samples changes.
std::vector<double> value_errors(const BrdfTable& table, const LobeTabulator& tabulator, std::size_t samples,
                                 Precision precision) {
  const HemisphereGrid& grid = table.grid;
  const std::size_t rings = grid.rings().size();
  std::vector<double> errors(table.channels * rings * rings, 0.0);
  if (tabulator.lobes().lobes() == 0) return errors;
  const bool is_isotropic = tabulator.is_isotropic();
  const double relative = rounding(tabulator, precision);
  // Halving the samples makes their error four times as large where f is smooth, less than twice where it is steepest
  // at grazing angles. A single sample has no half and is held against two.
  const double share = samples > 1 ? 1 : 2;
  for (std::size_t c = 0; c < table.channels; ++c) {
    const auto sampled = is_isotropic ? ring_values(tabulator, c, grid, samples) : TableValues();
    const std::span<const double> fine = is_isotropic ? std::span<const double>(sampled) : table.channel(c);
    const auto other =
        grid.has_cells() ? ring_values(tabulator, c, grid, samples > 1 ? samples / 2 : 2) : TableValues();
    const std::size_t columns = is_isotropic ? fine.size() / rings : grid.nodes();
    for (std::size_t at = 0; at < fine.size(); ++at) {
      const std::size_t row = is_isotropic ? at / columns : grid.ring_of(at / columns);
      const std::size_t column = at % columns;
      const bool is_half = is_isotropic && grid.is_product();
      const std::size_t ring = is_half ? column / grid.half_azimuths() : grid.ring_of(column);
      const double sampling = other.empty() ? 0 : share * std::abs(fine[at] - other[at]);
      double& error = errors[(c * rings + row) * rings + ring];
      error = std::max(error, relative * std::abs(fine[at]) + sampling);
    }
  }
  return errors;
}

/// Elevations (radians above the horizon) of a table's rows, of cells those of their samples: as many for every row.
std::vector<double> elevations_of_rows(const BrdfTable& table, std::size_t samples) {
  const NodeSet rows =
      table.form == TableForm::isotropic ? ring_nodes(table.grid, samples) : all_nodes(table.grid, samples);
  std::vector<double> elevations;
  for (const Direction& at : rows.directions.directions) elevations.push_back(std::numbers::pi / 2 - at.theta);
  return elevations;
}

/// Means over the samples of rows, channels x rows, as a table has them; none where all are zero.
std::vector<double> delta_rows(const Eigen::MatrixXd& of_samples, std::size_t rows) {
  if (of_samples.isZero(0)) return {};
  const auto count = static_cast<Eigen::Index>(rows);
  const Eigen::Index samples = of_samples.cols() / count;
  Eigen::MatrixXd shares(of_samples.rows(), count);
  for (Eigen::Index row = 0; row < count; ++row) {
    shares.col(row) = of_samples.middleCols(row * samples, samples).rowwise().mean();
  }
  std::vector<double> parts;
  for (Eigen::Index c = 0; c < shares.rows(); ++c)
    parts.insert(parts.end(), shares.row(c).begin(), shares.row(c).end());
  return parts;
}

void require_resolved(BrdfTable& table, const LobeTabulator& tabulator, const std::string& name,
                      const TabulateOptions& options) {
  const Resolution worst = measure_resolution(tabulator, table.grid, options.samples);
  table.resolution_error = worst.error;
  if (worst.error <= options.tolerance) return;
  if (!options.allow_unresolved) {
    throw NumericError("grid " + table.grid.name() + " does not resolve the lobe " +
                       tabulator.lobes().names[worst.lobe] + " of '" + name + "' (integrals of its square are off by " +
                       shortest(std::round(worst.error * 1000) / 10) + " %, expected at most " +
                       shortest(options.tolerance * 100) + " %); it needs " +
                       resolution_needed(tabulator, table.grid, options.tolerance));
  }
  table.is_unresolved = true;
}

}  // namespace

BrdfTable tabulate(const Device& device, const Material& material, const HemisphereGrid& grid,
                   const TabulateOptions& options) {
  if (options.samples < 1 || options.samples > kLargestSamples) {
    throw ArgumentError(std::to_string(options.samples) + " samples per coordinate of a cell; expected 1 to " +
                        std::to_string(kLargestSamples));
  }
  const DeltaSplit split = split_delta(material);
  const LobeTabulator tabulator(device, split.smooth, options.precision);
  BrdfTable table;
  table.grid = grid;
  table.form = grid.is_product() && tabulator.is_isotropic() ? TableForm::isotropic : TableForm::general;
  table.channels = material.channels();
  table.expression = material.name;
  const DeltaParts deltas =
      delta_parts(device, split.deltas, table.channels, elevations_of_rows(table, options.samples));
  table.mirror = delta_rows(deltas.mirror, table.rows());
  table.retro = delta_rows(deltas.retro, table.rows());
  if (!split.smooth.terms.empty()) {
    require_resolved(table, tabulator, material.name, options);
    table.source = {split.smooth};
  }
  fill_values(table, tabulator, options.samples);
  table.error = value_errors(table, tabulator, options.samples, options.precision);
  if (options.form == TableForm::general) return to_general(table);
  return table;
}

HemisphereGrid choose_grid(const Device& device, std::span<const Material> materials, const TabulateOptions& options) {
  std::vector<LobeTabulator> tabulators;
  for (const auto& material : materials) {
    const auto smooth = split_delta(material).smooth;
    if (!smooth.terms.empty()) tabulators.emplace_back(device, smooth, options.precision);
  }
  constexpr std::size_t kLargest = 512;
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
                     " only by gauss:512x1024; expected " + shortest(options.tolerance) + ", give a larger tolerance");
}

}  // namespace lobe
