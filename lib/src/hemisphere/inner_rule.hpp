#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "hemisphere/mirror_panels.hpp"
#include "lobe/hemisphere/grid.hpp"

namespace lobe {

/// A point of a rule, and its weight.
struct WeightedPoint {
  double at = 0;
  double weight = 0;
};

/// Directions X of a range of elevations.
struct InnerBand {
  /// Gauss nodes above the horizon, rising, radians; weights contain N.X cos(elevation).
  std::vector<WeightedPoint> elevations;
  /// Offsets of the azimuth of X from those of the grid, in [0, pi / n_phi]; the weight of an offset within contains
  /// that of its mirror image.
  std::vector<WeightedPoint> offsets;
  /// Both ends of the elevations, just within; the weight is the measure per length of the band, which is 1.
  std::array<WeightedPoint, 2> ends;

  /// Directions X between two neighbouring azimuths of the grid, those of mirrored offsets not counted.
  [[nodiscard]] std::size_t size() const { return elevations.size() * offsets.size(); }
};

/// Where panels of the elevation of X end.
enum class InnerPanels {
  on_all_rings,  ///< of lobes that have kinks where both elevations are the same, as formulas have
  by_width       ///< on as few rings as the width of the lobes leaves: nothing is known of kinks
};

/// Quadrature over X for the compositions of isotropic f and g at all nodes of a product grid at once.
///
/// The lobes of f about L and of g about V, L and V nodes of the grid, have their peaks and their kinks of max(N.L,
/// N.X) at the elevations of its rings and at its azimuths, whatever their width. So panels of the elevation end on all
/// rings and shrink towards the horizon, and the azimuths of X are those of the grid together with copies of them at
/// offsets: equal steps where lobes are wide against the grid's, else panels that shrink towards the offset 0.
class InnerRule {
 public:
  /// \param level 0, 1, ... kLevels - 1: refinement in all coordinates
  InnerRule(const HemisphereGrid& grid, const LobeExtent& f, const LobeExtent& g, std::size_t level,
            InnerPanels panels = InnerPanels::on_all_rings);

  static constexpr std::size_t kLevels = 5;

  [[nodiscard]] const std::vector<InnerBand>& bands() const { return bands_; }
  /// Directions X between two neighbouring azimuths of the grid.
  [[nodiscard]] std::size_t size() const;

 private:
  std::vector<InnerBand> bands_;
};

}  // namespace lobe
