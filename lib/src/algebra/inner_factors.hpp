#pragma once

#include "algebra/resolved_product.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// Whether a material has values as a factor must: isotropic and reciprocal.
[[nodiscard]] bool can_be_factor(const Material& material);

/// A material without delta parts as a factor of a composition at the nodes of a product grid.
[[nodiscard]] InnerFactor formula_factor(const Device& device, const Material& material, const HemisphereGrid& grid,
                                         Precision precision);

/// Which factor of a composition a function is: it need not be reciprocal.
enum class FactorPlace { first, second };

/// An isotropic function as a factor. The width of its lobe is that over which it
/// falls to a half about the mirror direction at some angles of incidence.
[[nodiscard]] InnerFactor function_factor(const BrdfFunction& brdf, const HemisphereGrid& grid, FactorPlace place);

}  // namespace lobe
