#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "lobe/study/shard.hpp"
#include "study/run/study_identity.hpp"

namespace lobe {

/// What a shard's file says of itself.
struct ShardHead {
  std::string study;  ///< name of the study
  Shard shard = {};
  PlanIdentity identity = {};
  std::string request = {};  ///< as in ShardOptions
};

/// The whole text of a shard's file: a mark, the size and the checksum of what follows, the head and the records.
[[nodiscard]] std::string shard_text(const ShardHead& head,
                                     const std::map<std::string, std::string, std::less<>>& records);

/// Whether a file begins as a shard's of this or another version.
[[nodiscard]] bool is_shard_file(const std::filesystem::path& path);

/// The file of a complete shard. Records stay on the disk until they are asked for.
class ShardFile {
 public:
  /// Reads all of the file once.
  /// \throws IoError that names the file: it cannot be read, is of another format, shorter or longer than it was, or
  ///   has other bytes
  explicit ShardFile(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const ShardHead& head() const { return head_; }
  [[nodiscard]] std::size_t records() const { return places_.size(); }
  [[nodiscard]] bool has(std::string_view name) const { return places_.contains(name); }
  /// Content of a record that is there.
  /// \throws IoError if the file has changed since
  [[nodiscard]] std::string content(std::string_view name) const;
  [[nodiscard]] const auto& places() const { return places_; }

 private:
  struct Place {
    std::uint64_t offset = 0;  ///< of the content
    std::uint64_t size = 0;
    std::uint64_t checksum = 0;
  };

  std::filesystem::path path_;
  ShardHead head_;
  std::map<std::string, Place, std::less<>> places_;
};

}  // namespace lobe
