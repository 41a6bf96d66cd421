#pragma once

#include <filesystem>
#include <mutex>

namespace lobe {

/// A file, or a directory with files, that is there only until the work that it belongs to is done.
class Unfinished {
 public:
  explicit Unfinished(std::filesystem::path path);
  /// Removes it, unless it is finished.
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// It has become what it was made for, or has gone.
  void finish();

 private:
  std::filesystem::path path_;
  bool is_finished_ = false;
};

/// While it is held remove_unfinished() (lobe/core/files.hpp) waits: for a few steps of which none may be without the
/// others.
[[nodiscard]] std::unique_lock<std::recursive_mutex> without_interruption();

}  // namespace lobe
