#pragma once

#include <zlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace lobe::test {

/// A picture as a PNG file holds it: eight bits, red, green and blue, no interlacing.
/// \throws std::runtime_error.
struct Png {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t channels = 0;
  std::vector<std::uint8_t> bytes;  ///< row by row

  [[nodiscard]] std::array<int, 3> at(std::size_t x, std::size_t y) const {
    const std::uint8_t* const pixel = bytes.data() + (y * width + x) * channels;
    return {pixel[0], pixel[1], pixel[2]};
  }
};

inline Png read_png(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::vector<std::uint8_t> file((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const auto number = [&](std::size_t at) {
    return std::size_t{file.at(at)} << 24 | std::size_t{file.at(at + 1)} << 16 | std::size_t{file.at(at + 2)} << 8 |
           file.at(at + 3);
  };
  Png png;
  std::vector<std::uint8_t> packed;
  for (std::size_t at = 8; at + 12 <= file.size(); at += number(at) + 12) {
    const std::string kind(file.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                           file.begin() + static_cast<std::ptrdiff_t>(at) + 8);
    const auto begin = file.begin() + static_cast<std::ptrdiff_t>(at) + 8;
    if (kind == "IHDR") {
      png.width = number(at + 8);
      png.height = number(at + 12);
      const int colour = file.at(at + 17);
      if (file.at(at + 16) != 8 || (colour != 2 && colour != 6) || file.at(at + 20) != 0) {
        throw std::runtime_error("a kind of PNG that this reader does not know");
      }
      png.channels = colour == 2 ? 3 : 4;
    }
    if (kind == "IDAT") packed.insert(packed.end(), begin, begin + static_cast<std::ptrdiff_t>(number(at)));
  }
  const std::size_t stride = png.width * png.channels;
  std::vector<std::uint8_t> rows(png.height * (stride + 1));
  uLongf length = rows.size();
  if (uncompress(rows.data(), &length, packed.data(), packed.size()) != Z_OK || length != rows.size()) {
    throw std::runtime_error(path.string() + " is no whole PNG");
  }
  png.bytes.resize(png.height * stride);
  for (std::size_t y = 0; y < png.height; ++y) {
    const int filter = rows[y * (stride + 1)];
    for (std::size_t i = 0; i < stride; ++i) {
      const int left = i < png.channels ? 0 : png.bytes[y * stride + i - png.channels];
      const int above = y == 0 ? 0 : png.bytes[(y - 1) * stride + i];
      const int corner = y == 0 || i < png.channels ? 0 : png.bytes[(y - 1) * stride + i - png.channels];
      const int p = left + above - corner;
      const int nearest = std::abs(p - left) <= std::abs(p - above) && std::abs(p - left) <= std::abs(p - corner) ? left
                          : std::abs(p - above) <= std::abs(p - corner) ? above
                                                                        : corner;
      const std::array<int, 5> predicted{0, left, above, (left + above) / 2, nearest};
      const int value = rows[y * (stride + 1) + 1 + i] + predicted.at(static_cast<std::size_t>(filter));
      png.bytes[y * stride + i] = static_cast<std::uint8_t>(value & 0xff);
    }
  }
  return png;
}

}  // namespace lobe::test
