#pragma once

#include <cstddef>

#include "device/opencl.hpp"

namespace lobe {

/// Rows of doubles on the device in packs of rows: values[pack][column][lane], in which row r is lane r % width of pack
/// r / width.
struct PackedRows {
  cl::Buffer values;
  std::size_t stride = 0;  ///< columns from one pack to the next
  std::size_t packs = 0;   ///< a multiple of three where accumulate_gram.cl reads them
  std::size_t width = 1;   ///< lanes

  [[nodiscard]] std::size_t rows() const { return packs * width; }
};

}  // namespace lobe
