#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "hemisphere/embedded_rule.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/table/cell_error.hpp"
#include "lobe/table/table.hpp"
#include "table/delta_parts.hpp"
#include "table/evaluate.hpp"
#include "table/even_error.hpp"
#include "table/interpolator.hpp"
#include "table/mean_quadrature.hpp"
#include "table/ring_bounds.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Projected solid angles that a row's values are summed with, isotropic [theta_out][k], general [node_out].
struct Weights {
  std::vector<double> full;
  std::vector<double> embedded;  ///< every second ring and azimuth; empty on cells, whose averages sum up exactly
  std::vector<double> other;     ///< the rings that are not in `embedded`
};

Weights column_weights(const HemisphereGrid& grid, TableForm form) {
  Weights weights;
  const bool is_isotropic = form == TableForm::isotropic;
  const auto embedded = grid.has_cells() ? std::vector<double>() : embedded_ring_weights(grid);
  const auto other = grid.has_cells() ? std::vector<double>() : other_ring_weights(grid);
  for (std::size_t r = 0; r < grid.rings().size(); ++r) {
    const Ring& ring = grid.rings()[r];
    const std::size_t azimuths = is_isotropic ? grid.half_azimuths() : ring.count;
    for (std::size_t k = 0; k < azimuths; ++k) {
      // A half turn stands for a whole one.
      const double share = !is_isotropic || k == 0 || 2 * k == ring.count ? 1 : 2;
      weights.full.push_back(ring.weight * share);
      if (embedded.empty()) continue;
      const double step = 2 * pi / static_cast<double>(ring.count);
      weights.embedded.push_back(k % 2 == 0 ? 2 * share * step * embedded[r] : 0);
      weights.other.push_back(k % 2 == 0 ? 2 * share * step * other[r] : 0);
    }
  }
  return weights;
}

/// Integrals of a channel's smooth part over V and over L, by row.
struct Sums {
  std::vector<double> in;
  std::vector<double> out;
};

Sums integrate(const BrdfTable& table, std::size_t channel, std::span<const double> weights) {
  const std::size_t rows = table.rows();
  const std::size_t block = table.size() / (rows * rows);
  const double* const values = table.channel(channel).data();
  Sums sums{std::vector<double>(rows), std::vector<double>(rows)};
  parallel_for(rows, [&](std::size_t i) {
    const double* const row = values + i * rows * block;
    for (std::size_t at = 0; at < rows * block; ++at) sums.in[i] += weights[at] * row[at];
  });
  for (std::size_t i = 0; i < rows; ++i) {
    const double* const row = values + i * rows * block;
    for (std::size_t j = 0; j < rows; ++j) {
      // f(L, V) depends on the difference of azimuths alone: those of V at L are those of L at V.
      for (std::size_t k = 0; k < block; ++k) sums.out[j] += weights[i * block + k] * row[j * block + k];
    }
  }
  return sums;
}

/// Integrals over the other direction's rings of the bound on the values' errors, by ring.
std::vector<double> integrate_error(const BrdfTable& table, std::size_t channel, bool over_out) {
  const auto rings = table.grid.rings();
  const auto errors = even_errors(table, channel);
  std::vector<double> sums(rings.size());
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (std::size_t j = 0; j < rings.size(); ++j) {
      const double weight = rings[j].weight * static_cast<double>(rings[j].count);
      sums[i] += weight * errors[over_out ? i * rings.size() + j : j * rings.size() + i];
    }
  }
  return sums;
}

std::size_t ring_of_row(const BrdfTable& table, std::size_t row) {
  return table.form == TableForm::isotropic ? row : table.grid.ring_of(row);
}

/// Row that the mirror sends a row to.
std::size_t mirrored_row(const BrdfTable& table, std::size_t row) {
  return table.form == TableForm::isotropic ? row : table.grid.opposite(row);
}

/// Bounds on the quadrature errors of sums over rows, by ring.
std::vector<double> quadrature_errors(const BrdfTable& table, std::span<const double> full,
                                      std::span<const double> coarse, std::span<const double> other) {
  std::vector<double> changes(table.grid.rings().size());
  for (std::size_t row = 0; row < full.size(); ++row) {
    double& change = changes[ring_of_row(table, row)];
    change = std::max(change, kEmbeddedSafety * std::hypot(full[row] - coarse[row], full[row] - other[row]));
  }
  return spread_over_rings(changes);
}

/// The mean over rows by a rule for rows, (1.20).
double mean(const BrdfTable& table, std::span<const Estimate> by_row, std::span<const double> weights) {
  const std::size_t block = table.size() / (table.rows() * table.rows());
  double sum = 0;
  for (std::size_t at = 0; at < weights.size(); ++at) sum += weights[at] * by_row[at / block].value;
  return sum / pi;
}

