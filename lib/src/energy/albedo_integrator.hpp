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
/// The same for the given direction where groups of lobes take rules of their own over the other one.
[[nodiscard]] LobeExtent given_extent(const LobeSet& lobes, Given given);
/// The extent of the lobes of one group, for integrals over the other direction.
[[nodiscard]] LobeExtent extent_of_group(const LobeSet& lobes, std::size_t group, Given given);

/// Which lobes take one rule over the other direction.
enum class SharedRule {
  all,       ///< all isotropic ones, and all anisotropic ones about one direction
  by_limits  ///< those of one group (LobeSet::group_of_batch)
};

/// Albedos of many lobes, delta parts included, at many directions of incidence, on the device.
class AlbedoIntegrator {
 public:
  /// \param given differs for lobes that are not reciprocal alone
  /// \param tolerance of what the albedos are for (AlbedoRule)
  /// \param shared by_limits where panels of the given direction end on kinks of all groups, as those of rule() do
  AlbedoIntegrator(const Device& device, const LobeSet& lobes, Precision precision, Given given = Given::light,
                   double tolerance = 0, SharedRule shared = SharedRule::all);

  [[nodiscard]] const AlbedoRule& rule() const { return rule_; }

  /// a_lobe(L), lobes x incident nodes, by the inner quadrature at a level. Isotropic lobes are integrated once for
  /// nodes of one elevation that follow each other. Adds its work to `work`.
  [[nodiscard]] Eigen::MatrixXd integrate(std::span<const IncidentNode> incident, int level, WorkDone& work);

 private:
  enum class Rays { none, mirror, retro };

  /// Lobes that share a rule over the other direction, sampled and integrated together.
  struct Part {
    Rays rays;
    AlbedoRule rule;                  ///< of isotropic lobes
    HalfVectorRule half_vectors;      ///< of anisotropic ones
    std::vector<Eigen::Index> lobes;  ///< columns of the lobe set
    LobeEvaluator evaluator;
    NodeBlock block;
  };

  [[nodiscard]] static Rays rays_of(const LobeSet& lobes, std::size_t batch);
  /// Part's lobes x incident nodes.
  [[nodiscard]] Eigen::MatrixXd integrate(Part& part, std::span<const IncidentNode> incident, int level,
                                          WorkDone& work);
  void place(Part& part, const IncidentNode& incident, int level, const std::function<void()>& flush) const;

  AlbedoRule rule_;
  std::vector<Part> parts_;
  DeltaShares deltas_;
  Given given_;
  Eigen::Index smooth_lobes_;
  Eigen::Index lobes_;
};

}  // namespace lobe
