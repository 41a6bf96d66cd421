#pragma once

#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// How compositions at single directions are computed.
struct PointwiseOptions {
  double tolerance = 1e-8;                            ///< relative to the value
  double absolute = 0;                                ///< sr^-1: an error this small is enough, however small the value
  Precision precision = Precision::double_precision;  ///< of the models
  /// Called for each pair of directions whose error stays above what is asked for; empty: only its error says so.
  MissedToleranceCallback missed = {};
};

}  // namespace lobe
