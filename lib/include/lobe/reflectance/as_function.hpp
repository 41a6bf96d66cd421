#pragma once

#include "lobe/device/device.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Turns a reflectance into a function of pairs of directions: a function stays as it is; a table is interpolated (on
/// grids of cells it becomes the function's `cells`); formulas are evaluated, one call at a time.
/// \param precision arithmetic of the models
/// \throws ArgumentError for delta parts except on grids of cells; as adjusted(). The function throws as evaluate().
[[nodiscard]] BrdfFunction as_function(const Device& device, const Reflectance& reflectance,
                                       Precision precision = Precision::double_precision);

}  // namespace lobe
