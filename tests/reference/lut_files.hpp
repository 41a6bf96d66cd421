#pragma once

/// Readers of lookup tables' files, written from the descriptions of the formats and not from the library's:
/// straightforward, for files that are sound.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lobe::reference {

/// An array of NumPy, version 1.0, of little-endian doubles, the last index the quickest.
struct DoubleArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};
/// Source: NumPy Enhancement Proposal 1.
/// \throws std::runtime_error for other files
[[nodiscard]] DoubleArray read_double_array(const std::filesystem::path& path);

/// The components of the constant arrays in a SPIR-V module, as compilers of GLSL write it, the longest array alone.
/// Source: SPIR-V Specification 1.0, sections 2.3, 3.32.6 and 3.32.7.
/// \throws std::runtime_error for a file that is no module
[[nodiscard]] std::vector<float> constants_of_module(const std::filesystem::path& path);

/// A KTX 2.0 file without supercompression.
struct KtxFile {
  std::uint32_t format = 0;  ///< VkFormat
  std::uint32_t width = 0, height = 0, depth = 0;
  std::uint32_t levels = 0;
  std::map<std::string, std::string> texts;  ///< keys and values, without the zeros that end them
  struct Sample {
    std::uint32_t offset, length, channel, lower, upper;
  };
  std::uint32_t color_model = 0, primaries = 0, transfer = 0, bytes_of_texel = 0;
  std::vector<Sample> samples;
  std::vector<double> values;  ///< of the first level, as samples and their kinds say
};
/// Source: KTX File Format Specification 2.0, sections 2 and 3; Khronos Data Format Specification 1.3, section 5.
/// \throws std::runtime_error for files that break a rule of the container
[[nodiscard]] KtxFile read_ktx(const std::filesystem::path& path);

}  // namespace lobe::reference
