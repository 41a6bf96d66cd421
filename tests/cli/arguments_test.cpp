// What commands read of their arguments, and how.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string_view>

#include "interface/command.hpp"
#include "interface/options.hpp"
#include "interface/parser.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;

constexpr cli::Number kAngle{"angle"};
constexpr cli::Count kTimes{"times"};
constexpr cli::Words kColours{"colours"};

TEST(Arguments, AreReadByTheirHandles) {
  cli::Arguments arguments;
  for (const cli::Handle& handle : {cli::Handle(kAngle), cli::Handle(kTimes), cli::Handle(kColours)}) {
    arguments.declare(handle);
  }
  arguments.set("angle", {"30", "45"});
  arguments.set("colours", {"red, blue"});
  EXPECT_EQ(arguments.number(kAngle), 45);
  EXPECT_EQ(arguments.all(kAngle).size(), 2);
  EXPECT_THAT(arguments.words(kColours), ElementsAre("red", "blue"));
  EXPECT_FALSE(arguments.has(kTimes));
  EXPECT_EQ(arguments.text(kTimes), "");
}

TEST(Arguments, RefuseAHandleThatTheCommandDoesNotDeclare) {
  const cli::Arguments arguments;
  EXPECT_THROW((void)arguments.has(kAngle), std::logic_error);
  EXPECT_THROW((void)arguments.number(kAngle), std::logic_error);
  EXPECT_THROW((void)arguments.text(kTimes), std::logic_error);
  EXPECT_FALSE(arguments.takes(kAngle));
  EXPECT_FALSE(arguments.is_given(kAngle));
}

TEST(Arguments, KnowWhatEveryCommandTakesBeforeOneIsNamed) {
  const cli::Arguments arguments;
  EXPECT_FALSE(arguments.has(cli::option::verbose));
  EXPECT_EQ(arguments.text(cli::option::color), "");
}

TEST(Arguments, KnowWhatTheParsedCommandDeclares) {
  const auto invocation = cli::parse(cli::commands(), {"transpose", "lambert", "-o", "a.h5"});
  EXPECT_TRUE(invocation.arguments.has(cli::option::output));
  EXPECT_FALSE(invocation.arguments.has(cli::option::force));
  EXPECT_TRUE(invocation.arguments.takes(cli::option::channels));
  EXPECT_FALSE(invocation.arguments.takes(cli::option::exact_grid));
}

// A name as text, or a handle of another kind, does not compile.
template <typename Given>
constexpr bool kReadsNumbers = requires(const cli::Arguments& arguments, const Given& given) {
  arguments.number(given);
};
static_assert(kReadsNumbers<cli::Number>);
static_assert(!kReadsNumbers<cli::Flag>);
static_assert(!kReadsNumbers<cli::Words>);
static_assert(!kReadsNumbers<std::string_view>);

}  // namespace
}  // namespace lobe::test
