#pragma once

#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for compositions at single directions.
struct PointwiseOptions {
  double tolerance = 1e-8;  ///< relative to the value
  double absolute = 0;      ///< sr^-1: an error this small is sufficient, however small the value
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  /// Called for each pair of directions whose error stays above the requested one; if empty, only the error itself
  /// tells.
  MissedToleranceCallback missed = {};
};

}  // namespace lobe
