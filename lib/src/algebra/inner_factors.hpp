#pragma once

#include "algebra/resolved_product.hpp"
#include "lobe/device.hpp"
#include "lobe/material.hpp"

namespace lobe {

/// Whether a material has values as a factor must: isotropic and reciprocal.
[[nodiscard]] bool can_be_factor(const Material& material);

/// A material without delta parts as a factor of a composition at the nodes of a product grid.
[[nodiscard]] InnerFactor formula_factor(const Device& device, const Material& material, const HemisphereGrid& grid,
                                         Precision precision);

}  // namespace lobe
