#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "formats/file_bytes.hpp"

namespace lobe {

/// An image of floating-point numbers.
struct FloatImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::string> channels;  ///< names, in the order of the values
  std::vector<float> values;          ///< the channels of a pixel beside each other, row by row from the top
};

/// The nearest number of 16 bits (IEEE 754 binary16), infinite beyond 65504.
[[nodiscard]] double rounded_to_half(double value);

/// Bits of a number of 16 bits, and the number of such bits.
[[nodiscard]] unsigned half_bits(double value);
[[nodiscard]] double half_of_bits(unsigned bits);

/// Content of an OpenEXR file of scan lines, compressed without loss.
/// \param bits 16 or 32 of each number
/// \param texts names and values of its attributes
[[nodiscard]] std::string exr_content(const FloatImage& image, int bits,
                                      const std::vector<std::pair<std::string, std::string>>& texts);

/// Reads an OpenEXR file of scan lines that are not compressed, or by zip, with a value of every channel for every
/// pixel: R, G, B and A in this order, others as they come.
/// \param width columns that the image must have
/// \param height rows that it must have
/// \throws IoError
[[nodiscard]] FloatImage read_exr(const FileBytes& file, std::size_t width, std::size_t height);

}  // namespace lobe
