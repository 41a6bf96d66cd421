#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "device/evaluate_lobes.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// Directions as unit vectors, each by a number of points over which values are averaged.
struct DirectionSet {
  std::size_t count = 0;
  std::size_t points = 1;
  std::vector<Direction> directions;  ///< count x points
};

/// A lobe and its weight.
struct WeightedLobe {
  std::size_t batch = 0;
  std::size_t lobe = 0;  ///< within its batch
  double weight = 0;
};

/// values[row][column] = sum of weight f(rows[row]; columns[column]), averaged over both directions' points
/// (kernels/lobes/tabulate_pairs.cl); sr^-1. `values` is used in place on devices that share the host's memory, a block
/// of rows at a time.
/// \param first_column by row: columns before it (down to a multiple of eight) keep what they hold; empty: none
/// \throws DeviceError; ArgumentError when sizes do not fit
void tabulate_pairs(const Device& device, const std::vector<LobeBatch>& batches, std::span<const WeightedLobe> lobes,
                    Precision precision, const DirectionSet& rows, const DirectionSet& columns,
                    std::span<const unsigned> first_column, std::span<double> values);

}  // namespace lobe
