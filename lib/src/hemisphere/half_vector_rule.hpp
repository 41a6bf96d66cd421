#pragma once

#include <functional>

#include "device/node_block.hpp"
#include "hemisphere/mirror_panels.hpp"

namespace lobe {

/// Azimuths of a trapezoidal rule over a turn at a level of refinement, for lobes that are `aspect` times longer than
/// wide: periodic and smooth integrands, for which the rule converges like a Gauss rule. Their number is odd, so that
/// for lobes that half a turn leaves the same, as it does most, they are as many different ones of half a turn.
/// \throws NumericError for an aspect above 1000
[[nodiscard]] std::size_t azimuths_of_level(double aspect, int nodes_per_panel);

/// Quadrature over V at given L for anisotropic reflectances, which are functions of the half-vector H above all:
/// dw_V = 4 (L.H) dw_H in the polar coordinates theta_h, phi_h of H about the normal, in the order phi_h, theta_h.
///
/// With phi_h from the azimuth of L, N.V = r cos(2 theta_h - a) with (r cos a, r sin a) = (cos theta_L,
/// sin theta_L cos phi_h), so that the horizon is 2 theta_h = a + pi/2, and the kink of max(N.L, N.V) theta_h = a.
/// Panels end on both, and on R.V = 0. Those of theta_h shrink towards the mirror direction (theta_h = 0) down to the
/// narrower width of the lobes, those of phi_h towards the plane across L, where at grazing incidence the horizon
/// turns. No panel of phi_h is longer than the lobes are drawn out; so each ray sees a lobe of one width.
class HalfVectorRule {
 public:
  /// \param extent with an aspect of at least 1
  explicit HalfVectorRule(LobeExtent extent);

  /// Directions V for L at an elevation above the horizon and an azimuth (radians): the sum over nodes of factor
  /// f(L, V) is the albedo a(L). The block has tangents; flushing as in AlbedoRule::place.
  void place(double elevation, double azimuth, int nodes_per_panel, NodeBlock& block,
             const std::function<void()>& flush) const;

 private:
  LobeExtent extent_;
};

}  // namespace lobe
