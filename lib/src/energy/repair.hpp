#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobe/energy/repair.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

// Repairs, overloaded for each kind of reflectance. They throw as the public functions with these names.

/// A table after pumping-up.
struct PumpedTable {
  BrdfTable table;              ///< after the last step
  std::vector<PumpStep> steps;  ///< before, then after each step
  double change = 0;            ///< largest change of an albedo in the last step
  bool is_converged = false;    ///< whether that is at most the tolerance
};

[[nodiscard]] PumpedTable pump(const BrdfTable& table, Correction correction, const PumpOptions& options = {});

/// A material after pumping-up.
struct PumpedMaterial {
  std::vector<Material> steps;  ///< before, then after each step
  bool is_converged = false;    ///< no albedo changed by more than the tolerance in the last step
  std::string obstacle;         ///< where `times` is none: why there was no further step; empty: there was no need
};

/// Pumps up a material made of models, with albedos to kAdjustmentError; it is prepared first.
/// \throws ArgumentError for options out of range; NumericError as prepare(), where options.times is none for the first
///   step alone.
[[nodiscard]] PumpedMaterial pump(const Device& device, const Material& material, Correction correction,
                                  const PumpOptions& options = {});

/// Albedos and radiances after each step, at angles of incidence; errors include those of the steps.
/// \throws as albedo().
[[nodiscard]] std::vector<PumpStep> pump_curves(const Device& device, const PumpedMaterial& pumped,
                                                std::span<const double> theta_in, double tolerance = 1e-6);

/// The table over its largest albedo of light from L, over all channels.
/// \throws NumericError unless that is above 0.
[[nodiscard]] BrdfTable normalise(const BrdfTable& table);

/// (f(L, V) + f(V, L)) / 2: the nearest reciprocal table under point light. Unchanged where it is reciprocal to the
/// last bit.
[[nodiscard]] BrdfTable symmetrise(const BrdfTable& table);

[[nodiscard]] BalancedTable scale_symmetrically(const BrdfTable& table, const BalanceOptions& options = {});

}  // namespace lobe
