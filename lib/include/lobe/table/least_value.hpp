#pragma once

#include <cstddef>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A value of a table and its place.
struct PlacedValue {
  Estimate value;  ///< sr^-1
  Directions at;   ///< radians
};

/// Finds the smallest value in the smooth part of a channel, which shows whether a computed table is a reflectance. If
/// values are negative beyond their errors, it is the most certainly negative one, whatever larger errors hide.
[[nodiscard]] PlacedValue least_value(const BrdfTable& table, std::size_t channel);

}  // namespace lobe
