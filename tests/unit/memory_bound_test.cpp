// Tables in files in place of memory.
#include "lobe/core/memory_bound.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>

#include "lobe/core/error.hpp"
#include "lobe/table/table.hpp"
#include "support/full_disk.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::size_t kMiB = std::size_t{1} << 20;
constexpr std::size_t kNumbers = kMiB / sizeof(double);

std::uint64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0;
  std::uint64_t resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// Mappings of files without names that were made in a folder.
std::size_t nameless_files(const fs::path& folder) {
  std::ifstream maps("/proc/self/maps");
  std::size_t count = 0;
  for (std::string line; std::getline(maps, line);) {
    const bool is_nameless = line.ends_with("(deleted)");
    if (is_nameless && line.find(folder.string() + "/") != std::string::npos) ++count;
  }
  return count;
}

/// A folder of its own, where tests run, which is on a disk.
class MemoryBounds : public ::testing::Test {
 protected:
  MemoryBounds() { fs::create_directory(folder_); }
  ~MemoryBounds() override { fs::remove_all(folder_); }

  void SetUp() override {
    try {
      const MemoryBound bound(folder_, 1024 * kMiB);
    } catch (const IoError& error) {
      if (std::string_view(error.what()).find("tmpfs") != std::string_view::npos) GTEST_SKIP() << error.what();
      throw;
    }
  }

  const fs::path folder_ = fs::current_path() / ("memory-bound-" + std::to_string(::getpid()));
};

TEST_F(MemoryBounds, KeepTablesThatAreLargerAsTheyAre) {
  const std::uint64_t before = resident_bytes();
  const MemoryBound bound(folder_, before + 96 * kMiB);
  TableValues values(224 * kNumbers);
  EXPECT_EQ(nameless_files(folder_), 1U);

  std::iota(values.begin(), values.end(), 0.0);
  const TableValues copy = values;
  double wrong = 0;
  for (std::size_t i = 0; i < copy.size(); ++i) wrong += copy[i] != static_cast<double>(i) ? 1 : 0;

  EXPECT_EQ(wrong, 0);
  // Both are 448 MiB. A look comes late where all processors are busy.
  EXPECT_LT(bound.peak_bytes(), before + 224 * kMiB);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(MemoryBounds, LeaveTablesThatOutliveThem) {
  TableValues before(4 * kNumbers, 1.0);
  std::optional<MemoryBound> bound(std::in_place, folder_, resident_bytes() + 64 * kMiB);
  TableValues values(4 * kNumbers, 2.0);
  bound.reset();
  const TableValues after(4 * kNumbers, 3.0);

  EXPECT_EQ(nameless_files(folder_), 1U);
  EXPECT_EQ(values.front() + values.back(), 4);
  values = TableValues();
  before = TableValues();
  EXPECT_EQ(nameless_files(folder_), 0U);
}

TEST_F(MemoryBounds, LeaveSmallTablesInMemory) {
  const MemoryBound bound(folder_, resident_bytes() + 64 * kMiB);
  const TableValues small(kNumbers - 1);
  EXPECT_EQ(nameless_files(folder_), 0U);
  const TableValues large(kNumbers);
  EXPECT_EQ(nameless_files(folder_), 1U);
}

TEST_F(MemoryBounds, RefuseATableForWhichTheDiskHasNoRoom) {
  const MemoryBound bound(folder_, resident_bytes() + 64 * kMiB);
  const FullDisk disk(2 * kMiB);
  try {
    const TableValues values(4 * kNumbers);
    ADD_FAILURE() << "a table on a full disk";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot keep a table of 4194304 bytes in " + folder_.string() + ": "));
    EXPECT_EQ(error.path(), folder_.string());
  }
  EXPECT_EQ(nameless_files(folder_), 0U);
}

TEST_F(MemoryBounds, RefuseFoldersThatDoNot) {
  const auto what = [](const fs::path& folder) -> std::string {
    try {
      const MemoryBound bound(folder, 1024 * kMiB);
    } catch (const IoError& error) {
      return error.what();
    }
    return "it was taken";
  };
  EXPECT_THAT(what(folder_ / "absent"), HasSubstr("No such file or directory; expected a folder on a disk"));
  if (fs::exists("/dev/shm")) {
    EXPECT_THAT(what("/dev/shm"), HasSubstr("which lies in memory (tmpfs)"));
  }
  std::ofstream(folder_ / "file") << "text";
  EXPECT_THAT(what(folder_ / "file"), HasSubstr("Not a directory"));
}

TEST_F(MemoryBounds, AreOneAtATime) {
  std::optional<MemoryBound> first(std::in_place, folder_, 1024 * kMiB);
  EXPECT_THROW(MemoryBound(folder_, 1024 * kMiB), ArgumentError);
  first.reset();
  EXPECT_NO_THROW(MemoryBound(folder_, 1024 * kMiB));
}

}  // namespace
}  // namespace lobe::test
