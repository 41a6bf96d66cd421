#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "device/node_block.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/mirror_panels.hpp"

namespace lobe {

/// Quadrature over theta_in, theta_out and delta_phi as they are sampled by equal steps of the angles: the sum over
/// nodes of factor g(node) is the integral of g dtheta_in dtheta_out ddelta_phi over [0, theta_max]^2 x [0, 2 pi], for
/// isotropic g that are even in delta_phi. No sine is in the measure, so none must be divided out.
///
/// theta_out and delta_phi have the panels of an albedo at theta_in (mirror_panels.hpp). Slabs of theta_in shrink
/// towards grazing incidence and towards the normal, where a lobe of width w about the mirror direction changes from
/// the share w / sin(theta_in) of all azimuths to all of them.
class AngleRule {
 public:
  /// \param theta_max radians, in (0, pi/2]
  AngleRule(LobeExtent extent, double theta_max);

  [[nodiscard]] std::size_t slabs() const { return edges_.size() - 1; }

  /// Places a slab's nodes with so many Gauss nodes per panel and axis. Flushing as in HalfDifferenceRule::place.
  void place(std::size_t slab, int nodes_per_panel, NodeBlock& block, const std::function<void()>& flush) const;

 private:
  LobeExtent extent_;
  double lowest_;  ///< elevation of theta_max above the horizon
  std::vector<PanelEdge> edges_;
};

}  // namespace lobe
