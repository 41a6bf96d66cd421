#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <barrier>
#include <cstddef>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lobe::test {
namespace {

TEST(ParallelFor, CallsEachIndexOnce) {
  std::vector<std::atomic<int>> calls(1000);
  parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; });
  for (const auto& count : calls) EXPECT_EQ(count, 1);
}

TEST(ParallelFor, CutsIntoPieces) {
  for (const std::size_t count : {0U, 1U, 6U, 7U, 8U, 20U, 21U}) {
    std::vector<std::atomic<int>> calls(count);
    std::atomic<std::size_t> short_pieces = 0;
    parallel_for_pieces(count, 7, [&](std::size_t begin, std::size_t end) {
      EXPECT_LT(begin, end) << count;
      EXPECT_LE(end - begin, 7U) << count;
      if (end - begin < 7) ++short_pieces;
      for (std::size_t i = begin; i < end; ++i) ++calls[i];
    });
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(calls[i], 1) << i << " of " << count;
    EXPECT_EQ(short_pieces, count % 7 == 0 ? 0U : 1U) << count;
  }
}

TEST(ParallelFor, StaysOnItsThreadWithinAnother) {
  std::atomic<int> elsewhere = 0;
  std::atomic<int> calls = 0;
  parallel_for(8, [&](std::size_t) {
    const auto thread = std::this_thread::get_id();
    parallel_for(8, [&](std::size_t) {
      ++calls;
      if (std::this_thread::get_id() != thread) ++elsewhere;
    });
  });
  EXPECT_EQ(calls, 64);
  EXPECT_EQ(elsewhere, 0);
}

TEST(ParallelFor, PassesOnWhatIsThrownAndWorksAfterwards) {
  const auto fail = [](std::size_t i) {
    if (i == 3) throw std::runtime_error("three");
  };
  EXPECT_THROW(parallel_for(10, fail), std::runtime_error);
  std::atomic<int> calls = 0;
  parallel_for(10, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 10);
}

TEST(ParallelFor, ServesSeveralThreadsAtOnce) {
  constexpr std::size_t kCallers = 4;
  constexpr std::size_t kRounds = 200;
  constexpr std::size_t kCalls = 16;
  std::array<std::atomic<std::size_t>, kCallers> calls{};
  {
    std::vector<std::jthread> callers;
    for (auto& own : calls) {
      callers.emplace_back([&own] {
        for (std::size_t round = 0; round < kRounds; ++round) parallel_for(kCalls, [&](std::size_t) { ++own; });
      });
    }
  }
  for (const auto& own : calls) EXPECT_EQ(own, kRounds * kCalls);
}

TEST(ParallelFor, UsesAllCoresForWorkThatTakesLong) {
  const auto cores = static_cast<std::size_t>(std::max(1U, std::thread::hardware_concurrency()));
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::barrier all_are_there(static_cast<std::ptrdiff_t>(cores));
  parallel_for(cores, [&](std::size_t) {
    all_are_there.arrive_and_wait();
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  EXPECT_EQ(threads.size(), cores);
}

// The threads of a process are not those of a fork of it.
TEST(ParallelFor, WorksInAForkedProcess) {
  parallel_for(8, [](std::size_t) {});
  const pid_t child = ::fork();
  if (child == 0) {
    std::atomic<int> calls = 0;
    parallel_for(100, [&](std::size_t) { ++calls; });
    ::_exit(calls == 100 ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace lobe::test
