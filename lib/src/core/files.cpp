#include "core/files.hpp"

#include <fcntl.h>
#include <glob.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <string_view>
#include <system_error>

#include "core/file_writer.hpp"
#include "core/unfinished.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

std::string reason(int code) {
  return std::error_code(code, std::generic_category()).message();
}

ErrorFields fields_of(int code, const fs::path& path) {
  return {.fault = fault_of(std::error_code(code, std::generic_category())), .path = path.string()};
}

[[noreturn]] void fail_to_write(const fs::path& target, int code) {
  throw IoError("cannot write " + target.string() + ": " + reason(code), fields_of(code, target));
}

[[noreturn]] void refuse_existing(const fs::path& target) {
  throw IoError(target.string() + " exists; expected leave to replace it, or another output name",
                {.fault = Fault::existing_file, .path = target.string()});
}

/// A name with dots for what is no letter or digit.
std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "host";
  std::string host = name.data();
  std::ranges::replace_if(
      host, [](unsigned char c) { return std::isalnum(c) == 0; }, '.');
  return host;
}

/// Stem of temporary files beside a target: TARGET.tmp-HOST-PID-RANDOM.
std::string temporary_stem(const fs::path& target) {
  return target.filename().string() + ".tmp-" + host_name() + "-";
}

/// Removes temporary files that processes of this machine have left which are no longer there.
void remove_stale(const fs::path& target) {
  const std::string stem = temporary_stem(target);
  const fs::path directory = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code code;
  for (fs::directory_iterator at(directory, code), end; !code && at != end; at.increment(code)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(stem)) continue;
    int process = 0;
    const char* const begin = name.data() + stem.size();
    const auto [stop, failed] = std::from_chars(begin, name.data() + name.size(), process);
    if (failed != std::errc() || *stop != '-' || process <= 0) continue;
    if (::kill(process, 0) == 0 || errno != ESRCH) continue;
    std::error_code ignored;
    fs::remove(at->path(), ignored);
  }
}

