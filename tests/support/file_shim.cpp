// A library that is preloaded before libc and does with chosen calls on files what full and broken disks do. By
// variables of the environment:
//
//   LOBE_IO_BELOW=DIRECTORY     only files below it are concerned
//   LOBE_IO_PROGRAM=NAME        only in processes of that name, not in their children
//   LOBE_IO_FAIL=NAME:N[+]:KIND the N-th call of NAME (from 1; of any where NAME is *) fails as KIND says; with a + all
//   from the
//                               N-th on. KIND is the name of an error (ENOSPC, EIO, EDQUOT, EACCES, EINVAL), or
//                                 SHORT  half of what is to be written is
//                                 EINTR  the call is interrupted, the next one of its kind is not (those on names never
//                                 are)
//   LOBE_IO_LOG=FILE            a line "NAME PATH" is appended for every call
//
// Calls: open (that may create), fopen (to write), write, pwrite, writev, fwrite, fflush, fclose, close (of what is
// open to write), fsync, ftruncate, rename, link, unlink, mkdir, copy. Reading never fails.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace {

constexpr int kShort = -1;

[[noreturn]] void refuse(const char* variable, const char* value) {
  std::fprintf(stderr, "file_shim: cannot understand %s=%s\n", variable, value);
  std::abort();
}

