#pragma once

#include "lobe/metric/metric.hpp"

namespace lobe::test {

inline MetricOptions with_tolerance(double tolerance, Precision precision = Precision::double_precision) {
  MetricOptions options;
  options.tolerance = tolerance;
  options.precision = precision;
  return options;
}

inline MetricOptions with_progress(ProgressCallback progress) {
  MetricOptions options;
  options.progress = std::move(progress);
  return options;
}

inline MetricOptions with_channel_weights(std::vector<double> weights) {
  MetricOptions options;
  options.channel_weights = std::move(weights);
  return options;
}

}  // namespace lobe::test
