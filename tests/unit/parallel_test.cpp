#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
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

}  // namespace
}  // namespace lobe::test
