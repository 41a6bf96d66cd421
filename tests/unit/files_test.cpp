#include "core/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "lobe/error.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path file(const std::string& name) const { return directory_.path() / name; }
  [[nodiscard]] long entries() const {
    return std::distance(fs::directory_iterator(directory_.path()), fs::directory_iterator{});
  }
  TemporaryDirectory directory_;
};

TEST_F(Files, WriteAndReadBackTheSameBytes) {
  const std::string text("line\n\0binary\r\n", 14);

  write_text(file("a.txt"), false, text);

  EXPECT_EQ(read_text(file("a.txt")), text);
  EXPECT_EQ(entries(), 1) << "a temporary file stayed";
}

TEST_F(Files, AnExistingFileIsKeptWithoutOverwrite) {
  write_text(file("a.txt"), false, "old");

  EXPECT_THROW(write_text(file("a.txt"), false, "new"), IoError);

  EXPECT_EQ(read_text(file("a.txt")), "old");
}

TEST_F(Files, AnExistingFileIsReplacedWithOverwrite) {
  write_text(file("a.txt"), false, "a longer old text");

  write_text(file("a.txt"), true, "new");

  EXPECT_EQ(read_text(file("a.txt")), "new");
}

TEST_F(Files, AFailedWriterLeavesNothing) {
  const auto failing = [](const fs::path& temporary) {
    std::ofstream(temporary) << "half";
    throw std::runtime_error("disk full");
  };

  EXPECT_THROW(write_atomically(file("a.txt"), false, failing), std::runtime_error);

  EXPECT_EQ(entries(), 0);
}

TEST_F(Files, AFailedWriterLeavesTheOldFileAlone) {
  write_text(file("a.txt"), false, "old");
  const auto failing = [](const fs::path& temporary) {
    std::ofstream(temporary) << "half";
    throw std::runtime_error("disk full");
  };

  EXPECT_THROW(write_atomically(file("a.txt"), true, failing), std::runtime_error);

  EXPECT_EQ(read_text(file("a.txt")), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, TheTargetIsAbsentWhileItIsWritten) {
  bool existed = true;

  write_atomically(file("a.txt"), false, [&](const fs::path& temporary) {
    std::ofstream(temporary) << "text";
    existed = fs::exists(file("a.txt"));
  });

  EXPECT_FALSE(existed);
  EXPECT_TRUE(fs::exists(file("a.txt")));
}

TEST_F(Files, AMissingDirectoryIsAnIoErrorThatNamesTheFile) {
  const auto target = file("no/such/a.txt");

  try {
    write_text(target, false, "text");
    FAIL() << "expected IoError";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(target.string()));
  }
}

TEST_F(Files, AFullDiskIsAnIoErrorAndLeavesNothing) {
  if (!fs::exists("/dev/full")) GTEST_FAIL() << "/dev/full is missing";
  fs::create_symlink("/dev/full", file("full"));
  const auto writer = [&](const fs::path& temporary) {
    fs::create_symlink("/dev/full", temporary);
    std::ofstream full(temporary);
    full << std::string(1 << 16, 'x') << std::flush;
    if (!full) throw IoError("cannot write " + temporary.string() + ": no space left on device");
  };

  EXPECT_THROW(write_atomically(file("a.txt"), false, writer), IoError);

  EXPECT_FALSE(fs::exists(file("a.txt")));
  EXPECT_EQ(entries(), 1) << "only the link to the device may stay";
}

TEST_F(Files, ADirectoryIsNoTarget) {
  fs::create_directory(file("d"));

  EXPECT_THROW(write_text(file("d"), true, "text"), IoError);

  EXPECT_TRUE(fs::is_directory(file("d")));
}

TEST_F(Files, AMissingFileIsAnIoErrorWithTheReason) {
  try {
    (void)read_text(file("missing.toml"));
    FAIL() << "expected IoError";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("missing.toml"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("No such file"));
  }
}

TEST_F(Files, ADirectoryCannotBeRead) {
  EXPECT_THROW((void)read_text(directory_.path()), IoError);
}

}  // namespace
}  // namespace lobe::test
