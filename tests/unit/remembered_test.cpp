// What searches remember of a function.
#include "fit/remembered.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace lobe::test {
namespace {

/// A function that counts what it is asked.
BrdfFunction counted(std::atomic<std::size_t>& count) {
  BrdfFunction function;
  function.name = "counted";
  function.channels = {"value"};
  function.at = [&count](std::span<const Directions> pairs) {
    count += pairs.size();
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      values.value(static_cast<Eigen::Index>(i), 0) = pairs[i].theta_in + 10 * pairs[i].theta_out + pairs[i].phi_in;
    }
    values.error = 0.1 * values.value;
    return values;
  };
  return function;
}

TEST(Remembered, AnswersFromMemoryWhatItWasAskedBefore) {
  std::atomic<std::size_t> count = 0;
  const BrdfFunction function = remembered(counted(count), 1U << 20U);
  const std::vector<Directions> pairs{{0.1, 0.2, 0.3, 0}, {0.4, 0.5, 0.6, 0}};
  const std::vector<Directions> others{{0.1, 0.2, 0.3, 0}, {0.4, 0.5, 0.6, 0.7}};

  const BrdfValues first = function.at(pairs);
  const BrdfValues second = function.at(others);

  EXPECT_EQ(count, 4U);
  EXPECT_EQ(function.at(pairs).value, first.value);
  EXPECT_EQ(function.at(others).value, second.value);
  EXPECT_EQ(function.at(pairs).error, first.error);
  EXPECT_EQ(count, 4U);
  EXPECT_NEAR(second.value(1, 0) - first.value(1, 0), 0.7, 1e-15);
  EXPECT_EQ(function.at(std::span(pairs).first(1)).value, first.value.topRows(1));
  EXPECT_EQ(count, 5U);
}

TEST(Remembered, KeepsNoMoreThanItMay) {
  std::atomic<std::size_t> count = 0;
  // A pair of four numbers, its value and error, and 128 for each answer.
  const BrdfFunction function = remembered(counted(count), 2 * (128 + 6 * sizeof(double)));
  for (int round = 0; round < 2; ++round) {
    for (const double theta : {0.1, 0.2, 0.3}) {
      const std::vector<Directions> pair{{theta, 0, 0, 0}};
      EXPECT_EQ(function.at(pair).value(0, 0), theta) << round;
    }
  }
  EXPECT_EQ(count, 4U);  // the third is asked for twice
}

TEST(Remembered, TakesThreads) {
  std::atomic<std::size_t> count = 0;
  const BrdfFunction function = remembered(counted(count), 1U << 20U);
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 200; ++i) {
          const double theta = 0.001 * (i % 50);
          const std::vector<Directions> pair{{theta, 0, 0, 0}};
          if (function.at(pair).value(0, 0) != theta) ++wrong;
        }
      });
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(count, 200U);  // each thread may be the first to ask
  EXPECT_GE(count, 50U);
}

}  // namespace
}  // namespace lobe::test
