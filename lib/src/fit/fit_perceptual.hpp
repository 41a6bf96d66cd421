#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "fit/fit_space.hpp"
#include "fit/fit_target.hpp"

namespace lobe {

/// Relative errors of members of a family, e = (g - f) / max(f, floor), of radiances f cos(theta_in) and of albedos,
/// for the directions of perceptual_directions() and perceptual_incidence() and all channels.
class PerceptualErrorsOf {
 public:
  PerceptualErrorsOf(const Device& device, const FitTarget& target, bool is_isotropic, const FitOptions& options);

  /// All of them, channel by channel: radiances, then albedos.
  /// \param albedo_tolerance relative
  [[nodiscard]] Eigen::VectorXd at(const Material& member, double albedo_tolerance) const;
  /// The largest of each kind, with what is uncertain in them.
  [[nodiscard]] PerceptualErrors largest(const Material& member) const;

 private:
  [[nodiscard]] Estimate error_of(const Estimate& target, const Estimate& member, double floor) const;

  const Device& device_;
  Precision precision_;
  double radiance_floor_;
  double albedo_floor_;
  std::vector<Directions> directions_;
  std::vector<Direction> incidence_;
  std::vector<std::vector<Estimate>> radiance_;  ///< of the target, [channel][pair]
  std::vector<std::vector<Estimate>> albedo_;    ///< of the target, [channel][direction]
};

/// Where a search for the least largest error ended.
struct MinimaxFit {
  Eigen::VectorXd x;
  double largest = 0;
  bool converged = false;
  std::size_t evaluations = 0;
};

/// min t with -t <= e_i(x) <= t over the family's box, by COBYLA (Powell 1994), begun anew until that changes nothing.
/// \param progress called with every evaluation; what it throws ends the work
[[nodiscard]] MinimaxFit least_largest_error(const FitSpace& space, const PerceptualErrorsOf& errors,
                                             const Eigen::VectorXd& start, const std::function<void()>& progress);

}  // namespace lobe
