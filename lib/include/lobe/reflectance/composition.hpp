#pragma once

#include <span>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/algebra/pointwise.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// Whether compose() takes it: no table, isotropic, without delta parts, also of adjustments, and a function only where
/// its values are those that the source defines, which no interpolation between scattered samples is.
[[nodiscard]] bool can_be_composed(const Reflectance& reflectance);

/// The composition of two reflectances at the nodes of a gauss or uniform grid, integrated over directions X at which
/// both are evaluated, not over tables: compose() of their tables with ComposeOptions::resolve_formulas, where a
/// function counts as a formula. The grid need not resolve the factors. Of functions that tell delta_phi from
/// -delta_phi the odd parts are composed, too: the table has the mean of both signs of the composition, and `odd_part`
/// half their difference, which `error` contains.
/// \throws ArgumentError for other grids, and where can_be_composed() is false; NumericError for values that are no
///   finite numbers; DeviceError; Cancelled.
[[nodiscard]] BrdfTable compose(const Device& device, const Reflectance& f, const Reflectance& g,
                                const HemisphereGrid& grid, const ComposeOptions& options = {});

/// Composition C_{f,g}(L,V) = integral of f(L,X) g(X,V) dmu(X) in sr^-1 (Neumann 2001, eq. 1.21) at given pairs of
/// directions. theta_in and theta_out in [0, pi/2). Two forward-reflecting lobes compose to a lobe about the retro
/// direction, delta_phi = 0. A single channel serves all channels of the other.
///
/// Of isotropic formulas by adaptive quadrature over X that knows the peaks, kinks and edges of both: right for lobes
/// of any width and without the grid of a table. Of a function or a table and anything else by adaptive cubature over X
/// that knows the peaks alone, with values as they are for either sign of delta_phi, anisotropic ones and those that
/// are interpolated, whose errors are then contained. A value that the quadrature cannot bring to the tolerance is
/// returned with the error that it has, and told to `options.missed`.
/// \return estimate[channel][pair]
/// \throws ArgumentError for an angle out of range or channels that do not fit; NumericError for delta parts, values
///   that are no finite numbers and anisotropic formulas, and what `options.missed` throws; as adjusted(); DeviceError.
[[nodiscard]] std::vector<std::vector<Estimate>> composition_at(const Device& device, const Reflectance& f,
                                                                const Reflectance& g,
                                                                std::span<const Directions> directions,
                                                                const PointwiseOptions& options = {});

}  // namespace lobe
