#include "lobe/core/error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <system_error>

namespace lobe::test {
namespace {

TEST(Error, HasItsProblemAndItsAdviceApart) {
  const ArgumentError error("unknown model 'wart'; did you mean 'ward'?; or not", {.topic = Topic::models});
  EXPECT_EQ(error.problem(), "unknown model 'wart'");
  EXPECT_EQ(error.advice(), "did you mean 'ward'?; or not");
  EXPECT_STREQ(error.what(), "unknown model 'wart'; did you mean 'ward'?; or not");
  EXPECT_EQ(error.topic(), Topic::models);
  EXPECT_EQ(error.fault(), Fault::unspecified);
}

TEST(Error, WithoutAdviceIsAllProblem) {
  const IoError error("cannot read a.h5", {.fault = Fault::missing_file, .path = "a.h5"});
  EXPECT_EQ(error.problem(), "cannot read a.h5");
  EXPECT_EQ(error.advice(), "");
  EXPECT_EQ(error.path(), "a.h5");
}

TEST(Error, KeepsItsFieldsWhenItIsCopied) {
  const DeviceError error("no kernel", "line 1", {.fault = Fault::wrong_results});
  const DeviceError copy = error;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(copy.fault(), Fault::wrong_results);
  EXPECT_EQ(copy.build_log(), "line 1");
}

TEST(Error, KnowsTheFaultsOfTheSystem) {
  EXPECT_EQ(fault_of(std::make_error_code(std::errc::no_such_file_or_directory)), Fault::missing_file);
  EXPECT_EQ(fault_of(std::make_error_code(std::errc::no_space_on_device)), Fault::no_space);
  EXPECT_EQ(fault_of(std::make_error_code(std::errc::io_error)), Fault::unspecified);
}

}  // namespace
}  // namespace lobe::test
