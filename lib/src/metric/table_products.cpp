#include "metric/table_products.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

#include "hemisphere/embedded_rule.hpp"
#include "lobe/core/error.hpp"
#include "lobe/table/cell_error.hpp"
#include "metric/table_domain.hpp"
#include "metric/table_metric.hpp"
#include "table/delta_parts.hpp"
#include "table/even_error.hpp"

namespace lobe {
namespace {

// Factor on the differences between the full and both embedded rules. For smooth integrands it is far larger than the
// error; at kinks both rules err, and may do so alike.
constexpr double kCellSafety = 4;

void require_comparable(const BrdfTable& f, const BrdfTable& g) {
  check(f);
  check(g);
  if (!(f.grid == g.grid)) {
    throw ArgumentError("tables on grids " + f.grid.name() + " and " + g.grid.name() + "; expected the same grid");
  }
  if (f.channels != g.channels) {
    throw ArgumentError("tables with " + std::to_string(f.channels) + " and " + std::to_string(g.channels) +
                        " channels; expected the same number");
  }
}

/// \throws ArgumentError for lightings that TableLight knows.
void require_supported(const Lighting& lighting) {
  if (lighting == Lighting::point() || lighting == Lighting::daylight()) return;
  throw ArgumentError("lighting '" + lighting.name() + "' of tables takes a device; expected 'point' or 'daylight'");
}

bool both_present(const std::vector<double>& a, const std::vector<double>& b) {
  const auto is_present = [](double x) { return x != 0; };
  return std::ranges::any_of(a, is_present) && std::ranges::any_of(b, is_present);
}

RingWeights ring_weights(const HemisphereGrid& grid) {
  RingWeights weights;
  for (const Ring& ring : grid.rings()) weights.full.push_back(ring.weight * static_cast<double>(ring.count));
  for (const double weight : embedded_ring_weights(grid)) weights.embedded.push_back(2 * std::numbers::pi * weight);
  for (const double weight : other_ring_weights(grid)) weights.other.push_back(2 * std::numbers::pi * weight);
  return weights;
}

/// Sums of f(L,V) g(L,V): over all azimuths and rings and over every second one.
struct Mean {
  double full = 0;
  double embedded = 0;
  double other = 0;  ///< of sums over rings: over the rings that the embedded rule leaves out
};

/// Sums over cells that operators are constant on are exact.
double quadrature_error(const BrdfTable& table, const Mean& sum) {
  return is_constant_on_cells(table) ? 0 : kCellSafety * std::hypot(sum.full - sum.embedded, sum.full - sum.other);
}

Mean isotropic_mean(const BrdfTable& f, const BrdfTable& g, std::size_t channel, std::size_t i, std::size_t j) {
  const std::size_t rings = f.grid.rings().size();
  const std::size_t half = f.grid.half_azimuths();
  const double* const a = f.channel(channel).data() + (i * rings + j) * half;
  const double* const b = g.channel(channel).data() + (i * rings + j) * half;
  const std::size_t step = f.grid.n_phi() % 4 == 0 ? 2 : 1;
  Mean mean;
  for (std::size_t k = 0; k < half; ++k) {
    const double term = (k == 0 || k + 1 == half ? 1 : 2) * a[k] * b[k];
    mean.full += term;
    if (k % step == 0) mean.embedded += static_cast<double>(step) * term;
  }
  const auto count = static_cast<double>(f.grid.n_phi());
  return {mean.full / count, mean.embedded / count};
}

Mean general_mean(const BrdfTable& f, const BrdfTable& g, std::size_t channel, std::size_t i, std::size_t j) {
  const Ring& in = f.grid.rings()[i];
  const Ring& out = f.grid.rings()[j];
  const std::size_t nodes = f.grid.nodes();
  Mean mean;
  for (std::size_t l = in.first_node; l < in.first_node + in.count; ++l) {
    for (std::size_t v = out.first_node; v < out.first_node + out.count; ++v) {
      const double term = f.channel(channel)[l * nodes + v] * g.channel(channel)[l * nodes + v];
      mean.full += term;
      if ((l - in.first_node + v - out.first_node) % 2 == 0) mean.embedded += 2 * term;
    }
  }
  const auto pairs = static_cast<double>(in.count * out.count);
  return {mean.full / pairs, in.count > 1 && out.count > 1 ? mean.embedded / pairs : mean.full / pairs};
}

Mean mean_product(const BrdfTable& f, const BrdfTable& g, std::size_t channel, std::size_t i, std::size_t j) {
  return f.form == TableForm::isotropic ? isotropic_mean(f, g, channel, i, j) : general_mean(f, g, channel, i, j);
}

/// Product of the smooth parts in a channel.
Estimate smooth_point(const BrdfTable& f, const BrdfTable& g, std::size_t channel, const RingWeights& weights) {
  const std::size_t rings = f.grid.rings().size();
  Mean sum;
  double value_error = 0;
  for (std::size_t i = 0; i < rings; ++i) {
    for (std::size_t j = 0; j < rings; ++j) {
      const Mean mean = mean_product(f, g, channel, i, j);
      sum.full += weights.full[i] * weights.full[j] * mean.full;
      sum.embedded += weights.embedded[i] * weights.embedded[j] * mean.embedded;
      sum.other += weights.other[i] * weights.other[j] * mean.embedded;
      // Mean sizes of f and g between the rings bound what each other's errors do.
      const auto size_of = [&](const BrdfTable& table) {
        return std::sqrt(std::abs(&f == &g ? mean.full : mean_product(table, table, channel, i, j).full));
      };
      const double f_size = size_of(f);
      const double g_size = size_of(g);
      const double f_error = even_errors(f, channel)[i * rings + j];
      const double g_error = even_errors(g, channel)[i * rings + j];
      const double odd = odd_part(f, channel, i * rings + j) * odd_part(g, channel, i * rings + j);
      value_error +=
          std::abs(weights.full[i] * weights.full[j]) * (f_error * g_size + f_size * g_error + f_error * g_error + odd);
    }
  }
  return {sum.full, quadrature_error(f, sum) + value_error};
}

/// Delta part of one table against the smooth part of the other: integral of mirror(L) g(L', L) + retro(L) g(L, L).
Estimate delta_point(const BrdfTable& delta, const BrdfTable& smooth, std::size_t channel, const RingWeights& weights) {
  if (!delta.has_delta()) return {};
  const std::size_t rows = smooth.rows();
  const HemisphereGrid& grid = smooth.grid;
  Estimate sum;
  double embedded = 0;
  double other = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t at = channel * rows + row;
    const bool is_isotropic = smooth.form == TableForm::isotropic;
    const double* const values =
        smooth.channel(channel).data() + (is_isotropic ? (row * rows + row) * grid.half_azimuths() : row * rows);
    const double mirrored = values[is_isotropic ? grid.half_azimuths() - 1 : grid.opposite(row)];
    const double back = values[is_isotropic ? 0 : row];
    const std::size_t ring = is_isotropic ? row : grid.ring_of(row);
    const double share = is_isotropic ? 1 : 1 / static_cast<double>(grid.rings()[ring].count);
    const double term = share * (delta_part(delta.mirror, at) * mirrored + delta_part(delta.retro, at) * back);
    const double error = smooth.error[(channel * grid.rings().size() + ring) * grid.rings().size() + ring];
    sum.value += weights.full[ring] * term;
    sum.error += std::abs(weights.full[ring]) * share *
                 (std::abs(delta_part(delta.mirror, at)) + std::abs(delta_part(delta.retro, at))) * error;
    embedded += weights.embedded[ring] * term;
    other += weights.other[ring] * term;
  }
  sum.error += quadrature_error(smooth, {sum.value, embedded, other});
  return sum;
}

Estimate point_product(const BrdfTable& f, const BrdfTable& g, std::size_t channel, const RingWeights& weights) {
  Estimate product = smooth_point(f, g, channel, weights);
  for (const Estimate& part : {delta_point(f, g, channel, weights), delta_point(g, f, channel, weights)}) {
    product += part;
  }
  return product;
}

/// Sum over rings of both tables' albedos by V.
Estimate daylight_product(const BrdfTable& f, const BrdfTable& g, std::size_t channel) {
  const TableAlbedo f_albedo = row_albedos(f);
  const TableAlbedo g_albedo = row_albedos(g);
  const RingWeights weights = ring_weights(f.grid);
  const bool is_isotropic = f.form == TableForm::isotropic;
  double full = 0;
  double embedded = 0;
  double other = 0;
  double value_error = 0;
  for (std::size_t row = 0; row < f.rows(); ++row) {
    const std::size_t ring = is_isotropic ? row : f.grid.ring_of(row);
    const double share = is_isotropic ? 1 : 1 / static_cast<double>(f.grid.rings()[ring].count);
    const Estimate& a = f_albedo.out[channel][row];
    const Estimate& b = g_albedo.out[channel][row];
    full += weights.full[ring] * share * a.value * b.value;
    embedded += weights.embedded[ring] * share * a.value * b.value;
    other += weights.other[ring] * share * a.value * b.value;
    value_error += weights.full[ring] * share * (a.error * std::abs(b.value) + std::abs(a.value) * b.error);
  }
  return {full, quadrature_error(f, {full, embedded, other}) + value_error};
}

/// The integral of products of two series by row, albedos; with its own error and theirs.
Estimate row_product(const BrdfTable& table, std::span<const Estimate> f, std::span<const Estimate> g,
                     const RingWeights& weights) {
  const bool is_isotropic = table.form == TableForm::isotropic;
  double full = 0;
  double embedded = 0;
  double other = 0;
  double value_error = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::size_t ring = is_isotropic ? row : table.grid.ring_of(row);
    const double share = is_isotropic ? 1 : 1 / static_cast<double>(table.grid.rings()[ring].count);
    full += weights.full[ring] * share * f[row].value * g[row].value;
    embedded += weights.embedded[ring] * share * f[row].value * g[row].value;
    other += weights.other[ring] * share * f[row].value * g[row].value;
    value_error +=
        std::abs(weights.full[ring]) * share *
        (f[row].error * std::abs(g[row].value) + std::abs(f[row].value) * g[row].error + f[row].error * g[row].error);
  }
  // Averages over cells sum up exactly.
  const double change = table.grid.has_cells() ? 0 : kCellSafety * std::hypot(full - embedded, full - other);
  return {full, change + value_error};
}

