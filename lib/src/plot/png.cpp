// Small pictures inside pages, which gnuplot draws into files only. PNG 1.2, sections 3 to 5.
#include "plot/png.hpp"

#include <zlib.h>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::size_t kBytesPerPixel = 3;
constexpr char kDifferenceFromLeft = 1;  // the filter of all rows

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(number >> shift & 0xffU);
  return bytes;
}

const Bytef* bytes_of(const std::string& text) {
  return reinterpret_cast<const Bytef*>(text.data());  // NOLINT(cppcoreguidelines-pro-type-reinterpret-cast): zlib's
}

std::string chunk(const std::string& type, const std::string& content) {
  const std::string checked = type + content;
  const auto checksum = static_cast<std::uint32_t>(crc32(0, bytes_of(checked), static_cast<uInt>(checked.size())));
  return big_endian(static_cast<std::uint32_t>(content.size())) + checked + big_endian(checksum);
}

std::string deflated_rows(std::size_t columns, std::size_t height, std::span<const std::uint8_t> rgb) {
  const std::size_t width = kBytesPerPixel * columns;
  std::string rows;
  for (std::size_t row = 0; row < height; ++row) {
    rows += kDifferenceFromLeft;
    for (std::size_t k = 0; k < width; ++k) {
      const int left = k < kBytesPerPixel ? 0 : rgb[row * width + k - kBytesPerPixel];
      rows += static_cast<char>(static_cast<std::uint8_t>(rgb[row * width + k] - left));
    }
  }
  uLongf length = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(length, '\0');
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): zlib's
  auto* const target = reinterpret_cast<Bytef*>(packed.data());
  if (compress2(target, &length, bytes_of(rows), static_cast<uLong>(rows.size()), Z_BEST_COMPRESSION) != Z_OK) {
    throw Error("cannot compress a picture");
  }
  packed.resize(length);
  return packed;
}

}  // namespace

std::string png_file(std::size_t width, std::size_t height, std::span<const std::uint8_t> rgb) {
  const std::string size =
      big_endian(static_cast<std::uint32_t>(width)) + big_endian(static_cast<std::uint32_t>(height));
  const std::string eight_bits_of_rgb{8, 2, 0, 0, 0};  // also: deflate, rows with filters, no interlacing
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", size + eight_bits_of_rgb) +
         chunk("IDAT", deflated_rows(width, height, rgb)) + chunk("IEND", "");
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::string_view part = bytes.substr(at, 3);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8U | (k < part.size() ? static_cast<unsigned char>(part[k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) text += k > part.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63U];
  }
  return text;
}

}  // namespace lobe
