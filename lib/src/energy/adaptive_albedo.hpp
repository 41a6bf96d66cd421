#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hemisphere/albedo_rule.hpp"
#include "hemisphere/half_vector_rule.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "model/delta_shares.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Albedos with their errors, channels x directions.
struct AlbedoValues {
  Eigen::ArrayXXd value;
  Eigen::ArrayXXd error;                               ///< of the quadrature, without rounding
  Eigen::ArrayXXd magnitude;                           ///< integral of the absolute value
  Eigen::Array<bool, Eigen::Dynamic, 1> is_exhausted;  ///< directions that have taken all the nodes that they may
};

/// The outcome for one albedo, or mean of albedos, by channel.
struct AlbedoOutcome {
  std::vector<Estimate> values;
  double worst = 0;           ///< largest relative error
  bool is_reached = false;    ///< whether that is within the tolerance
  bool is_finite = false;     ///< whether all values are finite numbers
  bool is_divergent = false;  ///< whether refinement has not even settled the size
};

/// Computes some of many albedos to an error relative to each.
using AlbedosAtGoal = std::function<AlbedoValues(std::span<const std::size_t> some, double goal)>;

/// Computes many albedos to a tolerance. Those that miss it, because sums cancel or their size was misjudged, are tried
/// two times more, each time ten times stricter; not those of which rounding alone is more. Ends where some are no
/// finite numbers.
/// \param rounding error beside that of the quadrature, relative to the magnitude; no tolerance is below twice that
[[nodiscard]] std::vector<AlbedoOutcome> albedos_within(const AlbedosAtGoal& albedos_at, std::size_t count,
                                                        double tolerance, double rounding);

/// Albedos of one material by nested adaptive quadrature: of the panels of AlbedoRule, or of HalfVectorRule for
/// anisotropic lobes, those are halved whose estimated error is too large. What a panel's rules may miss by chance
/// counts beside the panels around it, so that errors hold where two levels of the whole agree by accident.
class AdaptiveAlbedo {
 public:
  AdaptiveAlbedo(const Device& device, const Material& material, Precision precision);

  /// Relative error beside that of the quadrature.
  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] const AlbedoRule& rule() const { return rule_; }
  [[nodiscard]] LobeExtent extent() const { return lobes_.extent(); }
  [[nodiscard]] bool is_isotropic() const { return is_isotropic_; }
  /// The number of quadrature nodes so far.
  [[nodiscard]] std::uint64_t nodes() const { return nodes_; }

  /// Albedos at incident directions.
  /// \param goal error wanted, relative to the albedo
  /// \param most_nodes per direction; what is not resolved by then is in the error
  [[nodiscard]] AlbedoValues at(std::span<const IncidentNode> incident, double goal, std::size_t most_nodes);
  /// Albedos at incident directions to a tolerance; see albedos_within().
  /// \param most_nodes per direction and attempt
  [[nodiscard]] std::vector<AlbedoOutcome> within(std::span<const IncidentNode> incident, double tolerance,
                                                  std::size_t most_nodes);

 private:
  enum class Rays { none, mirror, retro };

  /// Isotropic lobes, or anisotropic ones that want rays from the same direction.
  struct Part {
    Rays rays;
    Eigen::MatrixXd mix;  ///< channels x lobes of the part
    LobeEvaluator evaluator;
    NodeBlock block;
  };
  class Integral;

  LobeSet lobes_;
  AlbedoRule rule_;
  HalfVectorRule half_vectors_;
  std::vector<Part> parts_;
  DeltaShares deltas_;
  double rounding_;
  bool is_isotropic_ = true;
  std::uint64_t nodes_ = 0;
};

}  // namespace lobe
