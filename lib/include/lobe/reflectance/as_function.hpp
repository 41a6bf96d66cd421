#pragma once

#include "lobe/device/device.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A reflectance as a function of pairs of directions: a function as it is; a table by interpolation, on grids of cells
/// with the table as its `cells`; formulas by evaluating them, one call at a time.
/// \param precision of the models
/// \throws ArgumentError for delta parts elsewhere than on grids of cells; as adjusted(). The function throws as
///   evaluate().
[[nodiscard]] BrdfFunction as_function(const Device& device, const Reflectance& reflectance,
                                       Precision precision = Precision::double_precision);

}  // namespace lobe
