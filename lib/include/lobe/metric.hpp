#pragma once

#include <Eigen/Core>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "lobe/device.hpp"
#include "lobe/estimate.hpp"
#include "lobe/lighting.hpp"
#include "lobe/material.hpp"
#include "lobe/progress.hpp"
#include "lobe/work.hpp"

namespace lobe {

/// How scalar products are computed.
struct MetricOptions {
  /// Every scalar product is refined until its error estimate is below tolerance times the product.
  double tolerance = 1e-6;
  /// The same for patch lights, whose cost grows with the third power of what the lobes ask for; at least `tolerance`.
  double patch_tolerance = 1e-5;
  Precision precision = Precision::double_precision;  ///< of the models
  /// Weight of each channel in the combined product; empty: equal weights that sum to 1.
  std::vector<double> channel_weights = {};
  /// The domain: products are integrals over directions up to this angle from the normal, of light and of view,
  /// radians, in (0, pi/2]. Short of the horizon every norm exists. Under point, daylight and mean-albedo light only.
  double theta_max = std::numbers::pi / 2;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Scalar products of n materials and what follows from them, every entry with its error estimate.
/// point: gram in sr^0, daylight: gram in sr; norm and distance are square roots of these, NaN where squares are
/// negative beyond their errors (tables under an indefinite W).
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
  std::size_t first = 0;      ///< its number
  std::size_t second = 0;     ///< that of the other one
  double relative_error = 0;  ///< what was reached
};

/// Scalar products, norms and distances of a set under one lighting.
struct MetricResult {
  Lighting lighting = Lighting::point();    ///< what products were taken under
  Metric combined;                          ///< weighted sum of the channels' products
  std::vector<Metric> channels;             ///< per channel; empty for a single channel
  std::vector<Unresolved> unresolved;       ///< pairs that did not reach the tolerance
  Work work;                                ///< what it took
  double theta_max = std::numbers::pi / 2;  ///< the domain, as in MetricOptions
};

/// Whether measure() has products of these materials under a lighting. Under mean-albedo it has them of all; elsewhere
/// lobes that grow as 1/(N.L) at grazing angles have infinite norms, under point light also delta parts, and there
/// anisotropic patches about the mirror direction have no products with those about the retro direction.
/// \throws ArgumentError for materials that are refused under any lighting.
[[nodiscard]] bool are_measurable(std::span<const Material> materials, const Lighting& lighting);

/// Gram and distance matrix of materials under a lighting.
/// Materials share lobes: a lobe that occurs in several of them or in several channels is integrated once.
/// Distances of near-identical materials are integrated as such, not taken from the cancelling difference of products.
/// \throws ArgumentError for no materials, channel counts that do not fit, and a domain out of range or under another
///   lighting than it is for; NumericError where a product is no finite number; DeviceError; Cancelled.
[[nodiscard]] MetricResult measure(const Device& device, std::span<const Material> materials, const Lighting& lighting,
                                   const MetricOptions& options = {});

/// f . g over all channels. \throws as measure().
[[nodiscard]] Estimate scalar_product(const Device& device, const Material& f, const Material& g,
                                      const Lighting& lighting, const MetricOptions& options = {});

/// |f - g| over all channels. \throws as measure().
[[nodiscard]] Estimate distance(const Device& device, const Material& f, const Material& g, const Lighting& lighting,
                                const MetricOptions& options = {});

/// Angle between two of the materials as vectors, arccos(f_i . f_j / (|f_i| |f_j|)), radians; NaN with a norm that is
/// not above its error. By the product, or by the chord between the normalised materials, which does not cancel near 0:
/// whichever the errors of norms, product and distance leave better known.
[[nodiscard]] Estimate angle(const Metric& metric, std::size_t i, std::size_t j);

}  // namespace lobe
