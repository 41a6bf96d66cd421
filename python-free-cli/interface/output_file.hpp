#pragma once

#include <filesystem>
#include <string>

#include "interface/command.hpp"
#include "lobe/core/output_lock.hpp"

namespace lobe::cli {

class Session;

/// The file of --output, checked before the work, and no other process's as long as this lives. "-" is standard output.
class OutputFile {
 public:
  /// \param otherwise the file without --output; empty: none
  /// \throws IoError when the file exists without --force, another process is writing it, or it cannot be written where
  /// it
  ///   is to be.
  explicit OutputFile(const Session& session, const std::filesystem::path& otherwise = {});

  [[nodiscard]] bool is_wanted() const { return !path_.empty(); }
  /// Empty where no file is wanted.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Whether a file that is there may be replaced: with --force, or when the same command was killed.
  [[nodiscard]] bool overwrites() const;
  /// Writes a text, complete or not at all, unless no file is wanted.
  /// \throws IoError; Cancelled after Ctrl-C.
  void write(const std::string& text) const;

 private:
  const Session& session_;
  std::filesystem::path path_;
  OutputLock lock_;
};

/// Whether --output is standard output, where results then have no place.
[[nodiscard]] bool takes_standard_output(const Arguments& arguments);

}  // namespace lobe::cli
