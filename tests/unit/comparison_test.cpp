#include "lobe/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lobe/error.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

TEST(ComparisonName, IsReadBackForEveryMetric) {
  ASSERT_EQ(comparisons().size(), 9U);
  for (const auto comparison : comparisons()) EXPECT_EQ(parse_comparison(to_string(comparison)), comparison);
}

TEST(ComparisonName, IsSuggestedForATypingMistake) {
  try {
    (void)parse_comparison("beiron-l2");
    FAIL() << "accepted";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'bieron-l2'?"));
  }
}

TEST(ComparisonOfTables, NeedsATable) {
  EXPECT_THROW((void)compare(std::vector<BrdfTable>{}, Comparison::ngan_l2), ArgumentError);
}

TEST(ComparisonOfTables, ChecksAllNamesFirst) {
  EXPECT_THROW((void)compare(std::vector<BrdfTable>{}, std::vector<std::string>{"ngan-l2", "nothing"}), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
