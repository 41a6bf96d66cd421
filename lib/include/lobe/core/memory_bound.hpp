#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace [[gnu::visibility("default")]] lobe {

/// Bounds the memory that this process occupies. While it lives, tables of at least 1 MiB are made in files without
/// names instead of memory, and what is resident of these files is given back to the system whenever the process comes
/// near the bound; the system writes it to the disk and reads it again where it is used. So tables may be larger than
/// the machine's memory. Results are the same to the last bit. Nothing bounds what is no table; peak_bytes() tells what
/// was reached. The files end with their tables, also where the process is killed. A disk that fails while they are
/// used, or whose file system does not keep the room that it has promised, ends the process.
class MemoryBound {
 public:
  /// Begins to bound the memory of this process, of which one bound may live at a time.
  /// \param folder for the files of tables, on a disk
  /// \param bytes the bound: resident memory, with the process itself and the runtime of OpenCL
  /// \throws ArgumentError if a bound lives already; IoError if no file can be made in the folder, if it lies in memory
  ///   itself (tmpfs), or if the system does not tell how much memory the process has
  MemoryBound(std::filesystem::path folder, std::uint64_t bytes);
  /// Ends the bound. Tables that were made meanwhile stay in their files.
  ~MemoryBound();
  MemoryBound(const MemoryBound&) = delete;
  MemoryBound& operator=(const MemoryBound&) = delete;

  /// Folder of the files.
  [[nodiscard]] const std::filesystem::path& folder() const;
  /// Bound, in bytes.
  [[nodiscard]] std::uint64_t bytes() const;
  /// Most memory that the process has occupied since the bound began, in bytes; looked at four times per
  /// millisecond.
  [[nodiscard]] std::uint64_t peak_bytes() const;

 private:
  struct Watch;
  std::unique_ptr<Watch> watch_;
};

/// Allocates memory for the values of a table, uninitialised, on cache lines; in a file while a MemoryBound lives.
/// \throws std::bad_alloc; IoError if there is no room for the file
[[nodiscard]] void* allocate_table_memory(std::size_t bytes);
/// Releases memory of allocate_table_memory().
/// \param bytes as it was asked for
void release_table_memory(void* memory, std::size_t bytes) noexcept;

}  // namespace lobe
