#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "device/node_block.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/mirror_panels.hpp"

namespace lobe {

/// A direction of incidence by its elevation above the horizon and its azimuth (radians), and its quadrature weight.
struct IncidentNode {
  double elevation = 0;
  double weight = 0;
  double azimuth = 0;
};

/// A direction V of the inner rule: its elevation above the horizon, its azimuth from the mirror direction of L, in
/// [0, pi] (radians), and what a value there counts with, for both halves of the azimuth.
struct ViewNode {
  double elevation = 0;
  double psi = 0;
  double factor = 0;
};

/// Quadrature of albedos of isotropic reflectances and of products of albedos.
///
/// Inner rule, at given L: coordinates theta_V and psi = pi - delta_phi, so that the horizon, the kink of
/// max(N.L, N.V) and that of L.V = N.L N.V lie on panel limits; the kinks of lobes, such as those of G (2.10) and of
/// R.V = 0, and the edges of patches have their own limits of psi at each theta_V, and their ends, known in closed
/// form, limit the panels of theta_V. Panels shrink geometrically towards the mirror direction, in psi in proportion to
/// N.L + N.V. Outer rule over L: slabs shrinking towards grazing incidence, the last one in the variable
/// sqrt(elevation), because albedos may grow as (N.L)^-1/2; they end where a patch touches the horizon. Among
/// anisotropic reflectances each elevation has the azimuths of a trapezoidal rule; where they jump, panels of azimuths,
/// which end where an edge touches the horizon, and slabs where the number of these changes. In a smaller domain
/// (LobeExtent::cos_min) its limit is the horizon of both rules.
class AlbedoRule {
 public:
  /// \param tolerance of what is integrated; loose ones begin with coarser levels where these save time
  explicit AlbedoRule(LobeExtent extent, double tolerance = 0);

  [[nodiscard]] std::size_t slabs() const { return edges_.size() - 1; }

  /// Limits of the slabs, elevations of L, rising.
  [[nodiscard]] const std::vector<PanelEdge>& edges() const { return edges_; }

  /// Gauss nodes per panel and axis.
  [[nodiscard]] int nodes_per_panel(int level) const;

  /// Nodes of a slab: the sum of weight a1 a2 is its part of the integral of a1 a2 dmu. Those of one elevation follow
  /// each other.
  [[nodiscard]] std::vector<IncidentNode> incident_nodes(std::size_t slab, int level) const {
    return incident_nodes_of(slab, nodes_per_panel(level));
  }
  /// The same with a given number of Gauss nodes per panel.
  [[nodiscard]] std::vector<IncidentNode> incident_nodes_of(std::size_t slab, int nodes_per_panel) const;

  /// Directions V for one L: the sum over nodes of factor f(L, V) is the albedo a(L). Flushing as in
  /// HalfDifferenceRule::place, except that the last, partly filled block is left to the caller.
  void place(double elevation, int level, NodeBlock& block, const std::function<void()>& flush) const;

  /// View directions by their angles, also where cosines do not tell them apart: at normal incidence.
  [[nodiscard]] std::vector<ViewNode> view_nodes(double elevation, int level) const;

 private:
  /// Calls visit(elevation of V, nodes at it) for each elevation.
  template <typename Visit>
  void visit_rings(double elevation, int level, const Visit& visit) const;
  [[nodiscard]] std::vector<PanelEdge> incident_azimuths(double elevation) const;

  LobeExtent extent_;
  bool is_loose_;
  double sin_max_;  ///< radius of the domain in the base plane
  std::vector<PanelEdge> edges_;
  std::vector<PatchHorizon> horizons_;  ///< in units of sin_max_
};

}  // namespace lobe
