#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

// Behind the last byte of HDF5, where it looks no more, files of lobe have a checksum (CRC-32) of what is before it, so
// that changed bytes are found before HDF5, which trusts what it reads, sees them. Chunks of numbers have checksums of
// their own and are left out, so that large files need not be read twice. Files of other programs, and files that these
// have changed, have none.

/// Bytes of a file.
struct ByteRange {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

/// Digest that follows the bytes of a file.
/// \param read gives `count` bytes from `offset` on
/// \param left_out ranges in any order, which may touch
[[nodiscard]] std::string digest_of(
    std::uint64_t size, std::vector<ByteRange> left_out,
    const std::function<void(std::uint64_t offset, char* bytes, std::size_t count)>& read);
/// Digest of a whole text.
[[nodiscard]] std::string digest_of(std::string_view bytes);

enum class DigestState { none, sound, damaged };

/// State of a file by its checksum; none if the file cannot be read.
[[nodiscard]] DigestState check_digest(const std::filesystem::path& path);

/// \throws IoError for a file whose bytes have changed.
void require_sound(const std::filesystem::path& path);

}  // namespace lobe
