#include "energy/row_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"
#include "hemisphere/embedded_rule.hpp"
#include "table/delta_parts.hpp"
#include "table/even_error.hpp"

namespace lobe {
namespace {

std::size_t block_of(const BrdfTable& table) {
  return table.size() / (table.rows() * table.rows());
}

/// How many of a ring's nodes the k-th azimuth stands for.
double azimuth_share(bool is_embedded, std::size_t k, bool is_end) {
  const double share = is_end ? 1 : 2;
  if (!is_embedded) return share;
  return k % 2 == 0 ? 2 * share : 0;
}

}  // namespace

std::size_t row_ring(const BrdfTable& table, std::size_t row) {
  return table.form == TableForm::isotropic ? row : table.grid.ring_of(row);
}

double row_cosine(const BrdfTable& table, std::size_t row) {
  return std::cos(table.grid.rings()[row_ring(table, row)].theta);
}

RowKernel::RowKernel(const BrdfTable& table, std::size_t channel, Rule rule) : table_(&table), channel_(channel) {
  const bool is_embedded = rule != Rule::full && !table.grid.has_cells();
  const auto embedded = !is_embedded             ? std::vector<double>()
                        : rule == Rule::embedded ? embedded_ring_weights(table.grid)
                                                 : other_ring_weights(table.grid);
  const auto node_weight = [&](std::size_t r) {
    const Ring& ring = table.grid.rings()[r];
    return is_embedded ? 2 * std::numbers::pi / static_cast<double>(ring.count) * embedded[r] : ring.weight;
  };
  const auto values = table.channel(channel);
  const std::size_t rows = table.rows();
  if (table.form == TableForm::general) {
    for (std::size_t node = 0; node < rows; ++node) {
      const std::size_t ring = table.grid.ring_of(node);
      const std::size_t k = node - table.grid.rings()[ring].first_node;
      weights_.push_back(node_weight(ring) * azimuth_share(is_embedded, k, true));
    }
    sums_ = values;
    return;
  }
  const std::size_t half = block_of(table);
  for (std::size_t ring = 0; ring < rows; ++ring) weights_.push_back(node_weight(ring));
  own_sums_.resize(rows * rows);
  parallel_for(rows, [&](std::size_t i) {
    for (std::size_t j = 0; j < rows; ++j) {
      const double* const row = values.data() + (i * rows + j) * half;
      double sum = 0;
      for (std::size_t k = 0; k < half; ++k) sum += azimuth_share(is_embedded, k, k == 0 || k + 1 == half) * row[k];
      own_sums_[i * rows + j] = sum;
    }
  });
  sums_ = own_sums_;
}

std::size_t RowKernel::mirrored(std::size_t row) const {
  return table_->form == TableForm::isotropic ? row : table_->grid.opposite(row);
}

double RowKernel::mirror(std::size_t row) const {
  return delta_part(table_->mirror, channel_ * rows() + row);
}

double RowKernel::retro(std::size_t row) const {
  return delta_part(table_->retro, channel_ * rows() + row);
}

RowKernel::Albedos RowKernel::albedos(std::span<const double> divisor) const {
  const std::size_t count = rows();
  Albedos result{std::vector<double>(count), std::vector<double>(count)};
  // Both in the same order, so that they are equal to the last bit where the table is symmetric.
  for (std::size_t i = 0; i < count; ++i) {
    const double* const sums = sums_.data() + i * count;
    const double* const divisors = divisor.data() + i * count;
    double in = 0;
    for (std::size_t j = 0; j < count; ++j) {
      const double quotient = sums[j] / divisors[j];
      in += weights_[j] * quotient;
      result.out[j] += weights_[i] * quotient;
    }
    result.in[i] = in;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double mirrored_part = mirror(i) / divisor[i * count + mirrored(i)];
    const double retro_part = retro(i) / divisor[i * count + i];
    result.in[i] += mirrored_part + retro_part;
    result.out[mirrored(i)] += mirrored_part;
    result.out[i] += retro_part;
  }
  return result;
}

RowKernel::Albedos RowKernel::value_errors(std::span<const double> divisor) const {
  const std::size_t count = rows();
  const auto rings = table_->grid.rings();
  const double* const errors = table_->error.data() + channel_ * rings.size() * rings.size();
  const auto row_weight = [&](std::size_t row) {
    const Ring& ring = rings[row_ring(*table_, row)];
    return table_->form == TableForm::isotropic ? ring.weight * static_cast<double>(ring.count) : ring.weight;
  };
  Albedos result{std::vector<double>(count), std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    const double* const row = errors + row_ring(*table_, i) * rings.size();
    for (std::size_t j = 0; j < count; ++j) {
      const double quotient = row[row_ring(*table_, j)] / divisor[i * count + j];
      result.in[i] += row_weight(j) * quotient;
      result.out[j] += row_weight(i) * quotient;
    }
  }
  return result;
}

void multiply_rows(BrdfTable& table, std::size_t channel, const std::function<double(std::size_t, std::size_t)>& factor,
                   const std::function<double(std::size_t, std::size_t)>& uncertainty) {
  const std::size_t rows = table.rows();
  const std::size_t rings = table.grid.rings().size();
  const std::size_t block = block_of(table);
  const auto values = table.channel(channel);
  forget_odd_part(table);
  // Rows of one ring share error bounds: a ring at a time.
  std::vector<std::vector<std::size_t>> rows_of(rings);
  for (std::size_t row = 0; row < rows; ++row) rows_of[row_ring(table, row)].push_back(row);
  parallel_for(rings, [&](std::size_t ring) {
    std::vector<double> bounds(rings);
    double* const errors = table.error.data() + (channel * rings + ring) * rings;
    for (const std::size_t i : rows_of[ring]) {
      for (std::size_t j = 0; j < rows; ++j) {
        const double times = factor(i, j);
        double largest = 0;
        for (std::size_t k = 0; k < block; ++k) {
          double& value = values[(i * rows + j) * block + k];
          value *= times;
          largest = std::max(largest, std::abs(value));
        }
        const std::size_t to = row_ring(table, j);
        const double bound = times * errors[to] + largest * uncertainty(i, j);
        if (std::isnan(bound) || bound > bounds[to]) bounds[to] = bound;  // NaN stays: nothing is above it
      }
    }
    std::ranges::copy(bounds, errors);
  });
  const bool is_general = table.form == TableForm::general;
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t at = channel * rows + i;
    if (!table.mirror.empty()) table.mirror[at] *= factor(i, is_general ? table.grid.opposite(i) : i);
    if (!table.retro.empty()) table.retro[at] *= factor(i, i);
  }
}

}  // namespace lobe
