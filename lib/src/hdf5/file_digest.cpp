#include "hdf5/file_digest.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

// Ranges that are left out (offset, size), how many, the checksum of the bytes and of these, and the mark.
constexpr std::string_view kMark = "lobe-crc";
constexpr std::size_t kNumber = sizeof(std::uint64_t);
constexpr std::size_t kEnd = 2 * kNumber + kMark.size();

void append(std::string& text, std::uint64_t number) {
  for (std::size_t byte = 0; byte < kNumber; ++byte) text += static_cast<char>(number >> (8 * byte) & 0xFFU);
}

std::uint64_t number_at(std::string_view text, std::size_t at) {
  std::uint64_t number = 0;
  for (std::size_t byte = kNumber; byte-- > 0;) number = number << 8U | static_cast<unsigned char>(text[at + byte]);
  return number;
}

using Read = std::function<void(std::uint64_t offset, char* bytes, std::size_t count)>;

/// Checksum of all bytes except those in the ranges, which rise, and of a text.
std::uint64_t checksum(std::uint64_t size, std::span<const ByteRange> left_out, std::string_view text,
                       const Read& read) {
  uLong sum = crc32_z(0, nullptr, 0);
  std::array<char, 1 << 16> part{};
  const auto add = [&](const char* bytes, std::size_t count) {
    sum = crc32_z(sum, reinterpret_cast<const Bytef*>(bytes), count);
  };
  std::uint64_t at = 0;
  const auto take_until = [&](std::uint64_t end) {
    while (at < end) {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(part.size(), end - at));
      read(at, part.data(), count);
      add(part.data(), count);
      at += count;
    }
  };
  for (const ByteRange& range : left_out) {
    take_until(range.offset);
    at = range.offset + range.size;
  }
  take_until(size);
  add(text.data(), text.size());
  return sum;
}

/// One after the other, those that touch as one.
std::vector<ByteRange> joined(std::vector<ByteRange> ranges) {
  std::ranges::sort(ranges, {}, &ByteRange::offset);
  std::vector<ByteRange> all;
  for (const ByteRange& range : ranges) {
    if (!all.empty() && range.offset <= all.back().offset + all.back().size) {
      all.back().size = std::max(all.back().offset + all.back().size, range.offset + range.size) - all.back().offset;
    } else {
      all.push_back(range);
    }
  }
  return all;
}

/// An open regular file. Pipes are left alone: opening one would wake its writer, and closing it end that.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return;
    number_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Bytes of the file, if it could be opened.
  [[nodiscard]] std::optional<std::uint64_t> size() const {
    struct stat status {};
    if (number_ < 0 || ::fstat(number_, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return static_cast<std::uint64_t>(status.st_size);
  }
  /// Bytes that cannot be read are 0.
  void read(std::uint64_t offset, char* bytes, std::size_t count) const {
    while (count > 0) {
      const ssize_t got = ::pread(number_, bytes, count, static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      bytes += got;
      offset += static_cast<std::uint64_t>(got);
      count -= static_cast<std::size_t>(got);
    }
    std::memset(bytes, 0, count);
  }

 private:
  int number_ = -1;
};

}  // namespace

std::string digest_of(std::uint64_t size, std::vector<ByteRange> left_out, const Read& read) {
  left_out = joined(std::move(left_out));
  std::string text;
  for (const ByteRange& range : left_out) {
    append(text, range.offset);
    append(text, range.size);
  }
  append(text, left_out.size());
  append(text, checksum(size, left_out, text, read));
  return text.append(kMark);
}

std::string digest_of(std::string_view bytes) {
  return digest_of(bytes.size(), {}, [&](std::uint64_t offset, char* target, std::size_t count) {
    std::memcpy(target, bytes.data() + offset, count);
  });
}

DigestState check_digest(const std::filesystem::path& path) {
  const Descriptor file(path);
  const auto all = file.size();
  if (!all || *all < kEnd) return DigestState::none;
  std::string end(kEnd, '\0');
  file.read(*all - kEnd, end.data(), end.size());
  if (!end.ends_with(kMark)) return DigestState::none;
  const std::uint64_t count = number_at(end, 0);
  if (count > (*all - kEnd) / (2 * kNumber)) return DigestState::damaged;
  const std::uint64_t size = *all - kEnd - count * 2 * kNumber;
  std::string text(static_cast<std::size_t>(count) * 2 * kNumber, '\0');
  file.read(size, text.data(), text.size());
  std::vector<ByteRange> left_out;
  std::uint64_t at = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const ByteRange range{number_at(text, 2 * k * kNumber), number_at(text, (2 * k + 1) * kNumber)};
    if (range.offset < at || range.offset > size || range.size > size - range.offset) return DigestState::damaged;
    at = range.offset + range.size;
    left_out.push_back(range);
  }
  append(text, count);
  const auto read = [&](std::uint64_t offset, char* bytes, std::size_t length) { file.read(offset, bytes, length); };
  return checksum(size, left_out, text, read) == number_at(end, kNumber) ? DigestState::sound : DigestState::damaged;
}

void require_sound(const std::filesystem::path& path) {
  if (check_digest(path) != DigestState::damaged) return;
  throw IoError("cannot read " + path.string() +
                ": bytes of it have changed since it was written; take another copy, or make it again");
}

}  // namespace lobe
