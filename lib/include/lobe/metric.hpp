#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/device.hpp"
#include "lobe/estimate.hpp"
#include "lobe/material.hpp"
#include "lobe/progress.hpp"
#include "lobe/work.hpp"

namespace lobe {

/// The lighting W of the scalar product f1 . f2 = integral of C_{f1,f2} W (Neumann 2001, eq. 5.23).
enum class Lighting {
  point,    ///< W = identity: integral of f1 f2 dmu dmu; a norm
  daylight  ///< W = 1: integral of a1 a2 dmu (section 5.3.2); a semi-norm
};

/// "point" or "daylight".
[[nodiscard]] std::string_view to_string(Lighting lighting);
/// \throws ArgumentError for an unknown name, with the nearest known one.
[[nodiscard]] Lighting parse_lighting(std::string_view name);

struct MetricOptions {
  /// Every scalar product is refined until its error estimate is below tolerance times the product.
  double tolerance = 1e-6;
  Precision precision = Precision::double_precision;
  /// Weight of each channel in the combined product; empty: equal weights that sum to 1.
  std::vector<double> channel_weights = {};
  ProgressCallback progress = {};
};

/// Scalar products of n materials and what follows from them, every entry with its error estimate.
/// point: gram in sr^0, daylight: gram in sr; norm and distance are square roots of these.
struct Metric {
  Eigen::MatrixXd gram;            ///< n x n, f_i . f_j
  Eigen::MatrixXd gram_error;      ///< n x n
  Eigen::VectorXd norm;            ///< n
  Eigen::VectorXd norm_error;      ///< n
  Eigen::MatrixXd distance;        ///< n x n, |f_i - f_j|
  Eigen::MatrixXd distance_error;  ///< n x n
};

/// A pair of materials whose product did not reach the tolerance, and what it reached (relative).
struct Unresolved {
  std::size_t first = 0;
  std::size_t second = 0;
  double relative_error = 0;
};

struct MetricResult {
  Lighting lighting = Lighting::point;
  Metric combined;               ///< weighted sum of the channels' products
  std::vector<Metric> channels;  ///< per channel; empty for a single channel
  std::vector<Unresolved> unresolved;
  Work work;
};

/// Gram and distance matrix of materials under a lighting.
/// Materials share lobes: a lobe that occurs in several of them or in several channels is integrated once.
/// Distances of near-identical materials are integrated as such, not taken from the cancelling difference of products.
/// \throws ArgumentError for no materials or channel counts that do not fit; NumericError where a product is no finite
///   number; DeviceError; Cancelled.
[[nodiscard]] MetricResult measure(const Device& device, std::span<const Material> materials, Lighting lighting,
                                   const MetricOptions& options = {});

/// f . g over all channels. \throws as measure().
[[nodiscard]] Estimate scalar_product(const Device& device, const Material& f, const Material& g, Lighting lighting,
                                      const MetricOptions& options = {});

/// |f - g| over all channels. \throws as measure().
[[nodiscard]] Estimate distance(const Device& device, const Material& f, const Material& g, Lighting lighting,
                                const MetricOptions& options = {});

}  // namespace lobe
