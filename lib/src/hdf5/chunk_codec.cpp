#include "hdf5/chunk_codec.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "lobe/core/error.hpp"

namespace lobe::hdf5 {
namespace {

static_assert(std::endian::native == std::endian::little, "files hold little-endian numbers");

using Bytes = std::vector<unsigned char>;

Bytes plain(std::span<const double> values) {
  Bytes bytes(values.size_bytes());
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// All first bytes, then all second ones, and so on: signs and exponents of neighbours are alike.
Bytes shuffled(std::span<const double> values) {
  const Bytes bytes = plain(values);
  Bytes result(bytes.size());
  auto* target = result.data();
  for (std::size_t byte = 0; byte < sizeof(double); ++byte) {
    for (std::size_t at = byte; at < bytes.size(); at += sizeof(double)) *target++ = bytes[at];
  }
  return result;
}

Bytes deflated(Bytes bytes) {
  constexpr int kLevel = 4;
  constexpr int kLargestWindow = 15;
  constexpr int kLargestMemory = 9;
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, kLargestWindow, kLargestMemory, Z_RLE) != Z_OK) {
    throw IoError("cannot compress a table: zlib does not start");
  }
  Bytes result(deflateBound(&stream, bytes.size()));
  stream.next_in = bytes.data();
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = result.data();
  stream.avail_out = static_cast<uInt>(result.size());
  const int code = deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw IoError("cannot compress a table: zlib error " + std::to_string(code));
  return result;
}

/// Fletcher's checksum as HDF5 computes it: over big-endian words of 16 bits, the last one padded by 0.
std::uint32_t fletcher32(const Bytes& bytes) {
  constexpr std::size_t kWordsWithoutOverflow = 360;
  std::uint32_t sum = 0;
  std::uint32_t sum_of_sums = 0;
  const auto fold = [](std::uint32_t value) { return (value & 0xffffU) + (value >> 16U); };
  const std::size_t whole = bytes.size() / 2 * 2;
  for (std::size_t begin = 0; begin < whole; begin += 2 * kWordsWithoutOverflow) {
    const std::size_t end = std::min(begin + 2 * kWordsWithoutOverflow, whole);
    for (std::size_t at = begin; at < end; at += 2) {
      sum += static_cast<std::uint32_t>(bytes[at] << 8U) | bytes[at + 1];
      sum_of_sums += sum;
    }
    sum = fold(sum);
    sum_of_sums = fold(sum_of_sums);
  }
  if (whole < bytes.size()) {
    sum += static_cast<std::uint32_t>(bytes[whole] << 8U);
    sum_of_sums += sum;
    sum = fold(sum);
    sum_of_sums = fold(sum_of_sums);
  }
  return fold(sum_of_sums) << 16U | fold(sum);
}

}  // namespace

std::vector<unsigned char> encode_chunk(std::span<const double> values, bool compress) {
  Bytes bytes = compress ? deflated(shuffled(values)) : plain(values);
  const std::uint32_t checksum = fletcher32(bytes);
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<unsigned char>(checksum >> shift));
  return bytes;
}

}  // namespace lobe::hdf5
