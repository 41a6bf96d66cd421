#include "lobe/metric/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "metric/comparison_measure.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

TEST(ComparisonName, IsReadBackForEveryMetric) {
  ASSERT_FALSE(comparisons().empty());
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

TEST(HalfDifferenceDensity, IsFiniteWhereCosinesRoundToOne) {
  NodeBlock::Node node{};
  node[NodeBlock::cos_i] = node[NodeBlock::cos_o] = node[NodeBlock::cos_h] = node[NodeBlock::cos_d] = 1;
  node[NodeBlock::tan2_h] = 1e-13;
  EXPECT_EQ(half_difference_density(node), 0);
}

}  // namespace
}  // namespace lobe::test
