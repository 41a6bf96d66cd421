#pragma once

#include <compare>
#include <functional>
#include <span>
#include <vector>

#include "hemisphere/gauss.hpp"

namespace lobe {

/// Edge of a patch in a norm of the base plane (Neumann 2001, eq. 4.32 and 4.38): the vectors z from the mirror or the
/// retro direction with ((ratio |z.u|)^power + |z.v|^power)^(1/power) = radius, u the axis at `rotation`, v across.
struct PatchEdge {
  double radius = 0;    ///< infinity where a lobe depends on the norm without a jump
  double ratio = 1;     ///< in (0, 1]
  double power = 2;     ///< >= 1
  double rotation = 0;  ///< radians

  /// Length of z at an azimuth.
  [[nodiscard]] double reach(double azimuth) const;
  /// A bound of it at all azimuths.
  [[nodiscard]] double farthest() const;

  auto operator<=>(const PatchEdge&) const = default;
};

/// Azimuths over half a turn, [first, first + pi], between which functions of the norms of all edges are smooth and as
/// wide as a panel: limits on the axes, in proportion to the norm's change away from them, and where the reaches of two
/// edges cross each other or a radius.
/// \param edges at least one
[[nodiscard]] std::vector<PanelEdge> norm_panels(std::span<const PatchEdge> edges, std::span<const double> radii);

/// Zeros of a function that changes sign at most once between steps of an eighth of the panels between the limits, of
/// which there are at least two. Values below 1e-13 are zero.
[[nodiscard]] std::vector<double> sign_changes(const std::function<double(double)>& f,
                                               std::span<const PanelEdge> limits);

/// Where the edge about a point of the unit disc meets the unit circle, as the point moves.
class PatchHorizon {
 public:
  explicit PatchHorizon(const PatchEdge& edge);

  /// Azimuths of the point, radians in [0, pi), at a distance from the centre, at which the edge touches the circle or
  /// a corner of it passes the circle; and limits that shrink towards the direction across the patch. Half a turn
  /// further on all is the same.
  [[nodiscard]] std::vector<PanelEdge> azimuths(double distance) const;

  /// Distances in (0, 1) between which azimuths() are of one number.
  [[nodiscard]] std::vector<double> distances() const;

 private:
  struct Point {
    double azimuth, x, y;
  };
  [[nodiscard]] int crossings(double distance, double azimuth) const;
  [[nodiscard]] std::vector<double> touching(double distance) const;
  [[nodiscard]] std::vector<double> passing(double distance) const;

  PatchEdge edge_;
  std::vector<Point> outline_;  ///< in the axes of the edge; over a whole turn, closed
};

}  // namespace lobe