/// \throws NumericError where both have the same delta part
void require_finite_point_product(const BrdfTable& f, const BrdfTable& g) {
  if (both_present(f.mirror, g.mirror) || both_present(f.retro, g.retro)) {
    throw NumericError("the point product of '" + f.expression + "' and '" + g.expression +
                       "' is infinite: both have the same delta part");
  }
}

/// Empty where nothing is left.
std::vector<double> delta_difference(const std::vector<double>& f, const std::vector<double>& g) {
  std::vector<double> parts(std::max(f.size(), g.size()));
  for (std::size_t at = 0; at < parts.size(); ++at) parts[at] = delta_part(f, at) - delta_part(g, at);
  if (std::ranges::all_of(parts, [](double x) { return x == 0; })) parts.clear();
  return parts;
}

}  // namespace

Estimate mean(const std::vector<Estimate>& channels) {
  Estimate mean;
  for (const Estimate& channel : channels) {
    mean.value += channel.value / static_cast<double>(channels.size());
    mean.error += channel.error / static_cast<double>(channels.size());
  }
  return mean;
}

std::vector<Estimate> channel_products(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting) {
  require_supported(lighting);
  require_comparable(f, g);
  if (f.form != g.form) return channel_products(to_general(f), to_general(g), lighting);
  const bool is_point = lighting == Lighting::point();
  if (is_point) require_finite_point_product(f, g);
  const RingWeights weights = ring_weights(f.grid);
  std::vector<Estimate> products;
  for (std::size_t c = 0; c < f.channels; ++c) {
    products.push_back(is_point ? point_product(f, g, c, weights) : daylight_product(f, g, c));
  }
  return products;
}

