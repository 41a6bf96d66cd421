#pragma once

#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/tabulate.hpp"

namespace lobe {

// The verbs of this room where formulas have been prepared already: adjusted() has been called.

/// As tabulate().
[[nodiscard]] BrdfTable table_on(const Device& device, const Reflectance& reflectance, const HemisphereGrid& grid,
                                 const TabulateOptions& options);

/// As as_function().
[[nodiscard]] BrdfFunction function_of(const Device& device, const Reflectance& reflectance,
                                       Precision precision = Precision::double_precision);

/// As as_function(), without delta parts: the function with the values of evaluate().
[[nodiscard]] BrdfFunction smooth_function(const Device& device, const Reflectance& reflectance,
                                           Precision precision = Precision::double_precision);

}  // namespace lobe
