#include <cmath>
#include <string>
#include <vector>

#include "algebra/operands.hpp"
#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "lobe/core/error.hpp"
#include "metric/channel_metric.hpp"
#include "metric/domain.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/material_light.hpp"
#include "metric/routes.hpp"
#include "metric/table_measure.hpp"
#include "metric/table_metric.hpp"
#include "metric/table_products.hpp"
#include "metric/table_set.hpp"

namespace lobe {
namespace {

/// Sets an entry of a channel's matrix and of its mirror image, and adds its share to that of all channels.
void enter(Eigen::MatrixXd& channel, Eigen::MatrixXd& combined, Eigen::Index i, Eigen::Index j, double weight,
           double value) {
  channel(i, j) = channel(j, i) = value;
  combined(i, j) += weight * value;
  combined(j, i) = combined(i, j);
}

/// Products of a pair of tables, by channel.
struct PairProducts {
  std::vector<Estimate> product;
  std::vector<Estimate> squared_distance;
};

/// products_of_tables() of what the pattern of a lighting makes of tables.
std::vector<ChannelProducts> products_of_lit_tables(const Device& device, std::span<const BrdfTable* const> tables,
                                                    const Lighting& lighting, const TableMetricOptions& options) {
  if (tables.empty()) return products_of_tables(device, tables, Lighting::point(), options);
  static_cast<void>(cos_of_domain(options.theta_max, lighting));
  const MaterialLight light(device, lighting, tables.front()->grid, {.progress = options.progress});
  std::vector<BrdfTable> lit;
  for (const BrdfTable* table : tables) lit.push_back(light.lit(*table));
  std::vector<const BrdfTable*> all;
  for (const BrdfTable& table : lit) all.push_back(&table);
  return products_of_tables(device, all, Lighting::point(), options);
}

}  // namespace

Estimate share_of(const Estimate& distance, const Estimate& square) {
  if (!(square.value > 0)) {
    return distance.value > 0 ? Estimate{std::nan(""), std::nan("")} : Estimate{};
  }
  const double norm = std::sqrt(square.value);
  const double norm_error = square.error / (2 * norm);
  const double value = distance.value / norm;
  return {value, (distance.error + value * norm_error) / norm};
}

Displacement table_displacement(const BrdfTable& before, const BrdfTable& after) {
  const bool has_delta = before.has_delta() || after.has_delta();
  Displacement result{has_delta ? Lighting::daylight() : Lighting::point(), {}, {}};
  result.absolute = distance(before, after, result.lighting);
  result.relative = share_of(result.absolute, scalar_product(before, before, result.lighting));
  return result;
}

std::vector<ChannelProducts> products_of_tables(const Device& device, std::span<const BrdfTable* const> tables,
                                                const Lighting& lighting, const TableMetricOptions& options) {
  if (traits_of(lighting).is_pattern) return products_of_lit_tables(device, tables, lighting, options);
  OperandShape shape = common_shape(tables, true);
  shape.keeps_forms = true;
  const std::vector<double> weights = channel_weights(options.channel_weights, shape.channels);
  const Operands operands(tables, shape, [](const BrdfTable& table, const HemisphereGrid&) { return table; });

  const TableLight light(device, lighting, operands[0].grid, options.theta_max);
  const TableSet set(operands.all(), light);
  const auto n = static_cast<Eigen::Index>(operands.size());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  std::vector<ChannelProducts> channels(shape.channels, {zero, zero, zero, zero});
  ChannelProducts combined{zero, zero, zero, zero};
  for (std::size_t row = 0; row < operands.size(); ++row) {
    std::vector<PairProducts> pairs(row + 1);
    const auto measure_pair = [&](std::size_t column) {
      pairs[column].product = set.products(row, column);
      pairs[column].squared_distance =
          row == column ? std::vector<Estimate>(shape.channels) : set.squared_distances(row, column);
    };
    if (light.is_host_only()) {
      parallel_for(row + 1, measure_pair);
    } else {
      for (std::size_t column = 0; column <= row; ++column) measure_pair(column);
    }
    for (std::size_t column = 0; column <= row; ++column) {
      const auto i = static_cast<Eigen::Index>(row);
      const auto j = static_cast<Eigen::Index>(column);
      for (std::size_t c = 0; c < shape.channels; ++c) {
        const Estimate& product = pairs[column].product[c];
        const Estimate& distance = pairs[column].squared_distance[c];
        enter(channels[c].gram, combined.gram, i, j, weights[c], product.value);
        enter(channels[c].gram_error, combined.gram_error, i, j, weights[c], product.error);
        enter(channels[c].squared_distance, combined.squared_distance, i, j, weights[c], distance.value);
        enter(channels[c].squared_distance_error, combined.squared_distance_error, i, j, weights[c], distance.error);
      }
    }
    const double done = static_cast<double>(row + 1) / static_cast<double>(operands.size());
    if (options.progress && !options.progress(lighting.name(), done)) throw Cancelled("cancelled");
  }
  channels.push_back(std::move(combined));
  return channels;
}

MetricResult metric_of(std::vector<ChannelProducts> products) {
  MetricResult result;
  result.combined = make_metric(std::move(products.back()));
  products.pop_back();
  if (products.size() == 1) return result;
  for (auto& channel : products) result.channels.push_back(make_metric(std::move(channel)));
  return result;
}

MetricResult measure_tables(const Device& device, std::span<const BrdfTable* const> tables, const Lighting& lighting,
                            const TableMetricOptions& options) {
  Stopwatch watch;
  MetricResult result = metric_of(products_of_tables(device, tables, lighting, options));
  result.lighting = lighting;
  result.theta_max = options.theta_max;
  result.work.seconds_host = watch.lap();
  return result;
}

}  // namespace lobe