std::vector<Estimate> channel_products_up_to(double theta_max, const BrdfTable& f, const BrdfTable& g,
                                             const Lighting& lighting) {
  require_comparable(f, g);
  if (f.form != g.form) return channel_products_up_to(theta_max, to_general(f), to_general(g), lighting);
  const bool is_point = lighting == Lighting::point();
  if (is_point) require_finite_point_product(f, g);
  const RingWeights weights = ring_weights_up_to(f.grid, theta_max);
  const std::vector<Estimate> ones(f.rows(), Estimate{1, 0});
  std::vector<Estimate> products;
  for (std::size_t c = 0; c < f.channels; ++c) {
    if (is_point) {
      products.push_back(point_product(f, g, c, weights));
      continue;
    }
    const auto f_albedo = albedos_up_to(f, c, weights);
    const auto g_albedo = albedos_up_to(g, c, weights);
    if (lighting == Lighting::daylight()) {
      products.push_back(row_product(f, f_albedo, g_albedo, weights));
      continue;
    }
    products.push_back(row_product(f, f_albedo, ones, weights) * row_product(g, g_albedo, ones, weights));
  }
  return products;
}

BrdfTable difference(const BrdfTable& f, const BrdfTable& g) {
  require_comparable(f, g);
  if (f.form != g.form) return difference(to_general(f), to_general(g));
  BrdfTable result;
  result.grid = f.grid;
  result.form = f.form;
  result.channels = f.channels;
  result.expression = f.expression + " - " + g.expression;
  result.values.resize(f.values.size());
  result.error.resize(f.error.size());
  std::ranges::transform(f.values, g.values, result.values.begin(), std::minus<>());
  std::ranges::transform(f.error, g.error, result.error.begin(), std::plus<>());
  for (std::size_t at = 0; !(f.even_error.empty() && g.even_error.empty()) && at < f.error.size(); ++at) {
    const auto known = [at](const BrdfTable& table) {
      return (table.even_error.empty() ? table.error : table.even_error)[at];
    };
    const auto odd = [at](const BrdfTable& table) { return table.odd_part.empty() ? 0 : table.odd_part[at]; };
    result.even_error.push_back(known(f) + known(g));
    result.odd_part.push_back(odd(f) + odd(g));
  }
  result.mirror = delta_difference(f.mirror, g.mirror);
  result.retro = delta_difference(f.retro, g.retro);
  return result;
}

std::vector<Estimate> squared_channel_distances(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting) {
  const BrdfTable between = difference(f, g);
  return channel_products(between, between, lighting);
}

Estimate scalar_product(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting) {
  return mean(channel_products(f, g, lighting));
}

Estimate distance(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting) {
  return square_root(mean(squared_channel_distances(f, g, lighting)));
}

}  // namespace lobe
