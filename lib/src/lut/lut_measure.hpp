#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "lobe/lut/lut.hpp"

namespace lobe {

/// Values that stand for those of a lookup table.
struct LutPrediction {
  /// \param coordinates one per axis, from 0 to 1
  /// \param column of the table
  using Value = std::function<double(std::span<const double> coordinates, std::size_t column)>;

  Value value;
  std::size_t first = 0;    ///< first column that it stands for
  std::size_t columns = 1;  ///< number of columns
};

/// Errors of each prediction, as lut_errors() measures those of interpolation, on one finer grid.
/// \throws ArgumentError for a refinement out of range; as make_lut()
[[nodiscard]] std::vector<LutErrors> measured_errors(const Device& device, const Lut& exact,
                                                     const std::vector<LutPrediction>& predictions, unsigned refinement,
                                                     const LutOptions& options);

/// Value of an axis through its map, in which entries are equally spaced.
[[nodiscard]] double mapped(AxisMap map, double value);

}  // namespace lobe
