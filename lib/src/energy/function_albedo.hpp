#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "energy/joint_albedo.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// How well an albedo of a function is to be known.
struct AlbedoEffort {
  double relative = 2e-5;            ///< error wanted
  std::size_t most_points = 30'000;  ///< what is not resolved by then is in the error
};

/// Albedos by direction, with the errors of the quadrature apart from those of the function, which has neither delta
/// parts nor ring cells.
[[nodiscard]] std::vector<JointSums> albedo_sums(const BrdfFunction& function, std::span<const Direction> incident,
                                                 double lobe_width = AlbedoOptions{}.lobe_width,
                                                 const AlbedoEffort& effort = {});

}  // namespace lobe
