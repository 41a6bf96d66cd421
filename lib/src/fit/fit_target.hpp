#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobe/fit/fit.hpp"
#include "lobe/metric/metric.hpp"

namespace lobe {

/// Distances among a target, number 0, and materials.
struct TargetDistances {
  Eigen::MatrixXd distance;
  Eigen::MatrixXd distance_error;
  Estimate target_norm;  ///< the target's distance from black
};

/// A target as a fit sees it, be it a material, a function or a table. In all functions it stands in front of the
/// materials.
struct FitTarget {
  std::string name;
  std::size_t channels = 1;
  bool is_isotropic = true;
  /// Shapes of a term that can be held against it in one go.
  std::size_t most_shapes = 0;
  std::function<MetricResult(std::span<const Material>, double tolerance)> products;  ///< under the lighting
  /// Products for starting points: under point light if the lighting is a patch light, which would refine lobes that
  /// are much too narrow at great expense.
  std::function<MetricResult(std::span<const Material>, double tolerance)> rough_products;
  std::function<TargetDistances(std::span<const Material>, double tolerance)> compared;
  std::function<std::vector<std::vector<Estimate>>(std::span<const Directions>)> values;  ///< [channel][pair], sr^-1
  std::function<std::vector<std::vector<Estimate>>(std::span<const Direction>)> albedos;  ///< [channel][direction]
  /// Which grid would resolve a material that the target's does not, as a message; nothing where it does. Searches do
  /// without; it takes long. None: what the products throw says it.
  std::function<std::optional<std::string>(const Material&)> refusal = {};
};

/// The functions keep references to the arguments.
/// \param progress called during products and comparisons
[[nodiscard]] FitTarget fit_target(const Device& device, const Material& target, const FitOptions& options,
                                   const ProgressCallback& progress);
/// For lightings and objectives that take no tables.
[[nodiscard]] FitTarget fit_target(const Device& device, const BrdfFunction& target, const FitOptions& options,
                                   const ProgressCallback& progress);
[[nodiscard]] FitTarget fit_target(const Device& device, const BrdfTable& target, const FitOptions& options,
                                   const ProgressCallback& progress);

/// Distances of a result whose first material is the target.
[[nodiscard]] TargetDistances distances_of(const MetricResult& result);

}  // namespace lobe
