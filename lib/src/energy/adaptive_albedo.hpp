#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "hemisphere/albedo_rule.hpp"
#include "hemisphere/half_vector_rule.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "model/delta_shares.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Albedos with their errors, channels x directions.
struct AlbedoValues {
  Eigen::ArrayXXd value;
  Eigen::ArrayXXd error;      ///< of the quadrature, without rounding
  Eigen::ArrayXXd magnitude;  ///< integral of the absolute value
  bool is_exhausted = false;  ///< some direction has taken all the nodes that it may
};

/// Albedos of one material by nested adaptive quadrature: of the panels of AlbedoRule, or of HalfVectorRule for
/// anisotropic lobes, those are halved whose estimated error is too large. What a panel's rules may miss by chance
/// counts beside the panels around it, so that errors hold where two levels of the whole agree by accident.
class AdaptiveAlbedo {
 public:
  AdaptiveAlbedo(const Device& device, const Material& material, Precision precision);

  /// Relative error beside that of the quadrature.
  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] const AlbedoRule& rule() const { return rule_; }
  [[nodiscard]] bool is_isotropic() const { return is_isotropic_; }

  /// Albedos at incident directions.
  /// \param goal error wanted, relative to the albedo
  /// \param most_nodes per direction; what is not resolved by then is in the error
  [[nodiscard]] AlbedoValues at(std::span<const IncidentNode> incident, double goal, std::size_t most_nodes);

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
};

}  // namespace lobe
