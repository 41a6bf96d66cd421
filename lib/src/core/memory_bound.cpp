#include "lobe/core/memory_bound.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <numeric>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

namespace fs = std::filesystem;

constexpr std::align_val_t kCacheLines{128};
constexpr std::size_t kSmallestFile = std::size_t{1} << 20;

/// Tables in files, wherever their bound has gone.
struct Mappings {
  std::mutex mutex;
  std::map<void*, std::size_t> bytes;  ///< by where they begin
  fs::path folder;                     ///< empty: tables are made in memory
  std::atomic<bool> is_used = false;   ///< whether there ever was a folder
};

/// Never destroyed: tables may end after everything else.
Mappings& mappings() {
  static auto* const all = new Mappings;  // NOLINT(cppcoreguidelines-owning-memory)
  return *all;
}

[[noreturn]] void fail(const std::string& what, int error, const fs::path& folder) {
  const std::error_code code(error, std::generic_category());
  const char* expected = error == ENOMEM ? "; expected addresses for the tables (ulimit -v)"
                                         : "; expected a folder on a disk with room for the tables";
  throw IoError(what + ": " + code.message() + expected, {.fault = fault_of(code), .path = folder.string()});
}

/// A file without a name.
/// \return its descriptor; -1 with errno
int open_nameless(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return file;
  std::string path = (folder / "lobe-table-XXXXXX").string();
  const int named = ::mkostemp(path.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(path.c_str());
  return named;
}

/// Room on the disk for a whole file, so that none of its pages can be refused later, which would end the process.
/// \return 0, or what errno would be
int reserve(int file, std::size_t bytes) {
  const auto length = static_cast<off_t>(bytes);
  int error = 0;
  do {
    error = ::fallocate(file, 0, 0, length) == 0 ? 0 : errno;
  } while (error == EINTR);
  return error == EOPNOTSUPP ? ::posix_fallocate(file, 0, length) : error;
}

/// A file in the folder, mapped. Without the lock: file systems that reserve room by writing take long.
void* map_file(const fs::path& folder, std::size_t bytes) {
  const std::string what = "cannot keep a table of " + std::to_string(bytes) + " bytes in " + folder.string();
  const int file = open_nameless(folder);
  if (file < 0) fail(what, errno, folder);
  int error = reserve(file, bytes);
  void* memory = MAP_FAILED;
  if (error == 0) {
    memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (memory == MAP_FAILED) error = errno;
  }
  ::close(file);
  if (memory == MAP_FAILED) fail(what, error, folder);
  // A page at a time: else hundreds of megabytes come back between two looks at the memory of the process.
  ::madvise(memory, bytes, MADV_NOHUGEPAGE);
  return memory;
}

/// The folder for tables of this size; empty: they are made in memory.
fs::path folder_for(std::size_t bytes) {
  Mappings& all = mappings();
  if (bytes < kSmallestFile || !all.is_used) return {};
  const std::lock_guard lock(all.mutex);
  return all.folder;
}

/// What the system tells of this process's memory.
class ProcessMemory {
 public:
  ProcessMemory() : file_(::open("/proc/self/statm", O_RDONLY | O_CLOEXEC)) {}
  ~ProcessMemory() {
    if (file_ >= 0) ::close(file_);
  }
  ProcessMemory(const ProcessMemory&) = delete;
  ProcessMemory& operator=(const ProcessMemory&) = delete;

  /// Memory that is occupied, bytes; 0 where unknown.
  [[nodiscard]] std::uint64_t resident_bytes() const {
    std::array<char, 128> text{};
    const ssize_t length = ::pread(file_, text.data(), text.size() - 1, 0);
    const char* const second = length > 0 ? std::strchr(text.data(), ' ') : nullptr;
    return second == nullptr ? 0 : std::strtoull(second, nullptr, 10) * page_bytes_;
  }

 private:
  int file_;
  std::uint64_t page_bytes_ = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
};

/// Gives the pages of all files back: what was written to them stays in the system's hands.
void give_back() {
  Mappings& all = mappings();
  const std::lock_guard lock(all.mutex);
  for (const auto& [memory, bytes] : all.bytes) ::madvise(memory, bytes, MADV_DONTNEED);
}

}  // namespace

