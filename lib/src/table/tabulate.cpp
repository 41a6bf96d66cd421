#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "hemisphere/mirror_panels.hpp"
#include "lobe/core/error.hpp"
#include "lobe/table/table.hpp"
#include "model/delta_shares.hpp"
#include "model/evaluate.hpp"
#include "model/lobes.hpp"
#include "model/values.hpp"
#include "table/cell_average.hpp"
#include "table/resolution.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

constexpr std::size_t kMostCellPoints = 64;

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

/// Values at nodes.
void fill_values(BrdfTable& table, const LobeTabulator& tabulator) {
  const bool is_isotropic = table.form == TableForm::isotropic;
  const NodeSet rows = is_isotropic ? ring_nodes(table.grid, 1) : all_nodes(table.grid, 1);
  const NodeSet columns = is_isotropic ? half_nodes(table.grid, 1) : rows;
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

/// Bounds on the errors of a table's values at nodes, [channel][ring][ring]: rounding.
std::vector<double> value_errors(const BrdfTable& table, double relative) {
  const HemisphereGrid& grid = table.grid;
  const std::size_t rings = grid.rings().size();
  std::vector<double> errors(table.channels * rings * rings, 0.0);
  for (std::size_t c = 0; c < table.channels; ++c) {
    const auto values = table.channel(c);
    for (std::size_t at = 0; at < values.size(); ++at) {
      const std::size_t pair = table.form == TableForm::isotropic
                                   ? at / grid.half_azimuths()
                                   : grid.ring_of(at / grid.nodes()) * rings + grid.ring_of(at % grid.nodes());
      double& error = errors[c * rings * rings + pair];
      error = std::max(error, relative * std::abs(values[at]));
    }
  }
  return errors;
}

/// Averages over cells, with their errors.
void fill_averages(BrdfTable& table, const LobeTabulator& tabulator, const Device& device, const Material& smooth,
                   const TabulateOptions& options, const CellEffort& effort) {
  if (smooth.terms.empty()) {
    const std::size_t rings = table.grid.rings().size();
    table.values.assign(table.channels * table.size(), 0.0);
    table.error.assign(table.channels * rings * rings, 0.0);
    return;
  }
  constexpr double kQuickly = 4;  // times the rounding of nodes that are made closely; see NodeMaking
  const double relative = kQuickly * rounding(tabulator, options.precision);
  const auto channels = static_cast<Eigen::Index>(table.channels);
  MaterialValues material_values(device, smooth, options.precision, NodeMaking::quickly);
  const auto values_at = [&](std::span<const Directions> pairs) {
    BrdfValues values{material_values.at(pairs), {}};
    if (values.value.cols() < channels) values.value = values.value.replicate(1, channels).eval();
    values.error = relative * values.value.cwiseAbs();
    return values;
  };
  average_over_cells({.name = smooth.name,
                      .at = values_at,
                      .is_isotropic = tabulator.is_isotropic(),
                      .is_bilateral = tabulator.is_isotropic(),
                      .is_reciprocal = tabulator.is_reciprocal(),
                      .is_concurrent = false,
                      .width = tabulator.lobes().narrowest,
                      .retro_width = tabulator.lobes().narrowest_retro,
                      .rounding = relative,
                      .effort = effort},
                     table, options.cell_points, options.progress);
}

/// Polar angles at which the shares of mirrors are not smooth.
std::vector<PanelEdge> kinks_of_mirrors(const Material& deltas) {
  constexpr std::array kHemisphere{PanelEdge{0}, PanelEdge{std::numbers::pi / 2}};
  std::vector<PanelEdge> kinks;
  if (deltas.terms.empty()) return kinks;
  const LobeSet lobes = make_lobe_set(std::span(&deltas, 1), {.with_deltas = true});
  for (const PeakKink& peak : lobes.peak_kinks) {
    for (const PanelEdge& crossing : peak_crossings(peak, kHemisphere)) {
      kinks.push_back({std::numbers::pi / 2 - crossing.at, crossing.root});
    }
  }
  return kinks;
}

/// Light that delta parts reflect, channels x rows, as a table has it, averages over cells where it has such; none
/// where all are zero.
void fill_deltas(BrdfTable& table, const Device& device, const Material& deltas) {
  constexpr std::size_t kNodes = 16;  // of a ring, or of the parts between kinks, on which shares are smooth
  const std::vector<PanelEdge> kinks = kinks_of_mirrors(deltas);
  std::vector<double> elevations;
  std::vector<RingRule> rules;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::size_t node = table.form == TableForm::isotropic ? table.grid.rings()[row].first_node : row;
    rules.push_back(ring_rule(table.grid, node, kNodes, kinks));
    for (const double theta : rules.back().thetas) elevations.push_back(std::numbers::pi / 2 - theta);
  }
  const DeltaParts parts = delta_parts(device, deltas, table.channels, elevations);
  const auto averages = [&](const Eigen::MatrixXd& shares) {
    std::vector<double> result;
    if (shares.isZero(0)) return result;
    for (Eigen::Index c = 0; c < shares.rows(); ++c) {
      Eigen::Index at = 0;
      for (const RingRule& rule : rules) {
        // From the first one on: constant shares stay what they are, to the bit.
        const double first = shares(c, at);
        double change = 0;
        for (const double weight : rule.weights) change += weight * (shares(c, at++) - first);
        result.push_back(first + change);
      }
    }
    return result;
  };
  table.mirror = averages(parts.mirror);
  table.retro = averages(parts.retro);
}

