#include "lobe/compare/literature_metric.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compare/comparison_measure.hpp"
#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

TEST(ComparisonName, IsReadBackForEveryMetric) {
  ASSERT_FALSE(literature_metrics().empty());
  for (const auto comparison : literature_metrics())
    EXPECT_EQ(parse_literature_metric(to_string(comparison)), comparison);
}

TEST(ComparisonName, IsSuggestedForATypingMistake) {
  try {
    (void)parse_literature_metric("beiron-l2");
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
