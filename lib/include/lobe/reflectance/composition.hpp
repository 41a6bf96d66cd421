#pragma once

#include <span>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/algebra/pointwise.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Whether compose() accepts a reflectance: not a table, isotropic, and without delta parts, including those from
/// adjustments. Functions are accepted only if their source defines their values; interpolation between scattered
/// samples does not.
[[nodiscard]] bool can_be_composed(const Reflectance& reflectance);

/// Composes two reflectances at the nodes of a gauss or uniform grid by integrating over directions X at which both are
/// evaluated, not over tables. It does what compose() does for their tables with ComposeOptions::resolve_formulas, with
/// functions counted as formulas. The grid need not resolve the factors. If functions distinguish delta_phi from
/// -delta_phi, their odd parts are composed, too: the table has the mean of the composition over both signs, and
/// `odd_part` half of their difference, which `error` contains.
/// \throws ArgumentError for other grids, and if can_be_composed() is false; NumericError for values that are not
///   finite; DeviceError; Cancelled
[[nodiscard]] BrdfTable compose(const Device& device, const Reflectance& f, const Reflectance& g,
                                const HemisphereGrid& grid, const ComposeOptions& options = {});

/// Composition C_{f,g}(L,V) = integral of f(L,X) g(X,V) dmu(X) in sr^-1 (Neumann 2001, eq. 1.21) at given pairs of
/// directions, with theta_in and theta_out in [0, pi/2). Two forward-reflecting lobes compose to a lobe about the retro
/// direction, delta_phi = 0. A single channel serves all channels of the other operand.
///
/// Isotropic formulas use an adaptive quadrature over X that knows the peaks, kinks and edges of both; it is correct
/// for lobes of any width. Everything else uses an adaptive cubature over X that knows only the peaks, with values as
/// they are for either sign of delta_phi, and the errors of interpolation included. Delta parts of formulas add the
/// other factor where they send light; what both compose to, another delta part, is no value. A value off tolerance is
/// returned with the error that it has, and reported to `options.missed`.
/// \return estimate[channel][pair]
/// \throws ArgumentError for an angle out of range or channels that do not fit; NumericError for delta parts of
///   tables and files, values that are not finite, and whatever `options.missed` throws; as adjusted(); DeviceError
[[nodiscard]] std::vector<std::vector<Estimate>> composition_at(const Device& device, const Reflectance& f,
                                                                const Reflectance& g,
                                                                std::span<const Directions> directions,
                                                                const PointwiseOptions& options = {});

}  // namespace lobe
