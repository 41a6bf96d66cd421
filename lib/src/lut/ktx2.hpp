#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "formats/file_bytes.hpp"

namespace lobe {

/// A texture of one level, whose numbers are whole levels from 0 to 1 or floating-point numbers.
struct Texture {
  std::size_t width = 0;
  std::size_t height = 0;  ///< 0: one dimension
  std::size_t depth = 0;   ///< 0: at most two dimensions
  std::size_t channels = 1;
  int bits = 16;               ///< 8, 16 or, as floating-point numbers, 16 or 32
  bool is_float = false;       ///< whether they are floating-point numbers
  std::vector<double> values;  ///< the channels of a texel beside each other, the width the quickest
};

/// Content of a KTX 2.0 file without supercompression. A third channel is written with a fourth that is 1, as graphics
/// processors have no textures of three.
/// Source: Khronos Group, KTX File Format Specification 2.0.4; Khronos Data Format Specification 1.3.1, section 5.
/// \param texts keys, which are sorted here, and values
[[nodiscard]] std::string ktx2_content(const Texture& texture, std::vector<std::pair<std::string, std::string>> texts);

/// Reads the first level of a texture in one of the formats that ktx2_content() writes, or three channels alone.
/// \throws IoError
[[nodiscard]] Texture read_ktx2(const FileBytes& file);

}  // namespace lobe
