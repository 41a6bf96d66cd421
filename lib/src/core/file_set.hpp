#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lobe {

/// Files that are written together: those of an unfinished set are removed, except those that replaced older ones.
class FileSet {
 public:
  explicit FileSet(bool overwrite) : overwrite_(overwrite) {}
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// \throws as write_text().
  void write(const std::filesystem::path& path, const std::string& text);
  /// The set is complete.
  void keep() { fresh_.clear(); }

 private:
  bool overwrite_;
  std::vector<std::filesystem::path> fresh_;
};

/// \throws IoError when there is such a file.
void require_absent(const std::filesystem::path& path);

/// Makes a directory where there is none. \throws IoError
void make_directory(const std::filesystem::path& directory);

}  // namespace lobe
