#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "lobe/core/progress.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// How much work averages over cells may take.
struct CellEffort {
  /// Errors below this stay, relative to the value and to the mean one, beside those that average_over_cells() leaves.
  double tolerance = 0;
  /// Pairs that are looked at before the rest keeps its error, beside those that every pair of cells takes.
  std::size_t budget = std::size_t{12} << 20U;
};

/// A reflectance whose averages over pairs of cells are wanted, and what its symmetries save.
struct AveragedFunction {
  std::string name;                                           ///< for messages
  std::function<BrdfValues(std::span<const Directions>)> at;  ///< values, and errors of their own where there are any
  bool is_isotropic = true;
  bool is_bilateral = false;   ///< of isotropic ones: the same for delta_phi and -delta_phi
  bool is_reciprocal = false;  ///< to the last bits
  bool is_concurrent = true;   ///< `at` gains from several threads
  /// Half-vector widths (radians) of the narrowest lobes about the mirror and about the retro direction, which are
  /// looked for down to them; 1: none.
  double width = 0.005;
  double retro_width = 1;
  double rounding = 1e-12;  ///< of sums that cancel, as Zernike polynomials do, relative to the largest value of a row
  CellEffort effort = {};
};

/// Fills values and errors of a table on a grid of cells with averages of a function over pairs of cells, weighted by
/// projected solid angle, as Klems' matrices are defined: A_ij = integral over both cells of f dmu dmu / (w_i w_j).
///
/// Isotropic functions on rings of equal cells are integrated over both angles from the normal and delta_phi, in panels
/// of delta_phi between the limits of all overlaps of cells, which are linear there; other ones over both cells. Gauss
/// rules of boxes are compared with those of their halves (quarters, ...), and boxes halved until what is left of the
/// difference is below 1e-5 of the value and of the mean one (1e-4 over four coordinates), or below
/// CellEffort::tolerance. The error is what the differences leave, by the rate at which they fall, the function's own,
/// and rounding; isotropic tables of functions that are not bilateral hold the mean of both sides, half the difference
/// of which is added.
/// \param table grid, form and channels are set
/// \param points per coordinate of a cell to begin with, at least 2
/// \throws NumericError for values that are no finite numbers; Cancelled.
void average_over_cells(const AveragedFunction& function, BrdfTable& table, std::size_t points,
                        const ProgressCallback& progress);

}  // namespace lobe
