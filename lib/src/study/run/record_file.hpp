#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace lobe {

/// Work of checkpoints that is not done again; less is, rather than written.
inline constexpr double kSecondsWorthKeeping = 1;  // s

/// Records (checkpoint_records.hpp) that are appended to a file as soon as they are known, under an identity of the
/// work that they belong to. What another identity left counts as nothing, and is replaced as soon as there is
/// something to keep; a file that is something else is left alone.
class RecordFile {
 public:
  explicit RecordFile(std::filesystem::path path) : path_(std::move(path)) {}

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::size_t size() const { return records_.size(); }
  [[nodiscard]] const std::map<std::string, std::string, std::less<>>& records() const { return records_; }

  /// Reads the file, if there is one, without changing it. A damaged end counts as not there.
  /// \param materials of the study: results of others are dropped
  void open(std::string identity, std::size_t materials);
  /// Content of a record; null: there is none.
  [[nodiscard]] const std::string* find(std::string_view name) const;
  /// Appends a record. If the file cannot be written it is removed, and nothing is kept from then on.
  void keep(const std::string& name, const std::string& content);
  /// Removes the file, unless it is of another identity.
  void remove();

 private:
  std::filesystem::path path_;
  std::string identity_;
  std::map<std::string, std::string, std::less<>> records_;
  bool is_broken_ = false;                  ///< nothing is kept
  bool is_ours_ = false;                    ///< the file holds records of this identity
  std::optional<std::size_t> sound_bytes_;  ///< size of an opened file without a damaged end
};

}  // namespace lobe
