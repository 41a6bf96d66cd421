#pragma once

#include <functional>
#include <vector>

#include "device/node_block.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/mirror_panels.hpp"

namespace lobe {

/// A node of a mean over a turn: an azimuth (radians) and its share; the shares add up to 1.
struct Azimuth {
  double at, share;
};

/// Number of azimuths of a trapezoidal rule over a turn at a level of refinement, for lobes that are `aspect` times
/// longer than wide: periodic and smooth integrands, for which the rule converges like a Gauss rule. It is odd, so that
/// for lobes that half a turn leaves the same, as it does most, they are as many different ones of half a turn.
/// \param density azimuths per node of a panel and unit of aspect; there are never fewer than nodes
/// \throws NumericError for an aspect above 1000
[[nodiscard]] std::size_t azimuth_count(double aspect, int nodes_per_panel, double density);
/// The rule with that number.
/// How far the place-th node of other coordinates turns `count` equal azimuths, by the golden section: where lobes jump
/// between azimuths, all of them would miss a jump by the same angle.
[[nodiscard]] double scatter(std::size_t place, std::size_t count);
/// \throws as azimuth_count()
[[nodiscard]] std::vector<Azimuth> equal_azimuths(double aspect, int nodes_per_panel, double density);
/// The rule with a given number.
[[nodiscard]] std::vector<Azimuth> equal_azimuths(std::size_t count);

/// Panels for such a mean of integrands that are smooth between limits only.
/// \param limits at least one, modulo half a turn
/// \param aspect of lobes whose axes are not among the limits: no panel is longer than 2 / aspect
/// \param half_turn the integrand is the same half a turn further on, so that panels cover only half of one
/// \throws NumericError for an aspect above 1000
[[nodiscard]] std::vector<PanelEdge> turn_panels(std::vector<PanelEdge> limits, double aspect, bool half_turn);

/// Gauss nodes of all panels.
[[nodiscard]] std::vector<Azimuth> panel_azimuths(const std::vector<PanelEdge>& panels, const GaussRule& gauss);

/// A ray of half-vectors, or for lobes about the retro direction one of the mirror image of L, at one azimuth.
struct HalfVectorRay {
  HalfVectorRay(double elevation, double azimuth, bool retro, double phi);
  /// The node at an angle of the half-vector; its factor is `weight` times 4 (L.H) (N.V) sin(theta_h).
  [[nodiscard]] TangentNode node(double theta_h, double weight) const;

  double cos_i, in_x, in_y;
  double turn;            ///< azimuth of the ray
  double turn_x, turn_y;  ///< its direction
  bool about_retro;
  double across;   ///< L along the ray
  double horizon;  ///< theta_h where N.V = 0
  double kink;     ///< theta_h where N.V = N.L; none if not positive
  double radius;   ///< N.V = radius sin(2 (horizon - theta_h))
};

/// Quadrature over V at given L for anisotropic reflectances, which are functions of the half-vector H above all:
/// dw_V = 4 (L.H) dw_H in the polar coordinates theta_h, phi_h of H about the normal, in the order phi_h, theta_h.
///
/// With phi_h from the azimuth of L, N.V = r cos(2 theta_h - a) with (r cos a, r sin a) = (cos theta_L,
/// sin theta_L cos phi_h), so that the horizon is 2 theta_h = a + pi/2, and the kink of max(N.L, N.V) theta_h = a.
/// Panels end on both, on R.V = 0 and on kinks that see azimuths. Those of theta_h shrink towards the mirror direction
/// (theta_h = 0) down to the narrower width of the lobes, those of phi_h towards the plane across L, where at grazing
/// incidence the horizon turns. In a smaller domain rays end at its N.V. No panel of phi_h is longer than the lobes are
/// drawn out; so each ray sees a lobe of one width.
///
/// phi_h is also the azimuth of z = V_P - L'_P, of length 2 (L.H) sin(theta_h): rays from the mirror direction. The
/// edge of a patch in a norm (4.32, 4.38) has one theta_h on each ray; panels of phi_h end on the axes of the norm and
/// where edges meet the horizon. For lobes about the retro direction rays begin there: V is then what the rule has for
/// the mirror image of L.
class HalfVectorRule {
 public:
  /// \param extent with an aspect of at least 1 wherever nodes are placed
  explicit HalfVectorRule(LobeExtent extent);

  /// Directions V for L at an elevation above the horizon and an azimuth (radians): the sum over nodes of factor
  /// f(L, V) is the albedo a(L). The block has tangents; flushing as in AlbedoRule::place.
  /// \param about_retro rays begin at the retro direction
  void place(double elevation, double azimuth, bool about_retro, int nodes_per_panel, NodeBlock& block,
             const std::function<void()>& flush) const;

  /// Panels of phi_h from L, over a turn.
  [[nodiscard]] std::vector<PanelEdge> azimuths(double elevation, double azimuth, bool about_retro) const;
  /// Panels of theta_h on a ray.
  [[nodiscard]] std::vector<PanelEdge> along(const HalfVectorRay& ray) const;

 private:
  LobeExtent extent_;
};

}  // namespace lobe