/// An empty file beside the target that nobody else has.
/// \throws IoError
fs::path make_temporary(const fs::path& target) {
  std::random_device random;
  for (;;) {
    fs::path path = target;
    path.replace_filename(temporary_stem(target) + std::to_string(::getpid()) + "-" + std::to_string(random()));
    const int descriptor = retried([&] { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
    if (descriptor >= 0) {
      ::close(descriptor);
      return path;
    }
    if (errno != EEXIST) fail_to_write(target, errno);
  }
}

/// Renames where nothing has the new name.
/// \throws IoError
void rename_to_new(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return;
  if (errno == EEXIST) refuse_existing(to);
  // File systems that do not know this (NFS) may have hard links, which replace nothing either.
  if (errno == EINVAL || errno == ENOSYS) {
    if (::link(from.c_str(), to.c_str()) == 0) {
      ::unlink(from.c_str());
      return;
    }
    if (errno == EEXIST) refuse_existing(to);
    // Those that have neither: nobody else makes the name once it is there, and then it may be replaced.
    const int descriptor = retried([&] { return ::open(to.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
    if (descriptor >= 0) {
      ::close(descriptor);
      if (std::rename(from.c_str(), to.c_str()) == 0) return;
    }
    if (errno == EEXIST) refuse_existing(to);
  }
  fail_to_write(to, errno);
}

/// The number of a descriptor of this process that a path stands for.
std::optional<int> descriptor_of(const fs::path& path) {
  const std::string text = path.string();
  if (text == "/dev/stdout") return STDOUT_FILENO;
  if (text == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view directory : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!text.starts_with(directory)) continue;
    int number = -1;
    const auto [end, failed] = std::from_chars(text.data() + directory.size(), text.data() + text.size(), number);
    if (failed == std::errc() && end == text.data() + text.size()) return number;
  }
  return std::nullopt;
}

/// Copies a temporary file from elsewhere into a device or pipe.
/// \throws IoError
void write_to_stream(const fs::path& target, const std::function<void(const fs::path& temporary)>& write) {
  const Unfinished temporary(make_temporary(fs::temp_directory_path() / "lobe"));
  write(temporary.path());
  const std::optional<int> own = descriptor_of(target);
  const int to = own ? *own : retried([&] { return ::open(target.c_str(), O_WRONLY | O_CLOEXEC); });
  if (to < 0) fail_to_write(target, errno);
  const int from = retried([&] { return ::open(temporary.path().c_str(), O_RDONLY | O_CLOEXEC); });
  int failed = from < 0 ? errno : 0;
  std::array<char, 1 << 16> part{};
  while (failed == 0) {
    const ssize_t count = retried([&] { return ::read(from, part.data(), part.size()); });
    if (count < 0) failed = errno;
    if (count <= 0) break;
    for (ssize_t done = 0; done < count && failed == 0;) {
      const ssize_t written =
          retried([&] { return ::write(to, part.data() + done, static_cast<std::size_t>(count - done)); });
      if (written >= 0) done += written;
      if (written < 0) failed = errno;
    }
  }
  if (from >= 0) ::close(from);
  if (!own && ::close(to) != 0 && failed == 0 && errno != EINTR) failed = errno;
  // A reader that has gone away is no failure.
  if (failed != 0 && failed != EPIPE) fail_to_write(target, failed);
}

/// Where the links of a path lead to, whether there is something or not.
fs::path place_of(const fs::path& target) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code code;
  fs::path place = target;
  for (int k = 0; k < kMostLinks && fs::is_symlink(fs::symlink_status(place, code)); ++k) {
    place = place.parent_path() / fs::read_symlink(place, code);
  }
  return place;
}

}  // namespace

void sync_to_disk(const std::filesystem::path& path) {
  const int descriptor = retried([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); });
  if (descriptor < 0) throw IoError("cannot open " + path.string() + ": " + reason(errno), fields_of(errno, path));
  const int failed = retried([&] { return ::fsync(descriptor); });
  const int code = errno;
  ::close(descriptor);
  // Directories of some file systems cannot be synced (EINVAL); the data itself is on the disk by then.
  if (failed != 0 && code != EINVAL)
    throw IoError("cannot write " + path.string() + ": " + reason(code), fields_of(code, path));
}

bool is_output_stream(const fs::path& path) {
  if (descriptor_of(path)) return true;
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

void take_mode(const fs::path& file, const fs::path& replaced) {
  struct stat old {};
  if (::stat(replaced.c_str(), &old) != 0) return;
  // Without the permission it becomes ours; then no more than before may do with it what they could.
  const bool is_given = ::chown(file.c_str(), old.st_uid, old.st_gid) == 0;
  const mode_t mode = old.st_mode & (is_given ? mode_t{07777} : mode_t{0777});
  if (::chmod(file.c_str(), mode) != 0) fail_to_write(replaced, errno);
}

void write_atomically(const fs::path& target, bool overwrite,
                      const std::function<void(const fs::path& temporary)>& write) {
  std::error_code ignored;
  if (is_output_stream(target)) return write_to_stream(target, write);
  const fs::path place = place_of(target);
  if (fs::is_directory(place, ignored))
    throw IoError(target.string() + " is a directory; expected a file name",
                  {.fault = Fault::directory, .path = target.string()});
  if (!overwrite && fs::exists(place, ignored)) refuse_existing(target);
  remove_stale(place);
  Unfinished temporary(make_temporary(place));
  write(temporary.path());
  if (overwrite) take_mode(temporary.path(), place);
  sync_to_disk(temporary.path());
  {
    const auto lock = without_interruption();
    if (!overwrite) {
      rename_to_new(temporary.path(), place);
    } else if (std::rename(temporary.path().c_str(), place.c_str()) != 0) {
      fail_to_write(target, errno);
    }
    temporary.finish();
  }
  sync_to_disk(place.has_parent_path() ? place.parent_path() : fs::path("."));
}

void write_text(const std::filesystem::path& target, bool overwrite, const std::string& text) {
  write_atomically(target, overwrite, [&](const std::filesystem::path& temporary) {
    FileWriter file(temporary, target.string());
    file.write(text);
    file.close();
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
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw IoError("cannot read " + path.string() + ": is a directory", fields_of(EISDIR, path));
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const int code = errno != 0 ? errno : ENOENT;
    throw IoError("cannot read " + path.string() + ": " + reason(code), fields_of(code, path));
  }
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

}  // namespace lobe
