#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lobe {

/// A PNG file of a picture.
/// \param rgb three bytes per pixel, in rows from the upper left
[[nodiscard]] std::string png_file(std::size_t width, std::size_t height, std::span<const std::uint8_t> rgb);

/// Bytes as text (RFC 4648, section 4).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace lobe
