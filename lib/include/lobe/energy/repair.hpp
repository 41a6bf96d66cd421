#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

// Functions that make an implausible reflectance (check_plausibility()) plausible, or brighten one that absorbs too
// much. Tables are repaired as the discrete operators they are: albedos are sums over their grid, delta parts included.
// "Rows" are rows of BrdfTable. The expression of a repaired table records the repair. The error bounds of its values
// contain the errors of the albedos used; delta parts have no error bounds.

/// The table on which a reflectance is repaired.
struct RepairGrid {
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< grid of the table; none: natural_grid()
  TabulateOptions tabulation = {};                    ///< options for tabulating on it
};

/// Options for pumping-up.
struct PumpOptions {
  /// Number of steps; none: until no albedo changes by `tolerance` any more. At most 10 for formulas.
  std::optional<int> times = 1;
  double tolerance = 1e-4;  ///< absolute
  int limit = 200;          ///< largest number of steps if `times` is none; at most 10 for formulas
  /// For formulas: angles of incidence (radians) at which the steps are reported.
  std::vector<double> theta_in = {};
  RepairGrid table = {};           ///< table for everything except formulas, which stay formulas
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Albedos and mirror radiances before pumping-up or after a step, channels x angles of incidence.
struct PumpStep {
  std::vector<std::vector<Estimate>> albedo;           ///< albedo for light from L
  std::vector<std::vector<Estimate>> mirror_radiance;  ///< smooth part at (L, R) times N.L, sr^-1
};

/// Result of pumping-up.
struct Pumped {
  Reflectance
      result;  ///< the reflectance after the last step: formulas if it was given by isotropic ones, else a table
  std::vector<double> theta_in;  ///< angles of incidence of the steps, radians; for tables one per row
  std::vector<PumpStep> steps;   ///< the state before, then after each step; errors include those of the steps
  double change = 0;             ///< for tables: largest change of an albedo in the last step
  bool is_converged = false;     ///< whether no albedo changed by more than the tolerance in the last step
  std::string obstacle;          ///< if `times` is none: why there was no further step; empty if none was needed
};

/// Pumps up a reflectance (energy compensation): divides it by the divisor of a correction (Neumann 2001, eq. 2.16 to
/// 2.21), step by step, channel by channel. a(L) is the albedo for light from L and a(V) that for light into V; they
/// are equal for reciprocal reflectances.
///
/// Tables: delta parts count as values at (L, R) and (L, L) and are divided accordingly. The result has a* <= 1, a <=
/// a* if no albedo was above 1, and stays reciprocal, all to rounding; rows of zeros stay zero.
/// Isotropic formulas: albedos are computed to kAdjustmentError; anisotropic ones are pumped up as tables.
/// \throws ArgumentError for options out of range; NumericError for values below 0 by more than their error, and as
///   adjusted(), where options.times is none for the first step only; as tabulate() and albedo(); Cancelled
[[nodiscard]] Pumped pump(const Device& device, const Reflectance& reflectance, Correction correction,
                          const PumpOptions& options = {});

/// Normalises a reflectance: divides its table by the largest albedo for light from L, over all channels.
/// \throws NumericError unless that albedo is above 0; as tabulate()
[[nodiscard]] BrdfTable normalise(const Device& device, const Reflectance& reflectance, const RepairGrid& table = {});

/// Symmetrises a reflectance to (f(L, V) + f(V, L)) / 2, the nearest reciprocal table under point light. A table that
/// is reciprocal to the last bit stays unchanged.
/// \throws as tabulate()
[[nodiscard]] BrdfTable symmetrise(const Device& device, const Reflectance& reflectance, const RepairGrid& table = {});

/// Options for balancing a reflectance.
struct BalanceOptions {
  /// Amount by which albedos may exceed 1 or, where a factor is below 1, differ from 1.
  double tolerance = 1e-12;
  /// Whether all channels share their factors, which preserves ratios of channels but darkens channels that need no
  /// darkening. Otherwise each channel has its own factors: plausible channels are left alone, and none moves further
  /// than it must.
  bool channels_together = false;
  /// Whether factors may exceed 1, so that a* = 1 for all L, a white reflectance (Sinkhorn 1964). With channels
  /// together this holds for the brightest channel.
  bool to_white = false;
  /// Whether a table that is not reciprocal is balanced as its reciprocal part, the mean of f(L, V) and f(V, L),
  /// instead of being refused.
  bool reciprocal_part = false;
  std::size_t limit = 10000;       ///< largest number of sweeps
  RepairGrid table = {};           ///< table to balance
  ProgressCallback progress = {};  ///< told of the progress; may cancel
  /// Told if `limit` sweeps do not reach the tolerance; empty: only `departure` tells.
  MissedToleranceCallback missed = {};
};

/// A table whose energy balance is restored.
struct BalancedTable {
  BrdfTable table;                           ///< s(L) f(L, V) s(V)
  std::vector<std::vector<double>> factors;  ///< s, channels x rows
  std::size_t sweeps = 0;                    ///< largest number of sweeps for a channel; 0 if there was nothing to do
  double asymmetry = 0;  ///< largest |f(L, V) - f(V, L)|, sr^-1, of a table that was made reciprocal first; else 0
  double departure = 0;  ///< largest amount by which an albedo was off its bound before the last sweep
};

/// Restores the energy balance of a reciprocal table by f*(L, V) = s(L) f(L, V) s(V) with 0 < s <= 1, so that it stays
/// reciprocal: mirror factors are multiplied by s(L) s(R), RRIM factors by s(L)^2. The factors s give a* <= 1
/// everywhere and a* = 1 wherever s < 1: nothing becomes darker than the balance of its own row requires. They are the
/// minimum of
///   1/2 integral s(L) f(L, V) s(V) dmu dmu - integral ln s dmu
/// which is convex in ln s, so it exists, and is unique where f(L, L) > 0. It is found by minimising over each s(L) in
/// turn, sweep by sweep. If several channels share one s, no such function is known; the conditions are the same. A
/// table that is balanced to the tolerance is returned unchanged, with s = 1.
/// \throws ArgumentError for options out of range; NumericError for values below 0 or a table that is not reciprocal,
///   both by more than its errors, the latter unless options.reciprocal_part, and with `to_white` for a row of zeros,
///   and whatever options.missed throws; as tabulate(); Cancelled
[[nodiscard]] BalancedTable scale_symmetrically(const Device& device, const Reflectance& reflectance,
                                                const BalanceOptions& options = {});

}  // namespace lobe
