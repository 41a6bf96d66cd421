#include "lut/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace lobe {
namespace {

/// A file in memory that grows as it is written.
class Written : public Imf::OStream {
 public:
  Written() : OStream("memory") {}

  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (at_ + size > content_.size()) content_.resize(at_ + size);
    std::memcpy(content_.data() + at_, bytes, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  [[nodiscard]] const std::string& content() const { return content_; }

 private:
  std::string content_;
  std::size_t at_ = 0;
};

/// A slice of a frame buffer of pixels, whose channels lie beside each other.
template <typename Number>
Imf::Slice slice_of(Number* numbers, std::size_t channel, std::size_t channels, std::size_t width) {
  const auto type = sizeof(Number) == 2 ? Imf::HALF : Imf::FLOAT;
  return {type, reinterpret_cast<char*>(numbers + channel), sizeof(Number) * channels,
          sizeof(Number) * channels * width};
}

template <typename Number>
std::string written(const FloatImage& image, const Imf::Header& header, std::vector<Number> numbers) {
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    buffer.insert(image.channels[c], slice_of(numbers.data(), c, image.channels.size(), image.width));
  }
  Written stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(image.height));
  }
  return stream.content();
}

}  // namespace

double rounded_to_half(double value) {
  return half_of_bits(half_bits(value));
}

unsigned half_bits(double value) {
  // By way of a float, nearly: where that falls on the middle of two halves, the double decides.
  const auto single = static_cast<float>(value);
  Imath::half nearest(single);
  const double off = value - static_cast<double>(single);
  if (off != 0) {
    const Imath::half beside(std::nextafter(
        single, off > 0 ? std::numeric_limits<float>::infinity() : -std::numeric_limits<float>::infinity()));
    const auto distance = [&](Imath::half half) {
      return std::abs(static_cast<double>(static_cast<float>(half)) - value);
    };
    if (distance(beside) < distance(nearest)) nearest = beside;
  }
  return nearest.bits();
}

double half_of_bits(unsigned bits) {
  Imath::half number(0.0F);
  number.setBits(static_cast<std::uint16_t>(bits));
  return static_cast<double>(static_cast<float>(number));
}

std::string exr_content(const FloatImage& image, int bits,
                        const std::vector<std::pair<std::string, std::string>>& texts) {
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, text] : texts) header.insert(name, Imf::StringAttribute(text));
  for (const auto& name : image.channels) {
    header.channels().insert(name, Imf::Channel(bits == 16 ? Imf::HALF : Imf::FLOAT));
  }
  if (bits == 32) return written(image, header, image.values);
  std::vector<Imath::half> halves(image.values.begin(), image.values.end());
  return written(image, header, std::move(halves));
}

}  // namespace lobe
