#pragma once

#include <cstddef>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A value of a table and where it is.
struct PlacedValue {
  Estimate value;  ///< sr^-1
  Directions at;   ///< radians
};

/// The smallest value of the smooth part of a channel: whether a table made by calculation is a reflectance. Where
/// values are negative beyond their errors it is the one that is so most certainly, whatever larger errors hide.
[[nodiscard]] PlacedValue least_value(const BrdfTable& table, std::size_t channel);

}  // namespace lobe
