#include "lobe/core/error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

namespace lobe::test {
namespace {

template <typename T>
constexpr bool kIsLobeError = std::is_base_of_v<Error, T> && !std::is_same_v<Error, T>;

static_assert(kIsLobeError<ArgumentError>);
static_assert(kIsLobeError<IoError>);
static_assert(kIsLobeError<DeviceError>);
static_assert(kIsLobeError<NumericError>);
static_assert(kIsLobeError<Cancelled>);
static_assert(std::is_base_of_v<std::runtime_error, Error>);
static_assert(!std::is_base_of_v<ArgumentError, IoError>, "siblings: the exit code depends on the class");

TEST(Error, OwnsItsText) {
  std::string message = "unknown model 'wrad'";
  const ArgumentError error(message);

  message.assign(100, '?');

  EXPECT_STREQ(error.what(), "unknown model 'wrad'");
}

TEST(DeviceError, CarriesTheBuildLog) {
  const DeviceError error("kernel does not build", "ward.clh:17: error");

  EXPECT_STREQ(error.what(), "kernel does not build");
  EXPECT_EQ(error.build_log(), "ward.clh:17: error");
}

TEST(DeviceError, HasNoLogByDefault) {
  EXPECT_EQ(DeviceError("no device").build_log(), "");
}

}  // namespace
}  // namespace lobe::test
