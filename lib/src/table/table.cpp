#include "lobe/table/table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/parallel.hpp"
#include "lobe/core/error.hpp"
#include "table/even_error.hpp"
#include "table/norm.hpp"

namespace lobe {
namespace {

void require_size(std::size_t size, std::size_t expected, const char* part) {
  if (size == expected) return;
  throw ArgumentError(std::string("table has ") + std::to_string(size) + " numbers in its " + part + "; expected " +
                      std::to_string(expected));
}

/// Weights that a row's values are summed with: [theta_out][k] or [node_out].
std::vector<double> column_weights(const BrdfTable& table) {
  if (table.form == TableForm::general) return {table.grid.weights().begin(), table.grid.weights().end()};
  std::vector<double> weights;
  const std::size_t half = table.grid.half_azimuths();
  for (const Ring& ring : table.grid.rings()) {
    for (std::size_t k = 0; k < half; ++k) weights.push_back(ring.weight * (k == 0 || k + 1 == half ? 1 : 2));
  }
  return weights;
}

/// Weights of rows: projected solid angles of rings or nodes.
std::vector<double> row_weights(const BrdfTable& table) {
  if (table.form == TableForm::general) return {table.grid.weights().begin(), table.grid.weights().end()};
  std::vector<double> weights;
  for (const Ring& ring : table.grid.rings()) weights.push_back(ring.weight * static_cast<double>(ring.count));
  return weights;
}

}  // namespace

void check(const BrdfTable& table) {
  if (table.channels < 1) throw ArgumentError("table without channels; expected at least 1");
  if (table.form == TableForm::isotropic && !table.grid.is_product()) {
    throw ArgumentError("isotropic table on grid " + table.grid.name() + "; expected a product grid");
  }
  const std::size_t rings = table.grid.rings().size();
  require_size(table.values.size(), table.channels * table.size(), "values");
  require_size(table.error.size(), table.channels * rings * rings, "errors");
  require_size(table.odd_part.size(), table.even_error.size(), "odd part");
  if (!table.even_error.empty()) {
    require_size(table.even_error.size(), table.channels * rings * rings, "errors of the even part");
  }
  if (!table.mirror.empty()) require_size(table.mirror.size(), table.channels * table.rows(), "mirror part");
  if (!table.retro.empty()) require_size(table.retro.size(), table.channels * table.rows(), "retro part");
  if (!table.channel_names.empty()) require_size(table.channel_names.size(), table.channels, "list of channel names");
  for (const auto& factor : table.factors) {
    require_size(factor.in.size(), table.channels * table.rows(), "factor's albedo");
    require_size(factor.out.size(), table.channels * table.rows(), "factor's albedo");
  }
  if (!table.factors.empty()) require_size(table.factors.size(), 2, "list of factors");
}

BrdfTable to_general(const BrdfTable& table) {
  if (table.form == TableForm::general) return table;
  BrdfTable general = table;
  general.form = TableForm::general;
  forget_odd_part(general);
  const std::size_t rings = table.grid.n_theta();
  const std::size_t azimuths = table.grid.n_phi();
  const std::size_t half = table.grid.half_azimuths();
  const auto expand_rows = [&](std::vector<double>& parts) {
    std::vector<double> expanded;
    for (const double part : parts) expanded.insert(expanded.end(), azimuths, part);
    parts = std::move(expanded);
  };
  expand_rows(general.mirror);
  expand_rows(general.retro);
  for (auto& factor : general.factors) {
    expand_rows(factor.in);
    expand_rows(factor.out);
  }
  general.values = TableValues(table.channels * general.size());
  for (std::size_t c = 0; c < table.channels; ++c) {
    const double* from = table.channel(c).data();
    double* const to = general.channel(c).data();
    parallel_for(rings * azimuths, [&](std::size_t in) {
      const std::size_t i = in / azimuths;
      const std::size_t phi_in = in % azimuths;
      for (std::size_t j = 0; j < rings; ++j) {
        const double* const source = from + (i * rings + j) * half;
        double* const target = to + (in * rings + j) * azimuths;
        for (std::size_t phi_out = 0; phi_out < azimuths; ++phi_out) {
          const std::size_t k = phi_out >= phi_in ? phi_out - phi_in : phi_in - phi_out;
          target[phi_out] = source[k < half ? k : azimuths - k];
        }
      }
    });
  }
  return general;
}

double squared_norm(const BrdfTable& table, std::size_t channel) {
  const auto columns = column_weights(table);
  const auto rows = row_weights(table);
  const auto values = table.channel(channel);
  std::vector<double> row_norms(rows.size());
  parallel_for(rows.size(), [&](std::size_t i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const double value = values[i * columns.size() + j];
      row_norms[i] += columns[j] * value * value;
    }
  });
  double norm = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) norm += rows[i] * row_norms[i];
  return norm;
}

double relative_error(const BrdfTable& table) {
  check(table);
  const auto rings = table.grid.rings();
  const auto weight = [&](std::size_t ring) { return rings[ring].weight * static_cast<double>(rings[ring].count); };
  double worst = 0;
  for (std::size_t c = 0; c < table.channels; ++c) {
    double error = 0;
    for (std::size_t i = 0; i < rings.size(); ++i) {
      for (std::size_t j = 0; j < rings.size(); ++j) {
        const std::size_t pair = i * rings.size() + j;
        const double bound = even_errors(table, c)[pair];
        const double odd = odd_part(table, c, pair);
        error += weight(i) * weight(j) * (bound * bound + odd * odd);
      }
    }
    const double relative = error == 0 ? 0 : std::sqrt(error / squared_norm(table, c));
    if (!(relative <= worst)) worst = relative;
  }
  return worst;
}

}  // namespace lobe
