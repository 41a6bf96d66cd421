#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "hemisphere/albedo_rule.hpp"
#include "hemisphere/half_vector_rule.hpp"
#include "lobe/core/work_done.hpp"
#include "lobe/device/device.hpp"
#include "model/delta_shares.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Which of the two directions an albedo is one at; over the other one it is integrated.
enum class Given { light, viewer };

/// The extent of lobes for integrals over the other direction.
[[nodiscard]] LobeExtent extent_for(const LobeSet& lobes, Given given);

/// Which isotropic lobes take one rule over the other direction.
enum class SharedRule {
  all,
  /// Those that are not smooth in the same places, as panels that end on the kinks of others are of no use to them; and
  /// all that materials mix with lobes of other kinks, as errors of two rules are independent and may cancel by
  /// accident in a mixture.
  by_limits
};

/// Albedos of many lobes, delta parts included, at many directions of incidence, on the device.
class AlbedoIntegrator {
 public:
  /// \param given differs for lobes that are not reciprocal alone
  /// \param tolerance of what the albedos are for (AlbedoRule)
  AlbedoIntegrator(const Device& device, const LobeSet& lobes, Precision precision, Given given = Given::light,
                   double tolerance = 0, SharedRule shared = SharedRule::all);

  [[nodiscard]] const AlbedoRule& rule() const { return rule_; }

  /// a_lobe(L), lobes x incident nodes, by the inner quadrature at a level. Isotropic lobes are integrated once for
  /// nodes of one elevation that follow each other. Adds its work to `work`.
  [[nodiscard]] Eigen::MatrixXd integrate(std::span<const IncidentNode> incident, int level, WorkDone& work);

 private:
  enum class Rays { none, mirror, retro };

  /// Isotropic lobes that share a rule, or anisotropic ones that want rays from the same direction, sampled and
  /// integrated together.
  struct Part {
    Rays rays;
    AlbedoRule rule;                  ///< over the other direction, for isotropic lobes
    std::vector<Eigen::Index> lobes;  ///< columns of the lobe set
    LobeEvaluator evaluator;
    NodeBlock block;
  };

  /// Part's lobes x incident nodes.
  [[nodiscard]] Eigen::MatrixXd integrate(Part& part, std::span<const IncidentNode> incident, int level,
                                          WorkDone& work);
  void place(Part& part, const IncidentNode& incident, int level, const std::function<void()>& flush) const;

  AlbedoRule rule_;
  HalfVectorRule half_vectors_;
  std::vector<Part> parts_;
  DeltaShares deltas_;
  Given given_;
  Eigen::Index smooth_lobes_;
  Eigen::Index lobes_;
};

}  // namespace lobe
