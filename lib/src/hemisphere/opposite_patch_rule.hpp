#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "device/node_block.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/mirror_panels.hpp"

namespace lobe {

/// Quadrature over pairs of directions for products of lobes in norms about the mirror direction and lobes in norms
/// about the retro direction (Neumann 2001, eq. 4.29, 4.32 to 4.38). Nodes and factors mean what those of
/// HalfDifferenceRule do.
///
/// The former see u = V_P - L'_P, the latter v = V_P - L_P, and dmu(L) dmu(V) = du dv / 4. With both in polar
/// coordinates, in the order phi_u, phi_v, |u|, |v|, every edge is one radius on each ray. Both directions are above
/// the base plane, or in a domain with s = sin(theta_max), where
///   |u|^2 + |v|^2 + 2 |u| |v| |cos(phi_u - phi_v)| < 4 s^2.
/// Panels of phi_u end on the axes of the norms of u, those of phi_v on the axes of the norms of v, where u and v are
/// orthogonal (N.L = N.V) and where the ends of two edges lie on that limit; panels of |u| on edges and where the limit
/// passes an edge of v, those of |v| on edges and on kinks that do not see azimuths. Lobes with such edges have no
/// other kinks. Where a lobe has a profile instead of an edge, radii shrink towards 0.
class OppositePatchRule {
 public:
  /// \param extent of lobes of both kinds, with edges about both directions
  explicit OppositePatchRule(LobeExtent extent);

  /// The rule is a sum over slabs of phi_u, refined independently.
  [[nodiscard]] std::size_t slabs() const { return turns_.size() - 1; }

  /// As HalfDifferenceRule::place().
  void place(std::size_t slab, int level, NodeBlock& block, const std::function<void()>& flush) const;

 private:
  /// One ray of u and what it meets.
  struct Ray;
  [[nodiscard]] std::vector<PanelEdge> across(const Ray& ray) const;
  [[nodiscard]] std::vector<PanelEdge> lengths_u(const Ray& ray, double cosine, const std::vector<double>& ends) const;
  [[nodiscard]] std::vector<PanelEdge> lengths_v(const Ray& ray, double azimuth, double length,
                                                 const std::vector<double>& ends) const;

  LobeExtent extent_;
  double reach_;  ///< 2 s, the largest |u| and |v|
  bool has_profile_u_, has_profile_v_;
  std::vector<PanelEdge> turns_;    ///< slabs of phi_u
  std::vector<PanelEdge> turns_v_;  ///< panels of phi_v that do not depend on phi_u
};

}  // namespace lobe
