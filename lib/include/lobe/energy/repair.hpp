#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

// What makes a reflectance plausible that is not (check_plausibility()), or brighter where it absorbs what it should
// not. Tables are repaired in their own measure: albedos are the sums over their grid, delta parts included. "Rows" are
// those of BrdfTable. Repaired tables say so in their expression; the error bounds of their values contain those of the
// albedos that they were repaired by; delta parts have none.

/// The table that a reflectance is repaired as.
struct RepairGrid {
  std::optional<HemisphereGrid> grid = std::nullopt;  ///< none: natural_grid()
  TabulateOptions tabulation = {};                    ///< how it gets there
};

/// How often is pumped up.
struct PumpOptions {
  /// None: until no albedo changes by `tolerance` any more. Of formulas at most 10.
  std::optional<int> times = 1;
  double tolerance = 1e-4;  ///< absolute
  int limit = 200;          ///< of steps where `times` is none; of formulas at most 10
  /// Of formulas: angles of incidence (radians) at which steps are told.
  std::vector<double> theta_in = {};
  RepairGrid table = {};           ///< of anything but formulas, which stay formulas
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// A reflectance before pumping-up or after a step, channels x angles of incidence.
struct PumpStep {
  std::vector<std::vector<Estimate>> albedo;           ///< of light from L
  std::vector<std::vector<Estimate>> mirror_radiance;  ///< smooth part at (L, R) times N.L, sr^-1
};

/// A reflectance after pumping-up.
struct Pumped {
  Reflectance result;            ///< after the last step: formulas of formulas, else a table
  std::vector<double> theta_in;  ///< angles of incidence of the steps, radians; of tables one per row
  std::vector<PumpStep> steps;   ///< before, then after each step; errors include those of the steps
  double change = 0;             ///< of tables: the largest change of an albedo in the last step
  bool is_converged = false;     ///< no albedo changed by more than the tolerance in the last step
  std::string obstacle;          ///< where `times` is none: why there was no further step; empty: there was no need
};

/// Divides a reflectance by the divisor of a correction (Neumann 2001, eq. 2.16 to 2.21), step by step, channel by
/// channel; a(L) is the albedo of light from L and a(V) that of light into V, which are the same for reciprocal ones.
///
/// Tables: the delta parts are values at (L, R) and (L, L), and are divided by what belongs there. Then a* <= 1,
/// a <= a* where no albedo was above 1, and reciprocity is kept, all to rounding; where all of a row is 0 it stays so.
/// Formulas: by albedos to kAdjustmentError.
/// \throws ArgumentError for options out of range; NumericError for values below 0 by more than their error, and as
///   adjusted(), where options.times is none for the first step alone; as tabulate() and albedo(); Cancelled.
[[nodiscard]] Pumped pump(const Device& device, const Reflectance& reflectance, Correction correction,
                          const PumpOptions& options = {});

/// The table over its largest albedo of light from L, over all channels.
/// \throws NumericError unless that is above 0; as tabulate().
[[nodiscard]] BrdfTable normalise(const Device& device, const Reflectance& reflectance, const RepairGrid& table = {});

/// (f(L, V) + f(V, L)) / 2: the nearest reciprocal table under point light. Unchanged where it is reciprocal to the
/// last bit.
/// \throws as tabulate().
[[nodiscard]] BrdfTable symmetrise(const Device& device, const Reflectance& reflectance, const RepairGrid& table = {});

/// How a reflectance is balanced.
struct BalanceOptions {
  /// By how much albedos may be above 1 and, where a factor is below 1, below 1.
  double tolerance = 1e-12;
  /// The same factors for all channels: ratios of channels stay, but channels are darkened that need not be. Otherwise
  /// each channel has its own: what is plausible is left alone, and none moves further than it must.
  bool channels_together = false;
  /// Factors above 1, too: a* = 1 for all L, a white reflectance (Sinkhorn 1964); of channels together that of the
  /// brightest channel.
  bool to_white = false;
  std::size_t limit = 10000;       ///< of sweeps
  RepairGrid table = {};           ///< what is balanced
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// A table whose energy balance is restored.
struct BalancedTable {
  BrdfTable table;                           ///< s(L) f(L, V) s(V)
  std::vector<std::vector<double>> factors;  ///< s, channels x rows
  std::size_t sweeps = 0;                    ///< most of a channel; 0: there was nothing to do
};

/// Restores the energy balance of a reciprocal table by f*(L, V) = s(L) f(L, V) s(V) with 0 < s <= 1, so that it stays
/// reciprocal: mirror factors are multiplied by s(L) s(R), RRIM factors by s(L)^2. The s taken is that with a* <= 1
/// everywhere and a* = 1 wherever s < 1: nothing is darker than the balance of its own row asks. It is the minimum of
///   1/2 integral s(L) f(L, V) s(V) dmu dmu - integral ln s dmu
/// which is convex in ln s; so it is there, and unique where f(L, L) > 0. Found by going to the minimum over each
/// s(L) in turn, sweep by sweep. With one s for several channels there is no such function; the conditions are the
/// same. A table that is balanced to the tolerance is returned as it is, with s = 1.
/// \throws ArgumentError for options out of range; NumericError for values below 0 or a table that is not reciprocal,
///   both by more than its errors; where `limit` sweeps do not suffice; with `to_white` for a row of zeros; as
///   tabulate(); Cancelled.
[[nodiscard]] BalancedTable scale_symmetrically(const Device& device, const Reflectance& reflectance,
                                                const BalanceOptions& options = {});

}  // namespace lobe
