#pragma once

#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// Smooth part at arbitrary directions by interpolation, with its error; [channel][pair].
/// \throws as resample().
[[nodiscard]] std::vector<std::vector<Estimate>> evaluate(const BrdfTable& table,
                                                          std::span<const Directions> directions);

/// Albedos at any angles of incidence (radians, in [0, pi/2)) by interpolation; [channel][angle]. General tables: at
/// azimuth 0.
/// \throws ArgumentError for an angle out of range.
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const BrdfTable& table, std::span<const double> theta_in);
/// Albedos for any directions of incidence; [channel][direction].
[[nodiscard]] std::vector<std::vector<Estimate>> albedo(const BrdfTable& table, std::span<const Direction> incident);

}  // namespace lobe