std::string refusal(const LobeTabulator& tabulator, const HemisphereGrid& grid, const Resolution& worst,
                    const std::string& name, const TabulateOptions& options) {
  return "grid " + grid.name() + " does not resolve the lobe " + tabulator.lobes().names[worst.lobe] + " of '" + name +
         "' (integrals of its square are off by " + shortest(std::round(worst.error * 1000) / 10) +
         " %, expected at most " + shortest(options.tolerance * 100) + " %); it needs " +
         resolution_needed(tabulator, grid, options.tolerance);
}

/// What becomes of a table whose grid does not resolve a lobe.
enum class IfUnresolved { refused, left_out };

std::optional<BrdfTable> make_table(const Device& device, const Material& material, const HemisphereGrid& grid,
                                    const TabulateOptions& options, IfUnresolved if_unresolved,
                                    const CellEffort& effort) {
  if (options.cell_points < 1 || options.cell_points > kMostCellPoints) {
    throw ArgumentError(std::to_string(options.cell_points) + " points per coordinate of a cell; expected 1 to " +
                        std::to_string(kMostCellPoints));
  }
  const DeltaSplit split = split_delta(material);
  const LobeTabulator tabulator(device, split.smooth, options.precision);
  BrdfTable table;
  table.grid = grid;
  table.form = grid.is_product() && tabulator.is_isotropic() ? TableForm::isotropic : TableForm::general;
  table.channels = material.channels();
  table.expression = material.name;
  fill_deltas(table, device, split.deltas);
  if (!split.smooth.terms.empty()) {
    const Resolution worst = measure_resolution(tabulator, grid, options.cell_points);
    table.resolution_error = worst.error;
    table.is_unresolved = !(worst.error <= options.tolerance);
    if (table.is_unresolved && !options.allow_unresolved) {
      if (if_unresolved == IfUnresolved::left_out) return std::nullopt;
      throw UnresolvedError(refusal(tabulator, grid, worst, material.name, options));
    }
    table.source = {split.smooth};
  }
  if (grid.has_cells()) {
    fill_averages(table, tabulator, device, split.smooth, options, effort);
  } else {
    fill_values(table, tabulator);
    table.error = value_errors(table, tabulator.lobes().lobes() == 0 ? 0 : rounding(tabulator, options.precision));
  }
  if (!std::ranges::all_of(table.values, [](double value) { return std::isfinite(value); })) {
    throw NumericError("'" + material.name + "' has values on " + grid.name() +
                       " that are no finite numbers; check the parameters of the material");
  }
  if (options.form == TableForm::general) return to_general(table);
  return table;
}

}  // namespace

std::string resolution_needed(const Device& device, const Material& material, const HemisphereGrid& grid,
                              const TabulateOptions& options) {
  return resolution_needed(LobeTabulator(device, split_delta(material).smooth, options.precision), grid,
                           options.tolerance);
}

BrdfTable tabulate(const Device& device, const Material& material, const HemisphereGrid& grid,
                   const TabulateOptions& options) {
  return *make_table(device, material, grid, options, IfUnresolved::refused, {});
}

std::optional<BrdfTable> tabulate_if_resolved(const Device& device, const Material& material,
                                              const HemisphereGrid& grid, const TabulateOptions& options,
                                              const CellEffort& effort) {
  return make_table(device, material, grid, options, IfUnresolved::left_out, effort);
}

}  // namespace lobe
