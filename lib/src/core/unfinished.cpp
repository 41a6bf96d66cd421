#include "core/unfinished.hpp"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "lobe/core/files.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

// Never destroyed: locks may last longer than other objects with static storage.
std::recursive_mutex& mutex() {
  static auto& one = *new std::recursive_mutex;
  return one;
}

std::vector<fs::path>& paths() {
  static auto& list = *new std::vector<fs::path>;
  return list;
}

/// A file, or a directory with the files in it; nothing deeper is ours.
void take_away(const fs::path& path) {
  std::error_code code;
  if (fs::is_directory(fs::symlink_status(path, code))) {
    for (fs::directory_iterator at(path, code), end; !code && at != end; at.increment(code)) {
      std::error_code ignored;
      if (!fs::is_directory(at->symlink_status(ignored))) fs::remove(at->path(), ignored);
    }
  }
  fs::remove(path, code);
}

}  // namespace

Unfinished::Unfinished(fs::path path) : path_(std::move(path)) {
  const auto lock = without_interruption();
  paths().push_back(path_);
}

Unfinished::~Unfinished() {
  if (is_finished_) return;
  take_away(path_);
  finish();
}

void Unfinished::finish() {
  const auto lock = without_interruption();
  is_finished_ = true;
  const auto found = std::ranges::find(paths(), path_);
  if (found != paths().end()) paths().erase(found);
}

void remove_unfinished() {
  const auto lock = without_interruption();
  for (auto at = paths().rbegin(); at != paths().rend(); ++at) take_away(*at);
}

std::unique_lock<std::recursive_mutex> without_interruption() {
  return std::unique_lock(mutex());
}

}  // namespace lobe
