#pragma once

#include <span>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/metric/metric.hpp"
#include "metric/products.hpp"
#include "metric/routes.hpp"

namespace lobe {

/// The products of measure_tables(): those of each channel, then their weighted sum.
/// \throws as measure_tables()
[[nodiscard]] std::vector<ChannelProducts> products_of_tables(const Device& device,
                                                              std::span<const BrdfTable* const> tables,
                                                              const Lighting& lighting,
                                                              const TableMetricOptions& options);

/// Norms and distances of these, channels where there are several.
[[nodiscard]] MetricResult metric_of(std::vector<ChannelProducts> products);

}  // namespace lobe
