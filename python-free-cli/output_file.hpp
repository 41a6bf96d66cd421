#pragma once

#include <filesystem>
#include <string>

namespace lobe::cli {

class Session;

/// The file of --output, checked before the work.
class OutputFile {
 public:
  /// \param otherwise the file without --output; empty: none
  /// \throws IoError when the file exists without --force, or cannot be written where it is to be.
  explicit OutputFile(const Session& session, const std::filesystem::path& otherwise = {});

  [[nodiscard]] bool is_wanted() const { return !path_.empty(); }
  /// Empty where no file is wanted.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a text, complete or not at all, unless no file is wanted. \throws IoError; Cancelled after Ctrl-C.
  void write(const std::string& text) const;

 private:
  const Session& session_;
  std::filesystem::path path_;
};

}  // namespace lobe::cli
