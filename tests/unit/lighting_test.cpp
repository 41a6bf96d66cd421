#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobe/error.hpp"
#include "lobe/metric.hpp"

namespace lobe::test {
namespace {

TEST(Lighting, NamesReadBack) {
  EXPECT_EQ(parse_lighting(to_string(Lighting::point)), Lighting::point);
  EXPECT_EQ(parse_lighting(to_string(Lighting::daylight)), Lighting::daylight);
}

TEST(Lighting, AMisspeltNameIsAnArgumentErrorWithASuggestion) {
  try {
    (void)parse_lighting("dayligt");
    FAIL() << "expected ArgumentError";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("did you mean 'daylight'?"));
  }
}

}  // namespace
}  // namespace lobe::test
