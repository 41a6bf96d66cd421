// Our own reader: OpenEXR 3.1 crashes on damaged files.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string_view>

#include "core/text.hpp"
#include "lut/exr.hpp"

namespace lobe {
namespace {

enum class PixelType : std::uint32_t { whole, half, single };

struct ImageChannel {
  std::string name;
  PixelType type;

  [[nodiscard]] std::size_t bytes() const { return type == PixelType::half ? 2 : 4; }
};

/// What the attributes say.
struct ExrHeader {
  std::vector<ImageChannel> channels;  ///< in the order of the file
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::int32_t first_line = 0;
  std::uint32_t compression = 0;
  std::size_t end = 0;  ///< offset of what follows
};

/// Source: OpenEXR File Layout, "File format".
class ExrReader {
 public:
  explicit ExrReader(const FileBytes& file) : file_(file), content_(file.content()) {}

  [[nodiscard]] FloatImage read(std::size_t width, std::size_t height) {
    const ExrHeader header = read_header();
    if (header.width != static_cast<std::int64_t>(width) || header.height != static_cast<std::int64_t>(height)) {
      file_.refuse(fmt::format("is an image of {} x {} pixels; the axes ask for {} x {}", header.width, header.height,
                               width, height));
    }
    const std::size_t lines = lines_of_block(header.compression);
    std::size_t bytes_of_pixel = 0;
    for (const ImageChannel& channel : header.channels) bytes_of_pixel += channel.bytes();
    const std::size_t bytes_of_line = bytes_of_pixel * width;
    // No compression makes a thousandth of it.
    if (bytes_of_line * height > 1100 * content_.size()) file_.refuse("is too small for its image");

    const std::vector<std::size_t> order = order_of(header.channels);
    FloatImage image{.width = width, .height = height, .channels = {}, .values = {}};
    image.values.resize(width * height * order.size());
    for (const std::size_t c : order) image.channels.push_back(header.channels[c].name);
    const std::size_t blocks = (height + lines - 1) / lines;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint64_t at = number(header.end + 8 * b, 8);
      const std::int64_t line = std::int64_t{static_cast<std::int32_t>(number(at, 4))} - header.first_line;
      if (line != static_cast<std::int64_t>(b * lines)) file_.refuse("has its lines in another order than it says");
      const std::size_t count = std::min(lines, height - b * lines);
      const std::string block = unpacked(bytes(at + 8, number(at + 4, 4)), count * bytes_of_line, header.compression);
      std::size_t from = 0;
      for (std::size_t y = b * lines; y < b * lines + count; ++y) {
        for (std::size_t c = 0; c < header.channels.size(); ++c) {
          const ImageChannel& channel = header.channels[c];
          const auto place = static_cast<std::size_t>(std::ranges::find(order, c) - order.begin());
          for (std::size_t x = 0; x < width; ++x, from += channel.bytes()) {
            image.values[(y * width + x) * order.size() + place] = value(block, from, channel.type);
          }
        }
      }
    }
    return image;
  }

 private:
  static std::uint64_t little_endian(std::string_view bytes) {
    std::uint64_t number = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) number = number << 8U | static_cast<unsigned char>(bytes[i]);
    return number;
  }

  [[nodiscard]] std::string_view bytes(std::uint64_t at, std::uint64_t count) const {
    if (at > content_.size() || count > content_.size() - at) file_.refuse("ends within its header or its image");
    return content_.substr(static_cast<std::size_t>(at), static_cast<std::size_t>(count));
  }
  [[nodiscard]] std::uint64_t number(std::uint64_t at, std::size_t count) const {
    return little_endian(bytes(at, count));
  }

  /// A text up to its zero, from an offset that is moved behind it.
  [[nodiscard]] std::string_view text(std::size_t& at, std::size_t end) const {
    const std::size_t zero = content_.find('\0', at);
    if (zero >= end) file_.refuse("has a name without an end");
    const std::string_view found = content_.substr(at, zero - at);
    at = zero + 1;
    return found;
  }

