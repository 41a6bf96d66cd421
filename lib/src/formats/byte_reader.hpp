#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "formats/file_bytes.hpp"

namespace lobe {

/// Little-endian numbers, one after the other, also several as a struct without gaps; never past the end.
class ByteReader {
 public:
  explicit ByteReader(const FileBytes& file, std::size_t offset = 0) : file_(file), offset_(offset) {}

  [[nodiscard]] std::size_t offset() const { return offset_; }
  [[nodiscard]] std::size_t remaining() const { return file_.size() - offset_; }

  /// \param what named in the complaint.
  /// \throws IoError where the file ends before it
  template <typename Number>
  [[nodiscard]] Number read(std::string_view what) {
    static_assert(std::is_trivially_copyable_v<Number> && std::endian::native == std::endian::little);
    Number number{};
    std::memcpy(&number, bytes(sizeof(Number), what).data(), sizeof(Number));
    return number;
  }

  [[nodiscard]] std::string_view bytes(std::size_t count, std::string_view what) {
    if (count > remaining()) {
      file_.refuse_at(offset_,
                      fmt::format("the file ends within {}; expected {} more bytes", what, count - remaining()));
    }
    const std::string_view found = file_.content().substr(offset_, count);
    offset_ += count;
    return found;
  }

 private:
  const FileBytes& file_;
  std::size_t offset_;
};

/// A number at any place, aligned or not.
/// \param bytes at least sizeof(Number) of them from `offset` on
template <typename Number>
[[nodiscard]] Number number_at(std::string_view bytes, std::size_t offset) {
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof(Number));
  return number;
}

}  // namespace lobe
