#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "lobe/error.hpp"
#include "lobe/table.hpp"
#include "table/interpolator.hpp"
#include "table/nodes.hpp"
#include "table/norm.hpp"

namespace lobe {
namespace {

constexpr std::size_t kSamples = 2;  // per coordinate of a target's cell
constexpr double kResolved = 0.1;    // relative change of the squared norm

/// Average over the samples of two nodes.
Estimate average(const Interpolator& from, std::size_t channel, std::span<const Direction> in,
                 std::span<const Direction> out) {
  Estimate sum;
  for (const Direction& l : in) {
    for (const Direction& v : out) {
      const Estimate value = from.at(channel, l, v);
      sum.value += value.value;
      sum.error += value.error;
    }
  }
  const auto count = static_cast<double>(in.size() * out.size());
  return {sum.value / count, sum.error / count};
}

/// The same with half of the change that a single sample makes as the error of sampling, which is a third of it where
/// the table is smooth.
Estimate cell_average(const Interpolator& from, std::size_t channel, std::span<const Direction> in,
                      std::span<const Direction> out, Direction in_centre, Direction out_centre) {
  Estimate value = average(from, channel, in, out);
  if (in.size() * out.size() > 1)
    value.error += 0.5 * std::abs(value.value - from.at(channel, in_centre, out_centre).value);
  return value;
}

std::span<const Direction> samples_of(const DirectionSet& set, std::size_t node) {
  return std::span(set.directions).subspan(node * set.samples, set.samples);
}

}  // namespace

std::vector<std::vector<Estimate>> evaluate(const BrdfTable& table, std::span<const Directions> directions) {
  check(table);
  const Interpolator interpolator(table);
  std::vector<std::vector<Estimate>> values(table.channels);
  for (std::size_t c = 0; c < table.channels; ++c) {
    for (const auto& pair : directions) {
      if (!(pair.theta_in >= 0 && pair.theta_in <= std::numbers::pi / 2 && pair.theta_out >= 0 &&
            pair.theta_out <= std::numbers::pi / 2 && std::isfinite(pair.delta_phi) && std::isfinite(pair.phi_in))) {
        throw ArgumentError("directions (" + shortest(pair.theta_in) + ", " + shortest(pair.theta_out) + ", " +
                            shortest(pair.delta_phi) + ") rad; expected both theta in [0, pi/2]");
      }
      values[c].push_back(
          interpolator.at(c, {pair.theta_in, pair.phi_in}, {pair.theta_out, pair.phi_in + pair.delta_phi}));
    }
  }
  return values;
}

BrdfTable resample(const BrdfTable& table, const HemisphereGrid& grid) {
  check(table);
  if (table.grid == grid) return table;
  const Interpolator from(table);
  BrdfTable result;
  result.grid = grid;
  result.channels = table.channels;
  result.channel_names = table.channel_names;
  result.conventions = table.conventions;
  const bool is_isotropic = table.form == TableForm::isotropic && grid.is_product();
  result.form = is_isotropic ? TableForm::isotropic : TableForm::general;
  result.expression = "resample(" + table.expression + ", " + grid.name() + ")";
  result.source = {};
  result.resolution_error = std::numeric_limits<double>::quiet_NaN();
  result.is_unresolved = table.is_unresolved;

  const NodeSet rows = is_isotropic ? ring_nodes(grid, kSamples) : all_nodes(grid, kSamples);
  const NodeSet columns = is_isotropic ? half_nodes(grid, kSamples) : rows;
  const std::size_t count = columns.weights.size();
  const auto centre_of_row = [&](std::size_t i) {
    return grid.directions()[is_isotropic ? grid.rings()[i].first_node : i];
  };
  const auto centre_of_column = [&](std::size_t j) {
    if (!is_isotropic) return grid.directions()[j];
    return grid.directions()[grid.rings()[j / grid.half_azimuths()].first_node + j % grid.half_azimuths()];
  };
  const std::size_t rings = grid.rings().size();
  result.values.resize(result.channels * result.size());
  std::vector<double> row_errors(result.channels * result.rows() * rings);  // by row and ring of V
  for (std::size_t c = 0; c < result.channels; ++c) {
    parallel_for(result.rows(), [&](std::size_t i) {
      for (std::size_t j = 0; j < count; ++j) {
        const Estimate value = cell_average(from, c, samples_of(rows.directions, i), samples_of(columns.directions, j),
                                            centre_of_row(i), centre_of_column(j));
        result.channel(c)[i * count + j] = value.value;
        const std::size_t ring = is_isotropic ? j / grid.half_azimuths() : grid.ring_of(j);
        double& error = row_errors[(c * result.rows() + i) * rings + ring];
        if (!(value.error <= error)) error = value.error;
      }
    });
  }
  result.error.assign(result.channels * rings * rings, 0);
  for (std::size_t row = 0; row < result.channels * result.rows(); ++row) {
    const std::size_t channel = row / result.rows();
    const std::size_t i = row % result.rows();
    const std::size_t ring = is_isotropic ? i : grid.ring_of(i);
    for (std::size_t j = 0; j < rings; ++j) {
      double& error = result.error[(channel * rings + ring) * rings + j];
      if (!(row_errors[row * rings + j] <= error)) error = row_errors[row * rings + j];
    }
  }
  for (std::size_t c = 0; c < result.channels; ++c) {
    const double before = squared_norm(table, c);
    if (std::abs(squared_norm(result, c) - before) > kResolved * before) result.is_unresolved = true;
  }
  const auto move_part = [&](const std::vector<double>& parts, std::vector<double>& target) {
    if (parts.empty()) return;
    for (std::size_t c = 0; c < result.channels; ++c) {
      for (std::size_t i = 0; i < result.rows(); ++i) {
        double sum = 0;
        for (const Direction& sample : samples_of(rows.directions, i)) sum += from.row_part(parts, c, sample).value;
        target.push_back(sum / static_cast<double>(rows.directions.samples));
      }
    }
  };
  move_part(table.mirror, result.mirror);
  move_part(table.retro, result.retro);
  return result;
}

}  // namespace lobe
