#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/lut/lut.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A file format for lookup tables.
enum class LutFormat {
  csv,    ///< a line per entry: values of the axes, columns, errors; doubles
  npy,    ///< NumPy array, axes then columns; doubles
  c,      ///< C header with an array of floats
  glsl,   ///< GLSL constant array of float, vec2, vec3 or vec4
  png,    ///< image of 8 or 16 bits, linear, [0, 1]; one or two axes, the last one along the rows; up to 4 columns
  spi1d,  ///< one-dimensional table for OpenColorIO; one axis, linear, entries at nodes; up to 3 columns
  hdf5,   ///< HDF5 file with a dataset for each column along its axes, readable as netCDF; doubles
  exr,    ///< OpenEXR image of 16 or 32 bits, floating point; one or two axes, the last one along the rows
  ktx2    ///< KTX 2.0 texture of 8 or 16 bits, [0, 1], or floating point with 16 or 32; up to 3 axes and 4 columns
};
/// Names of all formats: "csv", "npy", "c", "glsl", "png", "spi1d", "hdf5", "exr", "ktx2".
[[nodiscard]] std::vector<std::string_view> lut_format_names();
/// Reads the name of a format.
/// \throws ArgumentError for an unknown name
[[nodiscard]] LutFormat parse_lut_format(std::string_view name);
/// Format by the ending of a file name: .csv, .npy, .h, .glsl, .png, .spi1d, .h5, .exr, .ktx2.
/// \throws ArgumentError for another ending
[[nodiscard]] LutFormat lut_format_of(const std::filesystem::path& path);

/// How a lookup table is written.
struct LutFileOptions {
  LutFormat format = LutFormat::csv;  ///< format of the file
  /// Bits of a number in PNG (8 or 16), EXR (16 or 32) and KTX2 (8 or 16; floating point 16 or 32); 0: 16, 32 and 16.
  int bits = 0;
  bool is_float = false;          ///< whether a KTX2 has floating-point numbers
  std::string name = "lut";       ///< name of the array in C and GLSL
  std::string command_line = {};  ///< stands in the header as origin
};

/// The values as a file of the format holds them: to float or half, to levels of 8 or 16 bits, or as they are.
/// \throws ArgumentError where the format cannot hold the table: too many axes or columns, values beyond
///   [0, 1] or the largest number
[[nodiscard]] Lut as_stored(const Lut& lut, const LutFileOptions& options);

/// Content of a file. All but NPY state axes, conventions and errors.
/// \param stored as as_stored() returned it
/// \param errors of `stored`; none: not stated
/// \throws as as_stored()
[[nodiscard]] std::string lut_file(const Lut& stored, const std::optional<LutErrors>& errors,
                                   const LutFileOptions& options);

/// Reads somebody's table: the numbers of a file in any of the formats, which must be as many as the
/// definition has entries, times 1 or the number of its columns. With one column for a definition of several, that is
/// the first.
/// \throws IoError for a file that cannot be read, or has another number of values
[[nodiscard]] Lut read_lut(const std::filesystem::path& path, const LutRequest& request);

}  // namespace lobe
