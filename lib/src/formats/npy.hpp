#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/file_bytes.hpp"

namespace lobe {

/// An array of numbers as NumPy saves it (`numpy.save`), the last index the quickest.
struct NpyArray {
  std::vector<std::size_t> shape;  ///< empty: a single number
  std::vector<double> values;      ///< as many as the product of the shape; may be NaN or infinite
};

/// Header of an .npy file, before its numbers are read.
struct NpyHeader {
  std::vector<std::size_t> shape;
  char kind = 'f';             ///< kind of the numbers: 'f', 'i' (signed) or 'u'
  std::size_t width = 8;       ///< bytes of a number
  bool is_by_columns = false;  ///< Fortran order: the first index is the quickest
  std::size_t offset = 0;      ///< offset of the numbers in the file

  [[nodiscard]] std::size_t rank() const { return shape.size(); }
  /// How many numbers there are; the product does not overflow.
  [[nodiscard]] std::size_t count() const;
};

/// Reads the header of an .npy of version 1, 2 or 3 strictly: the keys descr, fortran_order and shape, once each, and
/// numbers of 32 or 64 bits ('<f4', '<f8') or integers of up to 64, little-endian.
/// Source: NumPy, "A simple file format for NumPy arrays" (numpy.lib.format).
/// \throws IoError with the place for anything else, and where the file does not hold exactly the numbers that the
///   shape asks for.
[[nodiscard]] NpyHeader read_npy_header(const FileBytes& file);

/// Reads an array; nothing is allocated before its size is known to be that of the file.
/// \throws IoError as read_npy_header()
[[nodiscard]] NpyArray read_npy(const FileBytes& file);

/// Reads a list of texts ('<U5', as of numpy.array(["red", "blue"])).
/// \throws IoError as read_npy_header()
[[nodiscard]] std::vector<std::string> read_npy_texts(const FileBytes& file);

/// Bytes before the numbers in an .npy file of this shape, as npy_content() writes them.
[[nodiscard]] std::string npy_header(std::span<const std::size_t> shape);

/// The content of an .npy with these numbers, version 1.0, '<f8', the last index the quickest.
/// \param values as many as the product of the shape.
/// \throws ArgumentError where they are not
[[nodiscard]] std::string npy_content(std::span<const std::size_t> shape, std::span<const double> values);

}  // namespace lobe
