#include "core/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/file_set.hpp"
#include "core/output_lock.hpp"
#include "lobe/core/error.hpp"
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
    fs::remove(temporary);
    fs::create_symlink("/dev/full", temporary);
    std::ofstream full(temporary);
    full << std::string(1 << 16, 'x') << std::flush;
    if (!full) throw IoError("cannot write " + temporary.string() + ": no space left on device");
  };

  EXPECT_THROW(write_atomically(file("a.txt"), false, writer), IoError);

  EXPECT_FALSE(fs::exists(file("a.txt")));
  EXPECT_EQ(entries(), 1) << "only the link to the device may stay";
}

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0) << path;
  return status.st_mode & 07777U;
}

TEST_F(Files, ANewFileHasTheUsualModeAndAReplacedOneKeepsIts) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  write_text(file("a.txt"), false, "new");
  EXPECT_EQ(mode_of(file("a.txt")), 0666U & ~mask);

  for (const mode_t mode : {0600U, 0664U, 0444U}) {
    SCOPED_TRACE(mode);
    ASSERT_EQ(::chmod(file("a.txt").c_str(), mode), 0);
    write_text(file("a.txt"), true, "newer");
    EXPECT_EQ(mode_of(file("a.txt")), mode);
  }
  EXPECT_EQ(read_text(file("a.txt")), "newer");
}

TEST_F(Files, LinksAreFollowed) {
  write_text(file("a.txt"), false, "old");
  fs::create_symlink("a.txt", file("link"));

  write_text(file("link"), true, "new");

  EXPECT_TRUE(fs::is_symlink(file("link")));
  EXPECT_EQ(read_text(file("a.txt")), "new");
  fs::create_symlink("absent.txt", file("dangling"));
  write_text(file("dangling"), false, "made");
  EXPECT_EQ(read_text(file("absent.txt")), "made");
  EXPECT_TRUE(fs::is_symlink(file("dangling")));
}

TEST_F(Files, DevicesAndPipesAreWrittenToAndStay) {
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = read_text(file("pipe")); });
  write_text(file("pipe"), true, "through the pipe");
  reader.join();
  EXPECT_EQ(read, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(file("pipe")));

  fs::create_symlink("/dev/null", file("null"));
  write_text(file("null"), true, "nowhere");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  fs::create_symlink("/dev/full", file("full"));
  EXPECT_THROW(write_text(file("full"), true, "text"), IoError);
  EXPECT_EQ(entries(), 3) << "nothing was made beside them";
}

TEST_F(Files, OneOfManyWritersOfANewFileWins) {
  constexpr int kRounds = 20;
  constexpr int kWriters = 6;
  for (int round = 0; round < kRounds; ++round) {
    const fs::path target = file("a" + std::to_string(round));
    std::atomic<int> written = 0;
    std::atomic<int> winner = -1;
    std::vector<std::thread> writers;
    for (int k = 0; k < kWriters; ++k) {
      writers.emplace_back([&, k] {
        try {
          // All begin before the first one ends.
          write_atomically(target, false, [&](const fs::path& temporary) {
            std::ofstream(temporary) << k;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
          });
          ++written;
          winner = k;
        } catch (const IoError& error) {
          EXPECT_THAT(error.what(), ::testing::HasSubstr("exists")) << round << ' ' << k;
        }
      });
    }
    for (std::thread& writer : writers) writer.join();
    EXPECT_EQ(written, 1) << round;
    EXPECT_EQ(read_text(target), std::to_string(winner)) << round;
  }
  EXPECT_EQ(entries(), kRounds);
}

TEST_F(Files, WhatKilledWritersLeftGoesWithTheNextOne) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      write_atomically(file("a.txt"), false, [](const fs::path& temporary) {
        std::ofstream(temporary) << "half";
        ::raise(SIGKILL);
      });
    } catch (...) {
      std::_Exit(1);
    }
  }
  int state = 0;
  ASSERT_EQ(::waitpid(child, &state, 0), child);
  ASSERT_TRUE(WIFSIGNALED(state));
  EXPECT_EQ(entries(), 1) << "what it had begun";
  // Of somebody who is alive, and of another file.
  std::ofstream(file("a.txt.tmp-elsewhere-1-2")) << "not ours";
  std::ofstream(file("b.txt.tmp-" + std::to_string(child))) << "no temporary";

  write_text(file("a.txt"), false, "whole");

  EXPECT_EQ(read_text(file("a.txt")), "whole");
  EXPECT_EQ(entries(), 3);
}

