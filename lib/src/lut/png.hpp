#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "formats/file_bytes.hpp"

namespace lobe {

/// An image of linear values.
struct LinearImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t channels = 1;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
  int bits = 16;             ///< 8 or 16
  std::vector<std::uint16_t> values;
};

/// Content of a PNG file, with gamma 1.
/// \param texts keywords and texts of its tEXt chunks
[[nodiscard]] std::string png_content(const LinearImage& image,
                                      const std::vector<std::pair<std::string, std::string>>& texts);

/// Reads a PNG of 8 or 16 bits without a palette; its gamma is ignored.
/// \throws IoError
[[nodiscard]] LinearImage read_png(const FileBytes& file);

}  // namespace lobe
