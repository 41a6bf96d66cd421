#pragma once

#include <variant>

#include "lobe/algebra.hpp"
#include "lobe/brdf_function.hpp"
#include "lobe/device.hpp"
#include "lobe/grid.hpp"
#include "lobe/material.hpp"
#include "lobe/table.hpp"

namespace lobe {

/// A reflectance that is known at any directions.
using Reflectance = std::variant<Material, BrdfFunction>;

/// Whether compose() takes it: isotropic, without delta parts, and a function only where its values are those that the
/// source defines, which no interpolation between scattered samples is.
[[nodiscard]] bool can_be_composed(const Reflectance& reflectance);

/// The composition of two reflectances at the nodes of a gauss or uniform grid, integrated over directions X at which
/// both are evaluated, not over tables: compose() of their tables with ComposeOptions::resolve_formulas, where a
/// function counts as a formula. The grid need not resolve the factors. Functions that tell delta_phi from -delta_phi
/// are taken for the mean of both; half the difference counts as error, as in tabulate().
/// \throws ArgumentError for other grids, and where can_be_composed() is false; NumericError for values that are no
/// finite
///   numbers; DeviceError; Cancelled.
[[nodiscard]] BrdfTable compose(const Device& device, const Reflectance& f, const Reflectance& g,
                                const HemisphereGrid& grid, const ComposeOptions& options = {});

}  // namespace lobe
