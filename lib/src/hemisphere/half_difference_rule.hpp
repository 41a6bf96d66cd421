#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "device/node_block.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/mirror_panels.hpp"

namespace lobe {

/// Quadrature over pairs of directions: the sum over nodes of factor^2 g(node) is the integral of g(L, V) dmu(L)
/// dmu(V). Each node stands for its exchanged pair, too, unless LobeExtent::both_orders has both among the nodes.
///
/// Rusinkiewicz coordinates, dmu dmu = 4 (L.H) (N.L) (N.V) dw_h dw_d, in the order theta_h, theta_d, phi_d. With
/// T = tan(theta_h) tan(theta_d) and eta = T cos(phi_d) the cosines are N.L, N.V = cos(theta_h) cos(theta_d) (1 -+
/// eta), so the horizon is eta = 1, the kink of max(N.L, N.V) is eta = 0, and the other kinks are, at given theta_h,
/// theta_d,
///   eta   = 1 - 1/(2 cos^2 theta_h)                            attenuation G reaches 1 (2.10)
///   eta^2 = 1 - (2 - 1/cos^2 theta_d) / cos^2 theta_h          L.V = N.L N.V (1.56)
///   eta^2 = 1 - (2 - 1/cos^2 theta_d) / (2 cos^2 theta_h)      R.V = 0
/// A patch of radius R (4.2) ends at |V_P - L'_P| = 2 sin(theta_h) cos(theta_d) = R, one about the retro direction at
/// |V_P - L_P|^2 = 4 sin^2 theta_d (1 - sin^2 theta_h cos^2 phi_d) = R^2.
/// Further kinks of lobes (LobeExtent::kinks) have their zeros in phi_d, in theta_d on both ends of phi_d, and in
/// theta_h at the corners of the domain as limits. Panels end on all of these and shrink geometrically towards the peak
/// (theta_h = 0), grazing (theta_d = pi/2), the plane phi_d = pi/2 and the corner T = 1 where the horizon begins; so
/// lobes of any width cost a few dozen nodes per axis, and convergence is that of Gauss rules on smooth functions. By
/// symmetry phi_d runs over [0, pi/2].
///
/// In a smaller domain (LobeExtent::cos_min, c) its limit N.L, N.V = c takes the horizon's place: with C =
/// cos(theta_h) and D = cos(theta_d) it is eta = 1 - c/(C D), it begins where theta_h + theta_d = theta_max and ends
/// where C D = c, and kinks and edges of patches meet it at
///   2 D^2 - 2 c C D + c^2 - 1 = 0                  L.V = N.L N.V
///   2 D^2 - 4 c C D + 2 c^2 - 1 = 0                R.V = 0
///   D = 2 c C                                      attenuation G reaches 1
///   (1 + C^2) D^2 - 2 c C D + c^2 + R^2/4 - 1 = 0  a patch about the retro direction
///
/// Among anisotropic reflectances each node has both signs of phi_d and the azimuths phi_h of a trapezoidal rule over a
/// turn. One sign serves where all depend on V_P - L'_P only, or where they share their mirror planes, so that the
/// means over phi_h are the same for both. No limit of the panels depends on phi_h, but for edges of patches in a norm
/// (4.32, 4.38): V_P - L'_P has the azimuth phi_h, so that at given phi_h such an edge is that of a patch of its own
/// radius. Slabs are then panels of phi_h; they end on the axes of the norms and where these radii cross each other or
/// those at which other limits change.
class HalfDifferenceRule {
 public:
  /// With retro-reflecting lobes panels shrink towards theta_d = 0, too, and end on L.V = 0.
  /// \param extent with anisotropic edges about one of both directions at most
  /// \param tolerance of what is integrated; loose ones begin with coarser levels where these save time
  explicit HalfDifferenceRule(LobeExtent extent, double tolerance = 0);

  /// The rule is a sum over slabs of theta_h, or of phi_h, refined independently.
  [[nodiscard]] std::size_t slabs() const { return (turns_.empty() ? edges_ : turns_).size() - 1; }

  /// Places a slab's nodes into the block, calling flush each time the block is full and once more at the end; flush
  /// leaves the block empty.
  /// \param azimuth_share share of the azimuths of H that the lobes' aspect asks for; never fewer than nodes per panel
  void place(std::size_t slab, int level, NodeBlock& block, const std::function<void()>& flush,
             double azimuth_share = 1) const;

  /// Places the nodes of a slab with a given number of Gauss nodes per panel and axis, for tolerances that need less
  /// than the coarsest level.
  void place_gauss(std::size_t slab, int nodes_per_panel, NodeBlock& block, const std::function<void()>& flush,
                   double azimuth_share = 1) const {
    place_gauss(slab, nodes_per_panel, azimuths(nodes_per_panel, azimuth_share), block, flush);
  }
  /// With a given number of azimuths of H, which counts where has_equal_azimuths().
  void place_gauss(std::size_t slab, int nodes_per_panel, std::size_t azimuths, NodeBlock& block,
                   const std::function<void()>& flush) const;

  /// Whether nodes have the azimuths of a trapezoidal rule, whose number a share may lessen: not where edges of patches
  /// in a norm make panels of them.
  [[nodiscard]] bool has_equal_azimuths() const { return turns_.empty(); }
  /// Whether these are turned at every node, as jumps between them want it.
  [[nodiscard]] bool has_scattered_azimuths() const { return turns_.empty() && extent_.hides_jumps; }
  /// Number of azimuths of H at a share of those that the aspect asks for.
  [[nodiscard]] std::size_t azimuths(int nodes_per_panel, double azimuth_share) const;

 private:
  LobeExtent extent_;
  bool is_loose_;
  std::vector<PanelEdge> edges_;  ///< slabs of theta_h
  std::vector<PanelEdge> turns_;  ///< slabs of phi_h; none without anisotropic edges
  bool is_mirrored_ = false;      ///< the rule is that for the mirror image of L and V
};

}  // namespace lobe
