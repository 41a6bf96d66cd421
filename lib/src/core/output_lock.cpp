#include "core/output_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include "core/file_writer.hpp"
#include "core/unfinished.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

/// "PID\nWORK"
std::string content_of(int descriptor) {
  std::string text;
  std::array<char, 4096> part{};
  for (off_t at = 0;;) {
    const ssize_t count = retried([&] { return ::pread(descriptor, part.data(), part.size(), at); });
    if (count <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(count));
    at += count;
  }
}

/// The file with the name is still the one that is open: its last holder may have removed it meanwhile.
bool is_at(const fs::path& path, int descriptor) {
  struct stat named {};
  struct stat open {};
  return ::stat(path.c_str(), &named) == 0 && ::fstat(descriptor, &open) == 0 && named.st_ino == open.st_ino &&
         named.st_dev == open.st_dev;
}

}  // namespace

class OutputLock::Held {
 public:
  // A lock is given back under the mutex too: a thread that asked for it between the last user's end and the closing of
  // the file would meet it as that of another process. Neither this nor the list is ever destroyed: locks may last
  // longer than other objects with static storage.
  static std::mutex& mutex() {
    static auto& one = *new std::mutex;
    return one;
  }
  static std::map<fs::path, Held*>& all() {
    static auto& list = *new std::map<fs::path, Held*>;
    return list;
  }

  Held(const fs::path& output, fs::path path, std::string_view work) : path_(std::move(path)) {
    do {
      if (descriptor_ >= 0) ::close(descriptor_);
      descriptor_ = retried([&] { return ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644); });
      if (descriptor_ < 0) {
        const std::error_code code(errno, std::generic_category());
        throw IoError("cannot write " + output.string() + ": " + code.message(),
                      {.fault = fault_of(code), .path = output.string()});
      }
      lock(output);
    } while (!is_at(path_, descriptor_));
    file_.emplace(path_);
    const std::string before = content_of(descriptor_);
    const std::size_t line = before.find('\n');
    goes_on_ = line != before.npos && std::string_view(before).substr(line + 1) == work;
    const std::string content = std::to_string(::getpid()) + "\n" + std::string(work);
    // A lock that does not name its work cannot be continued, but it is still a lock.
    if (retried([&] { return ::ftruncate(descriptor_, 0); }) != 0 ||
        retried([&] { return ::pwrite(descriptor_, content.data(), content.size(), 0); }) < 0) {
      return;
    }
  }
  ~Held() {
    if (!is_of_this_process()) file_->finish();
    file_.reset();  // first the name, then the lock: who gets that of a file without a name opens another one
    ::close(descriptor_);
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  [[nodiscard]] bool goes_on() const { return goes_on_; }
  void leave_behind() { file_->finish(); }
  /// Not of a child that has come with all memory of its parent, which alone holds the lock.
  [[nodiscard]] bool is_of_this_process() const { return process_ == ::getpid(); }

  int users = 0;  ///< guarded by mutex()

 private:
  void lock(const fs::path& output) const {
    while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EINTR) continue;
      // File systems without locks have none to wait for.
      if (errno != EWOULDBLOCK) return;
      const std::string content = content_of(descriptor_);
      ::close(descriptor_);
      const std::string holder = content.substr(0, content.find('\n'));
      throw IoError(output.string() + " is being written by " +
                    (holder.empty() ? "another process" : "process " + holder) +
                    "; wait for it, or give another output name");
    }
  }

  fs::path path_;
  int descriptor_ = -1;
  std::optional<Unfinished> file_;
  bool goes_on_ = false;
  pid_t process_ = ::getpid();
};

OutputLock::OutputLock(const fs::path& output, std::string_view work) {
  std::error_code ignored;
  const fs::path directory = fs::canonical(output.has_parent_path() ? output.parent_path() : fs::path("."), ignored);
  const fs::path path =
      (directory.empty() ? output.parent_path() : directory) / ("." + output.filename().string() + ".lock");
  const std::lock_guard lock(Held::mutex());
  const auto found = Held::all().find(path);
  Held* held = found == Held::all().end() ? nullptr : found->second;
  if (held == nullptr || !held->is_of_this_process()) {
    auto made = std::make_unique<Held>(output, path, work);
    Held::all()[path] = made.get();
    held = made.release();
  }
  ++held->users;
  held_ = {held, [path](Held* last) {
             const std::lock_guard release(Held::mutex());
             if (--last->users > 0) return;
             const std::unique_ptr<Held> gone(last);
             const auto entry = Held::all().find(path);
             if (entry != Held::all().end() && entry->second == last) Held::all().erase(entry);
           }};
}

void OutputLock::leave_behind() const {
  if (held_) held_->leave_behind();
}

bool OutputLock::goes_on() const {
  return held_ && held_->goes_on();
}

}  // namespace lobe
