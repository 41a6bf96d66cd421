#pragma once

#include <cstddef>

#include "lobe/hemisphere/grid.hpp"

namespace lobe {

/// An azimuth that depends on the radius r = sin(theta): turn + bend / r.
struct ArcEnd {
  double turn = 0;
  double bend = 0;

  [[nodiscard]] double at(double r) const { return turn + (bend == 0 ? 0 : bend / r); }
};

/// A cell: what lies between two radii and two azimuths. Those of Shirley and Chiu's squares bend with the radius.
struct ArcCell {
  double inner = 0;
  double outer = 0;
  ArcEnd low;
  ArcEnd high;
  double centre = 0;  ///< azimuth

  /// Projected solid angle of the part between two radii.
  [[nodiscard]] double measure(double r_low, double r_high) const {
    return ((high.turn - low.turn) * (r_high + r_low) / 2 + high.bend - low.bend) * (r_high - r_low);
  }
};

/// The cell of a node of a grid of cells.
[[nodiscard]] ArcCell arc_cell(const HemisphereGrid& grid, std::size_t node);

}  // namespace lobe
