// The only file that includes libzip.
#include "formats/zip_archive.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <span>
#include <string_view>

#include "formats/byte_reader.hpp"

namespace lobe {
namespace {

constexpr std::size_t kPart = std::size_t{1} << 16;
constexpr std::size_t kQuoted = 80;  // characters of a name that complaints show

std::string shown(std::string_view name) {
  return std::string(name.substr(0, kQuoted));
}

/// libzip takes memory for as many members as the end of the archive announces, whatever there is.
void check_count(const FileBytes& file) {
  constexpr std::string_view kEnd = "PK\5\6";
  constexpr std::string_view kLocator = "PK\6\7";  // of the end of large archives, right before the other one
  constexpr std::size_t kEndSize = 22;
  constexpr std::size_t kLocatorSize = 20;
  constexpr std::size_t kLargeEndSize = 56;
  constexpr std::size_t kEntrySize = 46;  // of a member in the directory, at least
  constexpr std::size_t kLongestComment = 65535;
  const std::string_view content = file.content();
  const auto require = [&](std::uint64_t count) {
    if (count > content.size() / kEntrySize) {
      file.refuse_at(0, fmt::format("it announces {} members, more than it can hold", count));
    }
  };
  const std::size_t tail = content.size() - std::min(content.size(), kLongestComment + kEndSize);
  for (std::size_t at = content.find(kEnd, tail); at != content.npos; at = content.find(kEnd, at + 1)) {
    if (content.size() - at < kEndSize) return;
    const auto count = number_at<std::uint16_t>(content, at + 10);
    const bool is_large = at >= kLocatorSize && content.substr(at - kLocatorSize).starts_with(kLocator);
    if (!is_large || count != std::numeric_limits<std::uint16_t>::max()) require(count);
    if (!is_large) continue;
    const auto large = number_at<std::uint64_t>(content, at - kLocatorSize + 8);
    if (large > content.size() || content.size() - large < kLargeEndSize) continue;
    require(number_at<std::uint64_t>(content, large + 24));
    require(number_at<std::uint64_t>(content, large + 32));
  }
}

/// A member that is open.
class Member {
 public:
  Member(zip* archive, std::size_t index) : member_(zip_fopen_index(archive, index, 0), &zip_fclose) {}

  [[nodiscard]] bool is_open() const { return member_ != nullptr; }
  /// Fills a place, or as much of it as there is to come; false where the member is damaged.
  [[nodiscard]] bool read(std::span<char> place, std::size_t& count) const {
    count = 0;
    while (count < place.size()) {
      const zip_int64_t read = zip_fread(member_.get(), place.data() + count, place.size() - count);
      if (read < 0) return false;
      if (read == 0) break;
      count += static_cast<std::size_t>(read);
    }
    return true;
  }

 private:
  std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> member_;
};

}  // namespace

ZipArchive::ZipArchive(const FileBytes& file) : file_(file), archive_(nullptr, &zip_discard) {
  check_count(file);
  zip_error_t error{};
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(file.content().data(), file.size(), 0, &error);
  if (source != nullptr) archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
  if (archive_ == nullptr) {
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    if (source != nullptr) zip_source_free(source);
    file.refuse_at(0, fmt::format("it is no zip archive that can be read ({})", why));
  }
  zip_error_fini(&error);
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    names_.emplace_back(name == nullptr ? "" : name);
  }
}

FileBytes ZipArchive::read(std::size_t index, std::size_t limit) const {
  const std::string name = shown(names_.at(index));
  const auto refuse = [&](std::string_view complaint) { file_.refuse_at(0, fmt::format("'{}' {}", name, complaint)); };
  zip_stat_t about{};
  if (zip_stat_index(archive_.get(), index, 0, &about) != 0 || (about.valid & ZIP_STAT_SIZE) == 0) {
    refuse("has no size");
  }
  if (about.size > limit) refuse(fmt::format("is larger than {} MiB, which is the limit", limit >> 20));
  const auto size = static_cast<std::size_t>(about.size);
  const auto unpack = [&](auto&& place_of) {
    const Member member(archive_.get(), index);
    if (!member.is_open()) refuse("is encrypted, or packed in a way that is not known; expected deflate");
    std::size_t done = 0;
    for (std::size_t count = 1; count > 0; done += count) {
      if (!member.read(place_of(done), count)) refuse("is damaged");
      if (count > size - done) refuse("is longer than the archive says");
    }
    if (done != size) refuse("is shorter than the archive says");
  };
  std::vector<char> part(std::min(size + 1, kPart));
  unpack([&](std::size_t) { return std::span<char>(part); });
  // One more byte, so that the end and with it the sum of checks is seen.
  std::string content(size + 1, '\0');
  unpack([&](std::size_t done) { return std::span<char>(content).subspan(done); });
  content.pop_back();
  return FileBytes::copy(file_.path() / name, content);
}

}  // namespace lobe