void* allocate_table_memory(std::size_t bytes) {
  const fs::path folder = folder_for(bytes);
  if (folder.empty()) return ::operator new(bytes, kCacheLines);
  void* const memory = map_file(folder, bytes);
  try {
    Mappings& all = mappings();
    const std::lock_guard lock(all.mutex);
    all.bytes.emplace(memory, bytes);
  } catch (...) {
    ::munmap(memory, bytes);
    throw;
  }
  return memory;
}

void release_table_memory(void* memory, std::size_t bytes) noexcept {
  Mappings& all = mappings();
  if (bytes >= kSmallestFile && all.is_used) {
    const std::lock_guard lock(all.mutex);
    if (all.bytes.erase(memory) > 0) {
      ::munmap(memory, bytes);
      return;
    }
  }
  ::operator delete(memory, kCacheLines);
}

/// Looks at the memory of the process now and then, in a thread of its own.
struct MemoryBound::Watch {
  std::uint64_t bound;
  fs::path folder;
  std::atomic<std::uint64_t> peak = 0;
  std::mutex mutex;
  std::condition_variable changed;
  bool is_over = false;
  std::thread thread;

  Watch(fs::path where, std::uint64_t bytes) : bound(bytes), folder(std::move(where)) {}

  void run() {
    using namespace std::chrono_literals;
    // Where all processors are busy, a look may come 30 ms late, and meanwhile 150 MiB of files are mapped that the
    // system has at hand.
    const std::uint64_t usual = bound - std::min<std::uint64_t>(std::uint64_t{192} << 20, bound / 3);
    std::uint64_t allowed = usual;
    const ProcessMemory memory;
    std::unique_lock lock(mutex);
    while (!changed.wait_for(lock, 250us, [this] { return is_over; })) {
      const std::uint64_t resident = memory.resident_bytes();
      peak = std::max<std::uint64_t>(peak, resident);
      if (resident <= usual) allowed = usual;
      if (resident <= allowed) continue;
      give_back();
      // Where the rest takes most of the bound, or more, tables get what is left, or some: without pages nothing goes
      // on.
      const std::uint64_t rest = memory.resident_bytes();
      const std::uint64_t some = rest + bound / 8;
      allowed = std::max(usual, rest < bound ? std::min(some, std::midpoint(rest, bound)) : some);
    }
  }
};

MemoryBound::MemoryBound(fs::path folder, std::uint64_t bytes)
    : watch_(std::make_unique<Watch>(std::move(folder), bytes)) {
  constexpr decltype(statfs::f_type) kTmpfs = 0x01021994;  // TMPFS_MAGIC of linux/magic.h
  const std::string& name = watch_->folder.string();
  struct statfs system {};
  if (::statfs(name.c_str(), &system) != 0) fail("cannot keep tables in " + name, errno, name);
  if (system.f_type == kTmpfs) {
    throw IoError("cannot keep tables in " + name + ", which lies in memory (tmpfs); expected a folder on a disk",
                  {.path = name});
  }
  const int file = open_nameless(watch_->folder);
  if (file < 0) fail("cannot keep tables in " + name, errno, name);
  ::close(file);
  watch_->peak = ProcessMemory().resident_bytes();
  if (watch_->peak == 0)
    throw IoError("the system does not tell how much memory a process has; expected /proc/self/statm");
  Mappings& all = mappings();
  const std::lock_guard lock(all.mutex);
  if (!all.folder.empty()) throw ArgumentError("the memory of this process is bounded already; expected one bound");
  fs::path own = watch_->folder;
  watch_->thread = std::thread([watch = watch_.get()] { watch->run(); });
  all.folder.swap(own);
  all.is_used = true;
}

MemoryBound::~MemoryBound() {
  {
    const std::lock_guard lock(watch_->mutex);
    watch_->is_over = true;
    watch_->changed.notify_all();
  }
  watch_->thread.join();
  Mappings& all = mappings();
  const std::lock_guard lock(all.mutex);
  all.folder.clear();
}

const fs::path& MemoryBound::folder() const {
  return watch_->folder;
}

std::uint64_t MemoryBound::bytes() const {
  return watch_->bound;
}

std::uint64_t MemoryBound::peak_bytes() const {
  return watch_->peak;
}

}  // namespace lobe
