#pragma once

#include <vector>

#include "hemisphere/gauss.hpp"
#include "hemisphere/mirror_panels.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {

/// Panels for the integral of f(L,X) g(X,V) over the hemisphere of X, at a given pair L, V.
///
/// Coordinates of X: elevation above the horizon and azimuth from the mirror direction of L. Panels are those of f
/// about the mirror direction of L together with those of g about the mirror direction of V (mirror_panels.hpp): they
/// end on the kinks and edges of both and shrink towards both peaks. Where edges of two patches cross, a panel of the
/// elevation ends; crossings of other kinks are left to adaptive bisection.
class CompositionRule {
 public:
  /// \param directions theta_in, theta_out in [0, pi/2)
  CompositionRule(LobeExtent f, LobeExtent g, const Directions& directions);

  [[nodiscard]] double elevation_in() const { return elevation_in_; }
  [[nodiscard]] double elevation_out() const { return elevation_out_; }

  /// Azimuth of the mirror direction of V from that of L.
  [[nodiscard]] double turn() const { return turn_; }

  /// 2 where L, V and N lie in one plane: azimuths are then those of one side of it. Else 1.
  [[nodiscard]] double sides() const { return in_plane_ ? 2 : 1; }

  /// Limits of the elevation of X.
  [[nodiscard]] std::vector<PanelEdge> elevations() const;

  /// Limits of the azimuth of X at an elevation, in [0, 2 pi] or [0, pi].
  [[nodiscard]] std::vector<PanelEdge> azimuths(double elevation) const;

 private:
  LobeExtent f_, g_;
  double elevation_in_, elevation_out_;
  double turn_;
  bool in_plane_;
};

}  // namespace lobe
