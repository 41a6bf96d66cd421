#pragma once

#include <string>

#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"
#include "lobe/table/table_use.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Chooses the default grid for tabulating a reflectance: the grid of a table or of a function's cells, gauss:64x128
/// for formulas and isotropic functions, gauss:24x48 for other functions.
[[nodiscard]] HemisphereGrid natural_grid(const Reflectance& reflectance);

/// Tabulates a reflectance as the operator on a grid.
///
/// Formulas: values at the nodes, or averages over cells. Delta parts (models `mirror`, `rrim`) are kept separate and
/// exact.
///
/// Functions: cells are copied on their own grid and treated as a table on another; other functions give values. On
/// product grids an isotropic function makes an isotropic table with the mean of both signs of delta_phi; half of their
/// difference counts as an error of the values, beside rounding and the function's own errors. The error of the
/// measurement itself is unknown. The table is not made symmetric in L and V, since measured data are not reciprocal;
/// see symmetrise(). resolution_error compares the integrals of f^2 with those on the refined grid.
///
/// Tables: a table on this grid is returned unchanged. A table on another grid is interpolated (local polynomials of
/// degree 5), and the error, measured against lower degrees, is added. From cells to cells this is exact, by the
/// measures of their intersections; other tables are averaged over cells adaptively. The result is marked as unresolved
/// if the squared norm changes by more than 10 %, and the expression records the step.
///
/// \throws NumericError if the grid does not resolve a lobe or a function, with the resolution needed, unless
///   options.allow_unresolved, and for values that are not finite; ArgumentError if a table is inconsistent, and with
///   options.exact_grid for a table on another grid; as adjusted(); DeviceError; Cancelled
[[nodiscard]] BrdfTable tabulate(const Device& device, const Reflectance& reflectance, const HemisphereGrid& grid,
                                 const TabulateOptions& options = {});

/// Finds the smallest gauss grid in the series 8x16, 12x24, 16x32, 24x48, ... that resolves every reflectance to
/// options.tolerance. Tables count if their formulas are known.
/// \throws NumericError if no grid up to 512x1024 does, with the resolution needed; ArgumentError for functions, and
///   for tables without formulas; as adjusted()
[[nodiscard]] HemisphereGrid choose_grid(const Device& device, const ReflectanceList& reflectances,
                                         const TabulateOptions& options = {});

/// The grid on which reflectances are tabulated together where none is given: that of the first table or function of
/// cells; else the coarsest that resolves all of them to options.tolerance, from the natural_grid() of the first one
/// that is no formula on. Isotropic tables get at most gauss:512x1024 (gauss:256x512 where functions are among them, or
/// for decompositions), general ones gauss:64x128 (gauss:48x96; decompositions: gauss:24x48). If none of these resolves
/// them, it is the finest; a table on it is made with options.allow_unresolved, and states its resolution_error.
/// \throws as adjusted(); DeviceError
[[nodiscard]] HemisphereGrid resolving_grid(const Device& device, const ReflectanceList& reflectances,
                                            TableUse use = TableUse::values, const TabulateOptions& options = {});
/// Refines another grid to start from in the same way. A grid that is not of gauss nodes stays as it is.
/// \throws as adjusted(); DeviceError
[[nodiscard]] HemisphereGrid resolving_grid(const Device& device, const ReflectanceList& reflectances,
                                            const HemisphereGrid& start, TableUse use = TableUse::values,
                                            const TabulateOptions& options = {});

/// Describes a finer grid that resolves a reflectance to options.tolerance, for messages: "gauss:256x512", or "about
/// gauss:2048x4096 or more". Empty for tables.
/// \throws as adjusted(); DeviceError
[[nodiscard]] std::string resolution_needed(const Device& device, const Reflectance& reflectance,
                                            const HemisphereGrid& grid, const TabulateOptions& options = {});

}  // namespace lobe
