#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lobe::test {

/// A zip archive by the layout of PKWARE's APPNOTE, as numpy.savez writes it.
/// \param members names and contents.
/// \param is_packed by deflate, as numpy.savez_compressed does
inline std::string zipped(const std::vector<std::pair<std::string, std::string>>& members, bool is_packed = false) {
  const auto put = [](std::string& text, std::uint64_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> 8 * i & 0xff);
  };
  const auto deflated = [](const std::string& content) {
    z_stream stream{};
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::runtime_error("deflateInit2 fails");
    }
    std::string packed(deflateBound(&stream, content.size()) + 32, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
    stream.avail_in = static_cast<uInt>(content.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const int status = deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    (void)deflateEnd(&stream);
    if (status != Z_STREAM_END) throw std::runtime_error("deflate fails");
    return packed;
  };
  std::string archive;
  std::string directory;
  for (const auto& [name, content] : members) {
    const std::string stored = is_packed ? deflated(content) : content;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
    std::string common;
    put(common, 20, 2);                 // version needed
    put(common, 0, 2);                  // flags
    put(common, is_packed ? 8 : 0, 2);  // method
    put(common, 0x00210000, 4);         // 1980-01-01
    put(common, sum, 4);
    put(common, stored.size(), 4);
    put(common, content.size(), 4);
    put(common, name.size(), 2);
    put(common, 0, 2);  // extra field
    put(directory, 0x02014b50, 4);
    put(directory, 20, 2);
    directory += common;
    put(directory, 0, 2);  // comment
    put(directory, 0, 2);  // disk
    put(directory, 0, 2);
    put(directory, 0, 4);
    put(directory, archive.size(), 4);
    directory += name;
    put(archive, 0x04034b50, 4);
    archive += common + name + stored;
  }
  const std::size_t offset = archive.size();
  archive += directory;
  put(archive, 0x06054b50, 4);
  put(archive, 0, 4);
  put(archive, members.size(), 2);
  put(archive, members.size(), 2);
  put(archive, directory.size(), 4);
  put(archive, offset, 4);
  put(archive, 0, 2);
  return archive;
}

}  // namespace lobe::test
