#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "lobe/core/output_lock.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Files that are written together into a directory. They are made in a directory of their own beside their places,
/// ".NAME.unfinished", and moved all at once. A failure before that leaves the older files as they were. If the process
/// is killed while they move, the next set of the same name moves the rest.
class FileSet {
 public:
  /// Begins a set in a directory, which is made if it does not exist.
  /// \param directory the place of the files
  /// \param name the name of the set; no two processes write it at once
  /// \param overwrite whether existing files may be replaced
  /// \throws IoError as OutputLock, and when nothing can be written
  FileSet(const std::filesystem::path& directory, const std::string& name, bool overwrite);
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;
  ~FileSet();

  /// Directory in which files of the set are made; add() makes them part of it.
  [[nodiscard]] const std::filesystem::path& staging() const;
  /// Adds a file that has been made in staging().
  void add(const std::string& name) { added_.push_back(name); }
  /// Writes a file and adds it.
  /// \throws IoError
  void write(const std::string& name, const std::string& text);
  /// Removes the file of this name from the directory, with the set.
  void leave_out(const std::string& name) { left_out_.push_back(name); }

  /// Moves the files to their places.
  /// \throws IoError, with the older files as they were
  void keep();

 private:
  struct Staging;

  std::filesystem::path directory_;
  bool overwrite_;
  OutputLock lock_;
  std::unique_ptr<Staging> staging_;
  std::vector<std::string> added_;
  std::vector<std::string> left_out_;
};

/// Moves the files that a killed process had begun to move, and removes its unfinished ones, under the lock of the set.
/// \throws IoError
void finish_killed(const std::filesystem::path& directory, const std::string& name);

}  // namespace lobe