  [[nodiscard]] ExrHeader read_header() const {
    constexpr std::string_view kMagic("\x76\x2f\x31\x01", 4);
    constexpr std::uint64_t kPlain = 0x4FF;  // version and, of the flags, that for long names
    if (!content_.starts_with(kMagic)) file_.refuse("is no OpenEXR file");
    if ((number(4, 4) & ~kPlain) != 0) {
      file_.refuse("has tiles, several parts or depths; expected one image of scan lines");
    }
    ExrHeader header;
    header.end = 8;
    for (;;) {
      const std::string_view name = text(header.end, content_.size());
      if (name.empty()) break;
      (void)text(header.end, content_.size());  // its type
      const std::uint64_t size = number(header.end, 4);
      const std::size_t at = header.end + 4;
      (void)bytes(at, size);
      header.end = at + static_cast<std::size_t>(size);
      if (name == "channels") header.channels = read_channels(at, header.end);
      if (name == "compression") header.compression = static_cast<std::uint32_t>(number(at, 1));
      if (name == "dataWindow") {
        const auto end = [&](std::size_t k) { return static_cast<std::int32_t>(number(at + 4 * k, 4)); };
        header.width = std::int64_t{end(2)} - end(0) + 1;
        header.height = std::int64_t{end(3)} - end(1) + 1;
        header.first_line = end(1);
      }
    }
    if (header.channels.empty()) file_.refuse("has no channels");
    return header;
  }

  [[nodiscard]] std::vector<ImageChannel> read_channels(std::size_t at, std::size_t end) const {
    constexpr std::size_t kMostChannels = 1024;
    std::vector<ImageChannel> channels;
    while (at < end) {
      const std::string_view name = text(at, end);
      if (name.empty()) break;
      const std::uint64_t type = number(at, 4);
      if (type > 2) file_.refuse(fmt::format("has channel '{}' of an unknown type", excerpt(name)));
      if (number(at + 8, 4) != 1 || number(at + 12, 4) != 1) {
        file_.refuse(fmt::format("has channel '{}' without a value for every pixel", excerpt(name)));
      }
      channels.push_back({std::string(name), static_cast<PixelType>(type)});
      if (channels.size() > kMostChannels) file_.refuse(fmt::format("has more than {} channels", kMostChannels));
      at += 16;
    }
    return channels;
  }

  [[nodiscard]] std::size_t lines_of_block(std::uint32_t compression) const {
    constexpr std::uint32_t kZips = 2;
    constexpr std::uint32_t kZip = 3;
    if (compression == 0 || compression == kZips) return 1;
    if (compression == kZip) return 16;
    file_.refuse("is compressed by another method than zip; expected none, ZIPS or ZIP");
  }

  /// Indices of the channels: R, G, B and A, then others as they are.
  static std::vector<std::size_t> order_of(const std::vector<ImageChannel>& channels) {
    constexpr std::string_view kColors = "RGBA";
    std::vector<std::size_t> order;
    for (std::size_t c = 0; c < channels.size(); ++c) order.push_back(c);
    std::ranges::stable_sort(order, {}, [&](std::size_t c) {
      return channels[c].name.size() == 1 ? kColors.find(channels[c].name) : std::string_view::npos;
    });
    return order;
  }

  [[nodiscard]] std::string unpacked(std::string_view packed, std::size_t size, std::uint32_t compression) const {
    if (packed.size() == size) return std::string(packed);
    uLongf found = size;
    std::string mixed(size, '\0');
    if (compression == 0 ||
        uncompress(reinterpret_cast<Bytef*>(mixed.data()), &found, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK ||
        found != size) {
      file_.refuse("has lines that are damaged");
    }
    // Differences from the byte before, less 128; first the even bytes, then the odd ones, as many.
    for (std::size_t i = 1; i < size; ++i) {
      const unsigned sum = static_cast<unsigned char>(mixed[i - 1]) + static_cast<unsigned char>(mixed[i]) + 128U;
      mixed[i] = static_cast<char>(sum & 0xFFU);
    }
    std::string block(size, '\0');
    for (std::size_t i = 0; i < size; ++i) block[i] = mixed[i % 2 == 0 ? i / 2 : size / 2 + i / 2];
    return block;
  }

  static float value(std::string_view block, std::size_t at, PixelType type) {
    const auto bits = static_cast<std::uint32_t>(little_endian(block.substr(at, type == PixelType::half ? 2 : 4)));
    if (type == PixelType::whole) return static_cast<float>(bits);
    return type == PixelType::half ? static_cast<float>(half_of_bits(bits)) : std::bit_cast<float>(bits);
  }

  const FileBytes& file_;
  std::string_view content_;
};

}  // namespace

FloatImage read_exr(const FileBytes& file, std::size_t width, std::size_t height) {
  return ExrReader(file).read(width, height);
}

}  // namespace lobe
