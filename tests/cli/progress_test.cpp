// Progress of long work: one line on a terminal, nothing elsewhere.
#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using namespace std::chrono_literals;

/// Tens of seconds of work, which is interrupted when enough has been seen of it.
const Words kLong{"gram", LOBE_STUDIES_DIRECTORY "/classical-families.toml", "--lighting", "daylight", "--tolerance",
                  "1e-12"};

class Progress : public CommandTest {
 protected:
  /// What three seconds of the work show on standard error, without the last line.
  [[nodiscard]] std::string shown(const Words& options, bool on_terminal = true,
                                  const std::string& terminal = "xterm") const {
    Words words = kLong;
    words.insert(words.end(), options.begin(), options.end());
    const auto outcome =
        run(words, {.environment = {{"TERM", terminal}}, .interrupt_after = 3000ms, .on_terminal = on_terminal});
    EXPECT_EQ(outcome.status, 130) << outcome.error;
    return outcome.error.substr(0, outcome.error.find("lobe: interrupted"));
  }
};

TEST_F(Progress, IsOneLineWithStageShareRateAndTimeLeft) {
  const std::string text = shown({});

  EXPECT_THAT(text, HasSubstr("\rdaylight"));
  EXPECT_THAT(text, MatchesRegex("(.|\r)*\\] +[0-9]+ %  [0-9.e+-]+ %/s  [0-9:]+ left(.|\r)*"));
  EXPECT_THAT(text, Not(HasSubstr("\n")));
  EXPECT_THAT(text, ::testing::EndsWith(" \r")) << "the line is gone at the end";
}

TEST_F(Progress, IsLeftOutWhereItIsNotWanted) {
  EXPECT_THAT(shown({"--no-progress"}), IsEmpty());
  EXPECT_THAT(shown({"--quiet"}), IsEmpty());
  EXPECT_THAT(shown({"--json"}), IsEmpty());
}

TEST_F(Progress, IsLeftOutWhereALineCannotBeWrittenOver) {
  EXPECT_THAT(shown({}, false), IsEmpty());
  EXPECT_THAT(shown({}, true, "dumb"), IsEmpty());
}

TEST_F(Progress, LeavesATableOfStagesOnRequest) {
  const auto outcome = run({"gram", "phong:n=20", "ward:m=0.2", "--lighting", "point", "--lighting", "daylight", "-v"});

  EXPECT_EQ(outcome.status, 0);
  for (const char* part : {"stage ", "\npoint ", "\ndaylight ", "\ntotal ", "\npeak memory "}) {
    EXPECT_THAT(outcome.error, HasSubstr(part));
  }
  EXPECT_THAT(run({"gram", "lambert", "-v", "--quiet"}).error, IsEmpty());
}

TEST_F(Progress, ColoursErrorsOnTerminalsOnly) {
  const Words mistake{"norm", "wrad"};
  const auto with = [&](std::vector<std::pair<std::string, std::string>> environment, bool on_terminal = true) {
    return run(mistake, {.environment = std::move(environment), .on_terminal = on_terminal}).error;
  };
  EXPECT_THAT(with({{"TERM", "xterm"}, {"NO_COLOR", ""}}), HasSubstr("\x1b["));
  EXPECT_THAT(with({{"TERM", "xterm"}, {"NO_COLOR", "1"}}), Not(HasSubstr("\x1b[")));
  EXPECT_THAT(with({{"TERM", "dumb"}, {"NO_COLOR", ""}}), Not(HasSubstr("\x1b[")));
  EXPECT_THAT(with({{"TERM", "xterm"}, {"NO_COLOR", ""}}, false), Not(HasSubstr("\x1b[")));
}

}  // namespace
}  // namespace lobe::test