TEST_F(Files, ALockKeepsOtherProcessesOutUntilItsHolderEnds) {
  const auto tried_elsewhere = [&](const std::string& work) {
    const pid_t child = ::fork();
    if (child == 0) {
      try {
        const OutputLock lock(file("a.txt"), work);
        std::_Exit(lock.goes_on() ? 2 : 0);
      } catch (const IoError&) {
        std::_Exit(1);
      }
    }
    int state = 0;
    EXPECT_EQ(::waitpid(child, &state, 0), child);
    return WEXITSTATUS(state);
  };
  {
    const OutputLock lock(file("a.txt"), "lobe one");
    const OutputLock shared(file("a.txt"), "lobe one");
    EXPECT_FALSE(lock.goes_on());
    EXPECT_EQ(tried_elsewhere("lobe two"), 1);
  }
  EXPECT_EQ(entries(), 0);
  EXPECT_EQ(tried_elsewhere("lobe two"), 0);
}

TEST_F(Files, ThreadsShareALockWhileTheOthersGiveItBack) {
  std::atomic<int> refused = 0;
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&] {
        for (int i = 0; i < 2000; ++i) {
          try {
            const OutputLock lock(file("a.txt"), "lobe one");
          } catch (const IoError&) {
            ++refused;
          }
        }
      });
    }
  }
  EXPECT_EQ(refused, 0);
  EXPECT_EQ(entries(), 0);
}

TEST_F(Files, ALockOfAKilledHolderIsThatOfTheSameWork) {
  const auto kill_holder = [&] {
    const pid_t child = ::fork();
    if (child == 0) {
      const OutputLock lock(file("a.txt"), "lobe one");
      ::raise(SIGKILL);
    }
    int state = 0;
    EXPECT_EQ(::waitpid(child, &state, 0), child);
    EXPECT_EQ(entries(), 1);
  };
  kill_holder();
  EXPECT_FALSE(OutputLock(file("a.txt"), "lobe two").goes_on());
  EXPECT_EQ(entries(), 0);
  kill_holder();
  EXPECT_TRUE(OutputLock(file("a.txt"), "lobe one").goes_on());
  EXPECT_EQ(entries(), 0);
}

TEST_F(Files, ASetTakesItsPlaceAsAWholeOrNotAtAll) {
  write_text(file("a"), false, "old a");
  write_text(file("b"), false, "old b");
  write_text(file("picture"), false, "old picture");
  const auto texts = [&] { return read_text(file("a")) + ", " + read_text(file("b")); };
  {
    FileSet set(directory_.path(), "set", true);
    set.write("a", "new a");
    EXPECT_EQ(texts(), "old a, old b");
  }
  EXPECT_EQ(entries(), 3);
  // The last one cannot move: a directory is in its place.
  fs::create_directory(file("c"));
  {
    FileSet set(directory_.path(), "set", true);
    set.write("a", "new a");
    set.write("b", "new b");
    set.leave_out("picture");
    set.write("c", "new c");
    EXPECT_THROW(set.keep(), IoError);
  }
  EXPECT_EQ(texts(), "old a, old b");
  EXPECT_EQ(entries(), 4);
  fs::remove(file("c"));
  FileSet set(directory_.path(), "set", true);
  set.write("a", "new a");
  set.write("b", "new b");
  set.leave_out("picture");
  set.keep();
  EXPECT_EQ(texts(), "new a, new b");
  EXPECT_FALSE(fs::exists(file("picture")));
  FileSet other(directory_.path(), "other", false);
  other.write("a", "another a");
  EXPECT_THROW(other.keep(), IoError);
  EXPECT_EQ(texts(), "new a, new b");
}

TEST_F(Files, ASetThatWasKilledWhileItMovedIsMovedByTheNextOne) {
  write_text(file("a"), false, "old a");
  write_text(file("b"), false, "old b");
  const pid_t child = ::fork();
  if (child == 0) {
    FileSet set(directory_.path(), "set", true);
    set.write("a", "new a");
    set.write("b", "new b");
    // As keep() leaves it after the first of two steps.
    write_text(set.staging() / "journal", false, "+a\n+b\n");
    fs::rename(file("a"), set.staging() / "older.a");
    fs::rename(set.staging() / "a", file("a"));
    fs::rename(file("b"), set.staging() / "older.b");
    ::raise(SIGKILL);
  }
  int state = 0;
  ASSERT_EQ(::waitpid(child, &state, 0), child);
  ASSERT_TRUE(WIFSIGNALED(state));
  EXPECT_FALSE(fs::exists(file("b")));

  finish_killed(directory_.path(), "set");

  EXPECT_EQ(read_text(file("a")) + ", " + read_text(file("b")), "new a, new b");
  EXPECT_FALSE(fs::exists(file(".set.unfinished")));
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