/// Albedo for light into a node's cell, an exact sum.
/// \param errors of the values, integrated over V, by ring
Estimate cell_albedo(const BrdfTable& table, std::size_t channel, std::size_t row, std::span<const double> errors) {
  const std::size_t nodes = table.grid.nodes();
  const auto values = table.channel(channel).subspan(row * nodes, nodes);
  double sum = delta_part(table.mirror, channel * nodes + row) + delta_part(table.retro, channel * nodes + row);
  for (std::size_t out = 0; out < nodes; ++out) sum += table.grid.weights()[out] * values[out];
  return {sum, errors[table.grid.ring_of(row)]};
}

}  // namespace

TableAlbedo row_albedos(const BrdfTable& table) {
  check(table);
  TableAlbedo result;
  const std::size_t rows = table.rows();
  const Weights weights = column_weights(table.grid, table.form);
  for (std::size_t c = 0; c < table.channels; ++c) {
    const Sums sums = integrate(table, c, weights.full);
    const Sums coarse = weights.embedded.empty() ? sums : integrate(table, c, weights.embedded);
    const Sums other = weights.other.empty() ? sums : integrate(table, c, weights.other);
    const auto in_error = integrate_error(table, c, true);
    const auto out_error = integrate_error(table, c, false);
    const auto in_quadrature = quadrature_errors(table, sums.in, coarse.in, other.in);
    const auto out_quadrature = quadrature_errors(table, sums.out, coarse.out, other.out);
    std::vector<Estimate> in;
    std::vector<Estimate> out;
    double mean_error = weights.embedded.empty() ? 0 : mean_quadrature_error(table, c);
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t ring = ring_of_row(table, row);
      const std::size_t at = c * rows + row;
      const double retro = delta_part(table.retro, at);
      in.push_back({sums.in[row] + delta_part(table.mirror, at) + retro, in_error[ring] + in_quadrature[ring]});
      out.push_back({sums.out[row] + delta_part(table.mirror, c * rows + mirrored_row(table, row)) + retro,
                     out_error[ring] + out_quadrature[ring]});
      const Ring& of_row = table.grid.rings()[ring];
      const bool is_isotropic = table.form == TableForm::isotropic;
      mean_error += of_row.weight * (is_isotropic ? static_cast<double>(of_row.count) : 1) / pi * in_error[ring];
    }
    Estimate average{mean(table, in, weights.full), mean_error};
    if (!weights.embedded.empty()) {
      average.error += kEmbeddedSafety * std::hypot(average.value - mean(table, in, weights.embedded),
                                                    average.value - mean(table, in, weights.other));
    }
    result.in.push_back(std::move(in));
    result.out.push_back(std::move(out));
    result.mean.push_back(average);
  }
  return result;
}

std::vector<std::vector<Estimate>> albedo(const BrdfTable& table, std::span<const double> theta_in) {
  std::vector<Direction> incident;
  for (const double theta : theta_in) incident.push_back({theta, 0});
  return albedo(table, incident);
}

std::vector<std::vector<Estimate>> albedo(const BrdfTable& table, std::span<const Direction> incident) {
  check(table);
  const Interpolator interpolator(table);
  const Weights weights = column_weights(table.grid, TableForm::general);
  const Weights row_weights = column_weights(table.grid, table.form);
  std::vector<std::vector<Estimate>> result(table.channels);
  for (std::size_t c = 0; c < table.channels; ++c) {
    std::vector<double> at_rings(table.grid.rings().size());
    if (!weights.embedded.empty()) {
      at_rings =
          quadrature_errors(table, integrate(table, c, row_weights.full).in,
                            integrate(table, c, row_weights.embedded).in, integrate(table, c, row_weights.other).in);
    }
    const auto of_cells = is_constant_on_cells(table) ? integrate_error(table, c, true) : std::vector<double>();
    for (const Direction& in : incident) {
      if (!(in.theta >= 0 && in.theta < pi / 2)) {
        throw ArgumentError("angle of incidence of " + shortest(to_degrees(in.theta)) +
                            " degrees; expected a value in [0, 90) degrees");
      }
      if (is_constant_on_cells(table)) {
        result[c].push_back(cell_albedo(table, c, table.grid.node_at(in), of_cells));
        continue;
      }
      Estimate sum = interpolator.row_part(table.mirror, c, in) + interpolator.row_part(table.retro, c, in);
      double coarse = 0;
      double other = 0;
      double full = 0;
      for (std::size_t node = 0; node < table.grid.nodes(); ++node) {
        const Estimate value = interpolator.at(c, in, table.grid.directions()[node]);
        full += weights.full[node] * value.value;
        coarse += weights.embedded.empty() ? 0 : weights.embedded[node] * value.value;
        other += weights.other.empty() ? 0 : weights.other[node] * value.value;
        sum.error += weights.full[node] * value.error;
      }
      sum.value += full;
      const double at_ring = at_rings[table.grid.ring_of(table.grid.node_at(in))];
      if (!weights.embedded.empty()) {
        sum.error += std::max(kEmbeddedSafety * std::hypot(full - coarse, full - other), at_ring);
      }
      result[c].push_back(sum);
    }
  }
  return result;
}

}  // namespace lobe
