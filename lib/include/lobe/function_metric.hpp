#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "lobe/brdf_function.hpp"
#include "lobe/lighting.hpp"
#include "lobe/metric.hpp"
#include "lobe/progress.hpp"

namespace lobe {

/// How products of functions are computed.
struct FunctionMetricOptions {
  /// Slabs of the quadrature are refined until the error estimate of every f.f is below tolerance times f.f, or until
  /// the finest level: measured functions have kinks and jumps, and may not reach it.
  double tolerance = 5e-3;
  /// Weight of each channel in the combined product; empty: equal weights that sum to 1.
  std::vector<double> channel_weights = {};
  /// Smallest half-vector width of lobes that the quadrature follows, radians.
  double lobe_width = 0.005;
  /// The domain, as in MetricOptions.
  double theta_max = std::numbers::pi / 2;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Whether a lighting needs tables, as that of patches and tabulated ones do; under the others functions are measured.
[[nodiscard]] bool takes_tables(const Lighting& lighting);

/// Gram and distance matrix of functions under `point`, `daylight` or `mean-albedo` light, by quadrature that is dense
/// about the mirror direction and at grazing angles, whatever grid their source has. As functions of measurements are
/// neither smooth nor reciprocal, both orders of the directions and both signs of delta_phi are taken. Errors are three
/// times the differences of the last two levels of quadrature and as much as a third of those before, summed by slabs,
/// and what the functions' own errors may do to norms (Cauchy-Schwarz); none is `unresolved`, the errors say what was
/// reached. A single channel serves all channels of the other
/// functions. Anisotropic functions are taken at 16 azimuths, which differ from node to node. \throws ArgumentError for
/// no functions, delta parts, other lightings, tolerances and domains out of range, and channel counts that do not fit;
///   NumericError for values that are no finite numbers and norms that do not exist; Cancelled.
[[nodiscard]] MetricResult measure(std::span<const BrdfFunction> functions, const Lighting& lighting,
                                   const FunctionMetricOptions& options = {});

}  // namespace lobe
