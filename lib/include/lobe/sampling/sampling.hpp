#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/sampling_strategy.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for drawing directions.
struct SamplingOptions {
  /// Seed of the random numbers: samples with the same seed and number are equal, on every device to rounding.
  std::uint64_t seed = 1;
  std::uint64_t first = 0;                                 ///< number of the first sample
  SamplingStrategy proposal = SamplingStrategy::tailored;  ///< distribution that directions are drawn from
  PatchDraw patches = PatchDraw::exact;                    ///< how directions of basic patches are drawn
  Precision precision = Precision::double_precision;       ///< arithmetic of the models; the rest is in double
  ProgressCallback progress = {};                          ///< told of the progress; may cancel
};

/// Kinds of samples.
enum class SampleKind : unsigned char {
  smooth,  ///< drawn from a density
  mirror,  ///< the mirror direction of an ideal mirror
  retro,   ///< the direction of the light itself, for a retro-reflecting ideal mirror
  lost     ///< below the horizon, or rejected: no direction, weight 0
};

/// Directions V drawn for one direction L, with densities and weights: the mean of weights times incident radiance is
/// the reflected radiance (Neumann 2001, eq. 3.18).
struct DirectionSamples {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> directions;  ///< unit vectors x, y, z; 0 if lost
  Eigen::VectorXd density;        ///< sr^-1; for delta parts their probability; 0 if lost
  Eigen::MatrixXd weights;        ///< f(L, V) N.V / density by channel; for delta parts their factor / probability
  std::vector<SampleKind> kinds;  ///< one per sample
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< for tables and functions: grid of the cells drawn from

  /// Number of samples.
  [[nodiscard]] std::size_t size() const { return kinds.size(); }
};

/// Draws `count` directions. The density is above 0 wherever the reflectance is not 0, so weights are unbiased.
///
/// For formulas the density is a mixture of strategies, one for each kind of model (docs/sampling.md), in proportion to
/// the albedos of the material's terms. For tables, whose values are those of evaluate(), it is constant over cells of
/// the base plane, one for each node of a product grid. Functions are sampled as tables on their natural_grid().
/// \throws ArgumentError for an angle of incidence outside [0, pi/2), an azimuth that is not finite, or no samples; as
///   evaluate(); DeviceError; Cancelled
[[nodiscard]] DirectionSamples sample(const Device& device, const Reflectance& reflectance, Direction in,
                                      std::size_t count, const SamplingOptions& options = {});

/// Density with which sample() draws directions other than delta parts, sr^-1, by direction; 0 at and below the
/// horizon. Over the hemisphere it integrates to the probability that a sample is neither lost nor a delta part.
/// \param directions unit vectors
/// \throws as sample().
[[nodiscard]] Eigen::VectorXd sampling_density(const Device& device, const Reflectance& reflectance, Direction in,
                                               std::span<const std::array<double, 3>> directions,
                                               const SamplingOptions& options = {});

/// An albedo (1.13) estimated as the mean of weights, by channel.
struct SampledAlbedo {
  std::vector<Estimate> albedo;  ///< the error is one standard error, and rounding where weights do not vary
  std::vector<double> variance;  ///< variance of a single weight
  double lost = 0;               ///< fraction of samples without direction

  /// Variance over the squared albedo: the number of samples that gives a relative standard error of 1. 0 where
  /// weights do not vary, as of a black material.
  [[nodiscard]] double relative_variance(std::size_t channel) const {
    if (variance[channel] == 0) return 0;
    return variance[channel] / (albedo[channel].value * albedo[channel].value);
  }
};

/// Estimates an albedo from `count` drawn directions.
/// \param count at least 2
/// \throws as sample().
[[nodiscard]] SampledAlbedo sampled_albedo(const Device& device, const Reflectance& reflectance, Direction in,
                                           std::size_t count, const SamplingOptions& options = {});

}  // namespace lobe
