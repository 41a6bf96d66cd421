#pragma once

/// Readers of lookup tables' files, written from the descriptions of the formats and not from the library's:
/// straightforward, for files that are sound.

#include <cstddef>
#include <cstdint>
#include <filesystem>
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

}  // namespace lobe::reference
