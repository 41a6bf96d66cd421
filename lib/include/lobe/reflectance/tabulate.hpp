#pragma once

#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// The grid that a reflectance is tabulated on where nothing else is wanted: that of a table or of a function's cells,
/// gauss:64x128 for formulas and isotropic functions, gauss:24x48 for other functions.
[[nodiscard]] HemisphereGrid natural_grid(const Reflectance& reflectance);

/// A reflectance as the operator on a grid.
///
/// Formulas: values at the nodes, or averages over cells. Delta parts (models `mirror`, `rrim`) are kept apart, exact.
///
/// Functions: cells as they are on their own grid, and as a table on another one; else values. On product grids the
/// table of an isotropic one is isotropic and takes the mean of both signs of delta_phi; half their difference counts
/// as error of its values, beside rounding and the function's own errors. What a measurement itself is worth nobody
/// knows. Not made symmetric in L and V: measured data is not reciprocal, see symmetrise(). resolution_error compares
/// the integrals of f^2 with those of the refined grid.
///
/// Tables on this grid are returned as they are, those on another one are brought to it by interpolation (local
/// polynomials of degree 5), the error of which is measured against lower degrees and added. From cells to cells that
/// is exact, by the measures of what they have in common; other tables are averaged over cells adaptively. Marked as
/// unresolved where the squared norm changes by more than 10 %. The expression says so.
///
/// \throws NumericError when the grid does not resolve a lobe or a function, with the resolution it needs, unless
///   options.allow_unresolved, and for values that are no finite numbers; ArgumentError where a table is inconsistent,
///   and with options.exact_grid for one on another grid; as adjusted(); DeviceError; Cancelled.
[[nodiscard]] BrdfTable tabulate(const Device& device, const Reflectance& reflectance, const HemisphereGrid& grid,
                                 const TabulateOptions& options = {});

/// The smallest gauss grid of the series 8x16, 12x24, 16x32, 24x48, ... that resolves every reflectance to
/// options.tolerance, of tables those whose formulas are known.
/// \throws NumericError when none up to 512x1024 has, with the resolution needed; ArgumentError for functions, and for
///   tables of what has no formulas; as adjusted().
[[nodiscard]] HemisphereGrid choose_grid(const Device& device, const ReflectanceList& reflectances,
                                         const TabulateOptions& options = {});

}  // namespace lobe
