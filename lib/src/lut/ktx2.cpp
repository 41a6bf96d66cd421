#include "lut/ktx2.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string_view>

#include "lut/exr.hpp"

namespace lobe {
namespace {

constexpr std::string_view kIdentifier("\xABKTX 20\xBB\r\n\x1A\n", 12);
constexpr std::size_t kHead = 80;   // identifier, header and index
constexpr std::size_t kLevel = 24;  // entry of a level in its index

/// Formats of Vulkan, 1 to 4 channels each.
struct TexelFormat {
  int bits;
  bool is_float;
  std::array<std::uint32_t, 4> numbers;
};
constexpr std::array kTexelFormats{TexelFormat{8, false, {9, 16, 23, 37}}, TexelFormat{16, false, {70, 77, 84, 91}},
                                   TexelFormat{16, true, {76, 83, 90, 97}},
                                   TexelFormat{32, true, {100, 103, 106, 109}}};

const TexelFormat& texel_format(int bits, bool is_float) {
  return *std::ranges::find_if(kTexelFormats,
                               [&](const TexelFormat& one) { return one.bits == bits && one.is_float == is_float; });
}

void append(std::string& bytes, std::uint64_t number, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFFU);
}

void pad(std::string& bytes, std::size_t alignment) {
  while (bytes.size() % alignment != 0) bytes += '\0';
}

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t number = 0;
  for (std::size_t i = count; i-- > 0;) number = number << 8U | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

std::uint64_t texel_bits(double value, const Texture& texture) {
  if (!texture.is_float) return static_cast<std::uint64_t>(std::llround(value * (std::exp2(texture.bits) - 1)));
  if (texture.bits == 16) return half_bits(value);
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

double texel_number(std::uint64_t bits, const Texture& texture) {
  if (!texture.is_float) return static_cast<double>(bits) / (std::exp2(texture.bits) - 1);
  if (texture.bits == 16) return half_of_bits(static_cast<unsigned>(bits));
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
}

/// Data format descriptor with one basic block: linear numbers of no colour space, one sample for each channel.
std::string descriptor(const Texture& texture, std::size_t channels) {
  constexpr std::uint32_t kRgbsda = 1;  // colour model; primaries: 0, unspecified
  constexpr std::uint32_t kLinear = 1;  // transfer function
  constexpr std::array<std::uint32_t, 4> kChannels{0, 1, 2, 15};
  constexpr std::uint32_t kFloat = 0x80;
  constexpr std::uint32_t kSigned = 0x40;
  const auto bits = static_cast<std::uint32_t>(texture.bits);
  const std::size_t size = 24 + 16 * channels;
  std::string block;
  append(block, 4 + size, 4);
  append(block, 0, 4);  // vendor, type
  append(block, 2, 2);  // version 1.3
  append(block, size, 2);
  append(block, kRgbsda | kLinear << 16U, 4);
  append(block, 0, 4);                                              // blocks of one texel
  append(block, channels * static_cast<std::size_t>(bits) / 8, 8);  // bytes of the only plane
  for (std::size_t c = 0; c < channels; ++c) {
    const std::uint32_t kind = kChannels[c] | (texture.is_float ? kFloat | kSigned : 0U);
    append(block, c * bits | (bits - 1) << 16U | kind << 24U, 4);
    append(block, 0, 4);  // position
    append(block, texture.is_float ? std::bit_cast<std::uint32_t>(-1.0F) : 0U, 4);
    append(block, texture.is_float ? std::bit_cast<std::uint32_t>(1.0F) : (1U << bits) - 1, 4);
  }
  return block;
}

std::string key_value_data(std::vector<std::pair<std::string, std::string>> texts) {
  std::ranges::sort(texts);
  std::string data;
  for (const auto& [key, value] : texts) {
    append(data, key.size() + value.size() + 2, 4);
    data.append(key).push_back('\0');
    data.append(value).push_back('\0');
    pad(data, 4);
  }
  return data;
}

}  // namespace

std::string ktx2_content(const Texture& texture, std::vector<std::pair<std::string, std::string>> texts) {
  const std::size_t channels = texture.channels == 3 ? 4 : texture.channels;
  const std::size_t bytes = static_cast<std::size_t>(texture.bits) / 8;
  const std::string description = descriptor(texture, channels);
  texts.emplace_back("KTXorientation", texture.depth > 0 ? "rdi" : texture.height > 0 ? "rd" : "r");
  const std::string data = key_value_data(std::move(texts));
  const std::size_t texels = texture.values.size() / texture.channels;
  const std::size_t described = kHead + kLevel;
  const std::size_t keyed = described + description.size();
  const std::size_t alignment = std::lcm(channels * bytes, std::size_t{4});
  const std::size_t begin = (keyed + data.size() + alignment - 1) / alignment * alignment;
  const std::size_t size = texels * channels * bytes;

  std::string file(kIdentifier);
  for (const std::size_t word :
       {std::size_t{texel_format(texture.bits, texture.is_float).numbers[channels - 1]}, bytes, texture.width,
        texture.height, texture.depth, std::size_t{0} /* layers */, std::size_t{1} /* faces */,
        std::size_t{1} /* levels */, std::size_t{0} /* supercompression */, described, description.size(), keyed,
        data.size()}) {
    append(file, word, 4);
  }
  for (const std::size_t word : {std::size_t{0}, std::size_t{0} /* data of supercompression */, begin, size, size}) {
    append(file, word, 8);
  }
  file += description;
  file += data;
  pad(file, alignment);
  for (std::size_t t = 0; t < texels; ++t) {
    for (std::size_t c = 0; c < channels; ++c) {
      append(file, texel_bits(c < texture.channels ? texture.values[t * texture.channels + c] : 1, texture), bytes);
    }
  }
  return file;
}

Texture read_ktx2(const FileBytes& file) {
  const std::string_view content = file.content();
  if (!content.starts_with(kIdentifier)) file.refuse("is no KTX file of version 2");
  if (content.size() < kHead + kLevel) file.refuse("ends within its header");
  const auto word = [&](std::size_t at) { return static_cast<std::size_t>(number_at(content, at, 4)); };
  const std::size_t format = word(12);
  Texture texture;
  texture.channels = 0;
  for (const TexelFormat& one : kTexelFormats) {
    const auto found = std::ranges::find(one.numbers, format);
    if (found == one.numbers.end()) continue;
    texture.channels = static_cast<std::size_t>(found - one.numbers.begin()) + 1;
    texture.bits = one.bits;
    texture.is_float = one.is_float;
  }
  if (texture.channels == 0) {
    file.refuse(
        fmt::format("has texels of format {} of Vulkan; expected 1 to 4 numbers of 8 or 16 bits from 0 to 1, or "
                    "of floating point with 16 or 32",
                    format));
  }
  texture.width = word(20);
  texture.height = word(24);
  texture.depth = word(28);
  if (word(32) > 1 || word(36) != 1) file.refuse("is an array or a cube; expected a single texture");
  if (word(44) != 0) file.refuse("is supercompressed; expected plain numbers");
  constexpr std::size_t kLongestSide = std::size_t{1} << 16;
  if (texture.width == 0 || std::max({texture.width, texture.height, texture.depth}) > kLongestSide) {
    file.refuse(fmt::format("has {} x {} x {} texels; expected at most {} along each side", texture.width,
                            texture.height, texture.depth, kLongestSide));
  }
  const std::size_t bytes = static_cast<std::size_t>(texture.bits) / 8;
  const std::size_t count = texture.width * std::max<std::size_t>(texture.height, 1) *
                            std::max<std::size_t>(texture.depth, 1) * texture.channels;
  const std::uint64_t begin = number_at(content, kHead, 8);
  if (number_at(content, kHead + 8, 8) != count * bytes || begin > content.size() ||
      count * bytes > content.size() - begin) {
    file.refuse("does not hold the texels that its size asks for");
  }
  texture.values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    texture.values.push_back(
        texel_number(number_at(content, static_cast<std::size_t>(begin) + i * bytes, bytes), texture));
  }
  return texture;
}

}  // namespace lobe
