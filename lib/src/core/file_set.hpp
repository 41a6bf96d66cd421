#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/output_lock.hpp"
#include "core/unfinished.hpp"

namespace lobe {

/// Files that are written together into a directory: they are made in a directory of their own beside their places,
/// ".NAME.unfinished", and take these all at once. What goes wrong before leaves the older files as they were; where
/// the process is killed while they move, the next set of the name moves the rest.
class FileSet {
 public:
  /// \param name of the set in the directory, which is made where there is none: no two processes write it at once
  /// \throws IoError as OutputLock, and when nothing can be written
  FileSet(const std::filesystem::path& directory, const std::string& name, bool overwrite);
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// Where files of the set are made. They count once they are named.
  [[nodiscard]] const std::filesystem::path& staging() const { return staging_->path(); }
  /// A file that has been made there.
  void add(const std::string& name) { added_.push_back(name); }
  /// Makes a file.
  /// \throws IoError
  void write(const std::string& name, const std::string& text);
  /// No file of this name stays in the directory.
  void leave_out(const std::string& name) { left_out_.push_back(name); }

  /// Moves the files to their places.
  /// \throws IoError, with the older files as they were
  void keep();

 private:
  std::filesystem::path directory_;
  bool overwrite_;
  OutputLock lock_;
  std::optional<Unfinished> staging_;
  std::vector<std::string> added_;
  std::vector<std::string> left_out_;
};

/// Moves what a killed process had begun to move, and removes what it had not finished; under the lock of the set.
/// \throws IoError
void finish_killed(const std::filesystem::path& directory, const std::string& name);

/// Whether a process has left the set with some of its files moved and some not, which finish_killed() and FileSet put
/// right.
[[nodiscard]] bool is_half_moved(const std::filesystem::path& directory, const std::string& name);

/// \throws IoError when there is such a file.
void require_absent(const std::filesystem::path& path);

/// Makes a directory where there is none.
/// \throws IoError
void make_directory(const std::filesystem::path& directory);

}  // namespace lobe
