#pragma once

#include <Eigen/Core>
#include <span>

#include "device/accumulators.hpp"
#include "hemisphere/albedo_rule.hpp"
#include "lobe/device.hpp"
#include "lobe/work.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Albedos of many lobes at many directions of incidence, on the device.
class AlbedoIntegrator {
 public:
  AlbedoIntegrator(const Device& device, const LobeSet& lobes, Precision precision);

  [[nodiscard]] const AlbedoRule& rule() const { return rule_; }

  /// a_lobe(L), lobes x incident nodes, by the rule's inner quadrature at a level. Adds its work to `work`.
  [[nodiscard]] Eigen::MatrixXd integrate(std::span<const IncidentNode> incident, int level, Work& work);

 private:
  AlbedoRule rule_;
  Sampler sampler_;
  NodeBlock block_;
};

}  // namespace lobe
