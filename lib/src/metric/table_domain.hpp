#pragma once

#include <numbers>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// Projected solid angle per ring by the full rule and by one of every second ring; together those of the domain.
struct RingWeights {
  std::vector<double> full;
  std::vector<double> embedded;
  std::vector<double> other;  ///< of the rings that are not in `embedded`
};

/// Weights for integrals up to a largest angle, radians, from values on rings. On grids without cells they are those of
/// cubics in cos(theta) through four neighbours, so that the angle may be any; on grids of cells whole rings.
/// \throws ArgumentError where the angle is within a ring of cells
[[nodiscard]] RingWeights ring_weights_up_to(const HemisphereGrid& grid, double theta_max);

/// Albedos of a channel by V, over L up to the largest angle of the weights, by row; delta parts included.
[[nodiscard]] std::vector<Estimate> albedos_up_to(const BrdfTable& table, std::size_t channel,
                                                  const RingWeights& weights);

}  // namespace lobe
