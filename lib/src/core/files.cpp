#include "core/files.hpp"

#include <fcntl.h>
#include <glob.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <system_error>

#include "lobe/error.hpp"

namespace lobe {
namespace {

std::string reason(int code) {
  return std::error_code(code, std::generic_category()).message();
}

void sync_to_disk(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw IoError("cannot open " + path.string() + ": " + reason(errno));
  const int failed = ::fsync(descriptor);
  const int code = errno;
  ::close(descriptor);
  // Directories of some file systems cannot be synced (EINVAL); the data itself is on the disk by then.
  if (failed != 0 && code != EINVAL) throw IoError("cannot write " + path.string() + ": " + reason(code));
}

}  // namespace

void write_atomically(const std::filesystem::path& target, bool overwrite,
                      const std::function<void(const std::filesystem::path& temporary)>& write) {
  std::error_code ignored;
  if (!overwrite && std::filesystem::exists(target, ignored)) {
    throw IoError(target.string() + " exists; use --force to replace it, or another output name");
  }
  if (std::filesystem::is_directory(target, ignored)) {
    throw IoError(target.string() + " is a directory; expected a file name");
  }
  std::filesystem::path temporary = target;
  temporary += ".tmp-" + std::to_string(::getpid());
  try {
    write(temporary);
    sync_to_disk(temporary);
    if (std::rename(temporary.c_str(), target.c_str()) != 0) {
      throw IoError("cannot write " + target.string() + ": " + reason(errno));
    }
  } catch (...) {
    std::filesystem::remove(temporary, ignored);
    throw;
  }
  sync_to_disk(target.has_parent_path() ? target.parent_path() : std::filesystem::path("."));
}

void write_text(const std::filesystem::path& target, bool overwrite, const std::string& text) {
  write_atomically(target, overwrite, [&](const std::filesystem::path& temporary) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(temporary.c_str(), "wb"), std::fclose);
    if (!file) throw IoError("cannot write " + target.string() + ": " + reason(errno));
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0) {
      throw IoError("cannot write " + target.string() + ": " + reason(errno));
    }
  });
}

std::vector<std::filesystem::path> matching_files(const std::string& pattern) {
  glob_t found{};
  std::vector<std::filesystem::path> paths;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  }
  ::globfree(&found);
  return paths;
}

std::string pattern_of(std::string_view literal) {
  std::string pattern;
  for (const char c : literal) {
    if (std::string_view("*?[]\\").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

std::string read_text(const std::filesystem::path& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) throw IoError("cannot read " + path.string() + ": is a directory");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError("cannot read " + path.string() + ": " + reason(errno != 0 ? errno : ENOENT));
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

}  // namespace lobe
