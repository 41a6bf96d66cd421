#include "core/file_set.hpp"

#include <system_error>

#include "core/files.hpp"
#include "lobe/error.hpp"

namespace lobe {

FileSet::~FileSet() {
  std::error_code ignored;
  for (const auto& path : fresh_) std::filesystem::remove(path, ignored);
}

void FileSet::write(const std::filesystem::path& path, const std::string& text) {
  std::error_code ignored;
  const bool is_fresh = !std::filesystem::exists(path, ignored);
  write_text(path, overwrite_, text);
  if (is_fresh) fresh_.push_back(path);
}

void require_absent(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) {
    throw IoError(path.string() + " exists; use --force to replace it, or another output name");
  }
}

void make_directory(const std::filesystem::path& directory) {
  if (directory.empty()) return;
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  if (code) throw IoError("cannot create directory " + directory.string() + ": " + code.message());
}

}  // namespace lobe
