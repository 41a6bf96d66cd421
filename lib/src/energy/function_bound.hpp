#pragma once

#include <cstddef>
#include <numbers>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/energy/plausibility.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// Where the largest albedo of a function is looked for.
struct FunctionSearch {
  std::size_t angles = 46;    ///< of incidence over the quarter circle, before the search narrows
  std::size_t azimuths = 12;  ///< of anisotropic functions, over a turn
  double least_elevation = 0.01 * std::numbers::pi / 180;  ///< of the most grazing direction, radians, above 0
  double lobe_width = AlbedoOptions{}.lobe_width;
  bool of_absolute = false;  ///< whether the albedo of the largest absolute value is wanted
};

/// The largest albedos of a function by channel.
struct FunctionBounds {
  std::vector<AlbedoBound> channels;
  std::vector<double> certain;  ///< the largest albedo less its error by channel; unknown errors count as 0
  std::size_t incident = 0;     ///< directions looked at
};

/// Searches for the largest albedos of a function without delta parts: roughly over all directions, then as well as
/// albedo() knows them where the largest may be, then between the best direction and those beside it. The error
/// contains what the albedo may be larger by between these, where it bends down.
/// \throws NumericError for values that are no finite numbers
[[nodiscard]] FunctionBounds albedo_bounds(const BrdfFunction& function, const FunctionSearch& how);

}  // namespace lobe
