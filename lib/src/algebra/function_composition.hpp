#pragma once

#include "lobe/algebra/algebra.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// compose() of reflectances whose formulas are prepared.
/// \throws ArgumentError where can_be_factor() is false
[[nodiscard]] BrdfTable compose_factors(const Device& device, const Reflectance& f, const Reflectance& g,
                                        const HemisphereGrid& grid, const ComposeOptions& options);

/// can_be_composed() of a reflectance whose formulas are prepared.
[[nodiscard]] bool can_be_factor(const Reflectance& reflectance);

}  // namespace lobe