int kind_of(std::string_view name) {
  for (const auto& [known, code] : {std::pair<std::string_view, int>{"SHORT", kShort},
                                    {"EINTR", EINTR},
                                    {"ENOSPC", ENOSPC},
                                    {"EIO", EIO},
                                    {"EDQUOT", EDQUOT},
                                    {"EACCES", EACCES},
                                    {"EPERM", EPERM},
                                    {"EINVAL", EINVAL}}) {
    if (name == known) return code;
  }
  return 0;
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// What has a name only is changed in one go.
bool can_be_interrupted(std::string_view call) {
  for (const std::string_view known : {"rename", "renameat2", "link", "unlink", "mkdir"}) {
    if (call == known) return false;
  }
  return true;
}

class Shim {
 public:
  static Shim& get() {
    static auto& one = *new Shim;  // never destroyed: files are closed late
    return one;
  }

  /// \return 0 where a call is to be made as it is, kShort, or the error that answers it
  int note(const char* name, const std::string& path) {
    if (!is_on_ || !path.starts_with(below_)) return 0;
    const std::lock_guard lock(mutex_);
    if (!log_.empty()) append(std::string(name) + " " + path.substr(below_.size()) + "\n");
    const long call = ++calls_[name];
    const long any = ++all_calls_;
    if (call_ == 0 || (name_ != "*" && name_ != name)) return 0;
    const long now = name_ == "*" ? any : call;
    if (now != call_ && !(lasts_ && now > call_)) return 0;
    if (kind_ != EINTR) return kind_;
    if (!can_be_interrupted(name)) return 0;
    bool& was_interrupted = interrupted_[name];
    was_interrupted = !was_interrupted;
    return was_interrupted ? EINTR : 0;
  }

 private:
  Shim() {
    below_ = variable("LOBE_IO_BELOW");
    log_ = variable("LOBE_IO_LOG");
    const std::string program = variable("LOBE_IO_PROGRAM");
    is_on_ = !below_.empty() && (program.empty() || program == program_invocation_short_name);
    const std::string fail = variable("LOBE_IO_FAIL");
    if (fail.empty()) return;
    const std::size_t colon = fail.find(':');
    if (colon == fail.npos) refuse("LOBE_IO_FAIL", fail.c_str());
    name_ = fail.substr(0, colon);
    char* end = nullptr;
    call_ = std::strtol(fail.c_str() + colon + 1, &end, 10);
    lasts_ = *end == '+';
    if (lasts_) ++end;
    if (*end == ':') kind_ = kind_of(end + 1);
    if (call_ < 1 || kind_ == 0) refuse("LOBE_IO_FAIL", fail.c_str());
  }

  /// Past this library.
  void append(const std::string& line) const {
    const auto file = ::syscall(SYS_openat, AT_FDCWD, log_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0 || ::syscall(SYS_write, file, line.data(), line.size()) < 0) std::abort();
    ::syscall(SYS_close, file);
  }

  std::mutex mutex_;
  std::string below_, log_, name_;
  bool is_on_ = false;
  bool lasts_ = false;
  long call_ = 0;
  int kind_ = 0;
  long all_calls_ = 0;
  std::map<std::string, long> calls_;
  std::map<std::string, bool> interrupted_;
};

template <typename Function>
Function next(const char* name) {
  void* const found = ::dlsym(RTLD_NEXT, name);
  if (found == nullptr) std::abort();
  return reinterpret_cast<Function>(found);
}

std::string absolute(const char* path, int directory = AT_FDCWD);

/// Where an open file lies; empty for what is no file.
std::string path_of(int descriptor) {
  std::array<char, 4096> target{};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t size = ::readlink(link.c_str(), target.data(), target.size());
  return size > 0 ? std::string(target.data(), static_cast<std::size_t>(size)) : std::string();
}

std::string absolute(const char* path, int directory) {
  if (*path == '/') return path;
  if (directory != AT_FDCWD) return path_of(directory) + "/" + path;
  std::array<char, 4096> here{};
  return ::getcwd(here.data(), here.size()) == nullptr ? std::string() : std::string(here.data()) + "/" + path;
}

bool is_open_to_write(int descriptor) {
  const int flags = ::fcntl(descriptor, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

template <typename Result>
Result failed(int code, Result result) {
  errno = code;
  return result;
}

/// For calls of which no part can be done.
int error_of(const char* name, const std::string& path) {
  const int kind = Shim::get().note(name, path);
  return kind == kShort ? 0 : kind;
}

std::size_t half(std::size_t size) {
  return size > 1 ? size / 2 : size;
}

bool creates(int flags) {
  return (flags & (O_CREAT | O_TRUNC)) != 0;
}

bool writes(const char* mode) {
  return std::strpbrk(mode, "wa+") != nullptr;
}

}  // namespace

#define LOBE_NEXT(name) static const auto next_call = next<decltype(&name)>(#name)

extern "C" {

#define LOBE_OPEN(name)                                                     \
  int name(const char* path, int flags, ...) {                              \
    LOBE_NEXT(name);                                                        \
    mode_t mode = 0;                                                        \
    if ((flags & O_CREAT) != 0) {                                           \
      va_list rest;                                                         \
      va_start(rest, flags);                                                \
      mode = va_arg(rest, mode_t);                                          \
      va_end(rest);                                                         \
    }                                                                       \
    const int code = creates(flags) ? error_of("open", absolute(path)) : 0; \
    return code != 0 ? failed(code, -1) : next_call(path, flags, mode);     \
  }
LOBE_OPEN(open)
LOBE_OPEN(open64)

#define LOBE_FOPEN(name)                                                                       \
  std::FILE* name(const char* path, const char* mode) {                                        \
    LOBE_NEXT(name);                                                                           \
    const int code = writes(mode) ? error_of("fopen", absolute(path)) : 0;                     \
    return code != 0 ? failed(code, static_cast<std::FILE*>(nullptr)) : next_call(path, mode); \
  }
LOBE_FOPEN(fopen)
LOBE_FOPEN(fopen64)

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  LOBE_NEXT(write);
  const int kind = Shim::get().note("write", path_of(descriptor));
  if (kind > 0) return failed<ssize_t>(kind, -1);
  return next_call(descriptor, bytes, kind == kShort ? half(size) : size);
}

#define LOBE_PWRITE(name)                                                            \
  ssize_t name(int descriptor, const void* bytes, std::size_t size, off_t offset) {  \
    LOBE_NEXT(name);                                                                 \
    const int kind = Shim::get().note("pwrite", path_of(descriptor));                \
    if (kind > 0) return failed<ssize_t>(kind, -1);                                  \
    return next_call(descriptor, bytes, kind == kShort ? half(size) : size, offset); \
  }
LOBE_PWRITE(pwrite)
LOBE_PWRITE(pwrite64)

ssize_t writev(int descriptor, const iovec* parts, int count) {
  LOBE_NEXT(writev);
  const int kind = Shim::get().note("writev", path_of(descriptor));
  if (kind > 0) return failed<ssize_t>(kind, -1);
  if (kind != kShort || count < 1) return next_call(descriptor, parts, count);
  const iovec first{parts[0].iov_base, half(parts[0].iov_len)};
  return next_call(descriptor, &first, 1);
}

std::size_t fwrite(const void* bytes, std::size_t size, std::size_t count, std::FILE* file) {
  LOBE_NEXT(fwrite);
  const int kind = Shim::get().note("fwrite", path_of(::fileno(file)));
  if (kind > 0) return failed<std::size_t>(kind, 0);
  return next_call(bytes, size, kind == kShort ? half(count) : count, file);
}

int fflush(std::FILE* file) {
  LOBE_NEXT(fflush);
  const int code = file == nullptr ? 0 : error_of("fflush", path_of(::fileno(file)));
  return code != 0 ? failed(code, EOF) : next_call(file);
}

int fclose(std::FILE* file) {
  LOBE_NEXT(fclose);
  const int descriptor = ::fileno(file);
  const int code = is_open_to_write(descriptor) ? error_of("fclose", path_of(descriptor)) : 0;
  const int result = next_call(file);  // closed, whatever the answer
  return code != 0 ? failed(code, EOF) : result;
}

int close(int descriptor) {
  LOBE_NEXT(close);
  const int code = is_open_to_write(descriptor) ? error_of("close", path_of(descriptor)) : 0;
  const int result = next_call(descriptor);
  return code != 0 ? failed(code, -1) : result;
}

#define LOBE_ON_OPEN(name, counted, parameters, arguments)     \
  int name parameters {                                        \
    LOBE_NEXT(name);                                           \
    const int code = error_of(counted, path_of(descriptor));   \
    return code != 0 ? failed(code, -1) : next_call arguments; \
  }
LOBE_ON_OPEN(fsync, "fsync", (int descriptor), (descriptor))
LOBE_ON_OPEN(fdatasync, "fsync", (int descriptor), (descriptor))
LOBE_ON_OPEN(ftruncate, "ftruncate", (int descriptor, off_t size), (descriptor, size))
LOBE_ON_OPEN(ftruncate64, "ftruncate", (int descriptor, off_t size), (descriptor, size))

#define LOBE_ON_PATH(name, counted, parameters, path, arguments) \
  int name parameters {                                          \
    LOBE_NEXT(name);                                             \
    const int code = error_of(counted, path);                    \
    return code != 0 ? failed(code, -1) : next_call arguments;   \
  }
LOBE_ON_PATH(rename, "rename", (const char* from, const char* to), absolute(to), (from, to))
LOBE_ON_PATH(renameat, "rename", (int old_place, const char* from, int place, const char* to), absolute(to, place),
             (old_place, from, place, to))
LOBE_ON_PATH(renameat2, "renameat2", (int old_place, const char* from, int place, const char* to, unsigned flags),
             absolute(to, place), (old_place, from, place, to, flags))
LOBE_ON_PATH(link, "link", (const char* from, const char* to), absolute(to), (from, to))
LOBE_ON_PATH(unlink, "unlink", (const char* path), absolute(path), (path))
LOBE_ON_PATH(unlinkat, "unlink", (int place, const char* path, int flags), absolute(path, place), (place, path, flags))
LOBE_ON_PATH(remove, "unlink", (const char* path), absolute(path), (path))
LOBE_ON_PATH(rmdir, "unlink", (const char* path), absolute(path), (path))
LOBE_ON_PATH(mkdir, "mkdir", (const char* path, mode_t mode), absolute(path), (path, mode))

ssize_t sendfile(int to, int from, off_t* offset, std::size_t size) {
  LOBE_NEXT(sendfile);
  const int kind = Shim::get().note("copy", path_of(to));
  if (kind > 0) return failed<ssize_t>(kind, -1);
  return next_call(to, from, offset, kind == kShort ? half(size) : size);
}

ssize_t copy_file_range(int from, off_t* from_offset, int to, off_t* to_offset, std::size_t size, unsigned flags) {
  LOBE_NEXT(copy_file_range);
  const int kind = Shim::get().note("copy", path_of(to));
  if (kind > 0) return failed<ssize_t>(kind, -1);
  return next_call(from, from_offset, to, to_offset, kind == kShort ? half(size) : size, flags);
}

}  // extern "C"
