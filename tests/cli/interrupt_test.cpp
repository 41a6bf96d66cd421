// Ctrl-C: long work ends within a second, says so, and leaves nothing half-written.
#include <sys/stat.h>

#include <fstream>
#include <ostream>

#include "cli/command_test.hpp"
#include "core/files.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::Not;
using namespace std::chrono_literals;

// The command gives work 0.7 s to end by itself; the rest is for a busy machine.
constexpr auto kPatience = 1500ms;

struct LongWork {
  std::string name;
  Words words;
};

/// GoogleTest shows a case by its name.
std::ostream& operator<<(std::ostream& stream, const LongWork& work) {
  return stream << work.name;
}

/// Each takes many seconds.
const std::vector<LongWork>& long_work() {
  static const std::vector<LongWork> kWork{
      {"run", {"run", "long.toml", "-o", "out"}},
      {"shard", {"run", "long.toml", "--shard", "1/1", "-o", "out"}},
      {"distance_matrix",
       {"distance-matrix", "long.toml", "--lighting", "patch:0.3", "--tolerance", "1e-9", "-o", "d.csv"}},
      {"gram", {"gram", "long.toml", "--lighting", "patch:0.3", "--tolerance", "1e-9"}},
      {"compose",
       {"compose", "ward_anisotropic:m_x=0.3,m_y=0.4", "ward_anisotropic:m_x=0.4,m_y=0.3", "--grid", "gauss:48x96",
        "-o", "c.h5"}},
      {"tabulate", {"tabulate", "ward:m=0.2", "--grid", "gauss:512x1024", "-o", "t.h5"}},
      {"import", {"import", "flat.csv", "--grid", "gauss:384x768", "-o", "i.h5"}},
      {"fit", {"fit", "cook_torrance:m=0.3", "--family", "lambert+ggx", "--objective", "perceptual", "-o", "f.toml"}},
      {"spectrum", {"spectrum", "ward_anisotropic:m_x=0.3,m_y=0.4", "--grid", "gauss:48x96"}},
      {"sample", {"sample", "ggx:alpha=0.2", "--theta", "45", "-n", "10000000", "-o", "s.csv"}},
      {"render",
       {"render", LOBE_STUDIES_DIRECTORY "/../examples/scenes/plastic.toml", "--samples", "1000000", "-o", "p.png"}},
      {"check", {"check", "--catalogue"}}};
  return kWork;
}

class Interrupt : public CommandTest, public ::testing::WithParamInterface<LongWork> {
 protected:
  void SetUp() override {
    std::ofstream(file("long.toml"))
        << "[study]\nlightings = [\"patch:0.3\"]\npatch_tolerance = 1e-9\n[[family]]\n"
           "name = \"Ward\"\nmodel = \"ward\"\nm = {linspace = [0.01, 0.02], count = 12}\n";
    // Zernike coefficients of a Lambertian surface.
    std::ofstream(file("flat.csv")) << "1, 1, 0, 0, 0, 0, 0, 1\n";
  }
};

TEST_P(Interrupt, EndsWorkWithinASecondAndLeavesNothing) {
  // One of them by the other signal.
  const bool is_sigterm = GetParam().name == "gram";
  const auto outcome = run(GetParam().words, {.interrupt_after = 1200ms, .signal = is_sigterm ? SIGTERM : SIGINT});

  EXPECT_EQ(outcome.status, is_sigterm ? 143 : 130) << outcome.error;
  EXPECT_THAT(outcome.after_signal, Lt(kPatience));
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_THAT(outcome.error, HasSubstr("lobe: interrupted; "));
  for (const auto& name : files()) EXPECT_THAT(name, ::testing::AnyOf("long.toml", "flat.csv", "out"));
  EXPECT_TRUE(!std::filesystem::exists(file("out")) || std::filesystem::is_empty(file("out")));
}

INSTANTIATE_TEST_SUITE_P(Commands, Interrupt, ::testing::ValuesIn(long_work()),
                         [](const auto& test) { return test.param.name; });

using Waiting = CommandTest;

TEST_F(Waiting, IsInterruptedWhereItWaitsForAFile) {
  ASSERT_EQ(::mkfifo(file("s.toml").c_str(), 0600), 0);

  const auto outcome = run({"run", "s.toml", "-o", "out"}, {.interrupt_after = 300ms});

  EXPECT_EQ(outcome.status, 130) << outcome.error;
  EXPECT_THAT(outcome.after_signal, Lt(kPatience));
  EXPECT_THAT(outcome.error, HasSubstr("lobe: interrupted; "));
}

using Drawing = CommandTest;

TEST_F(Drawing, IsInterruptedWithTheNumbersComplete) {
  std::ofstream(file("s.toml")) << "[study]\nname = \"s\"\nlightings = [\"point\", \"daylight\", \"mean-albedo\"]\n"
                                   "[[family]]\nname = \"Ward\"\nmodel = \"ward\"\nm = [0.1, 0.2, 0.3, 0.4]\n";

  const auto interrupted =
      run({"run", "s.toml", "-o", "out"}, {.interrupt_when = file("out/.s.unfinished/s.point.distance.png")});

  EXPECT_EQ(interrupted.status, 130) << interrupted.error;
  EXPECT_THAT(interrupted.error, HasSubstr("the numbers are complete in out/s.h5; pictures left out: interrupted"));
  make({"report", "out/s.h5"});
  EXPECT_TRUE(std::filesystem::exists(file("out/s.mean-albedo.map.gp")));
  EXPECT_FALSE(std::filesystem::exists(file("out/s.mean-albedo.map.png")));
  for (const auto& entry : std::filesystem::directory_iterator(file("out"))) {
    EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
  }
}

using Together = CommandTest;

TEST_F(Together, OneOfSixCommandsWritesAFile) {
  (void)run_line(
      "for i in 1 2 3 4 5 6; do (lobe tabulate ward:m=0.2 --grid gauss:16x32 -o t.h5 >out.$i 2>err.$i; echo $? "
      ">>codes) & done; wait",
      {.directory = file(".")});

  int written = 0;
  for (int k = 1; k <= 6; ++k) {
    SCOPED_TRACE(k);
    const std::string error = read_text(file("err." + std::to_string(k)));
    if (error.empty()) {
      ++written;
    } else {
      EXPECT_THAT(error, ::testing::AnyOf(HasSubstr("t.h5 is being written by"), HasSubstr("t.h5 exists")));
    }
  }
  EXPECT_EQ(written, 1);
  make({"info", "t.h5"});
  EXPECT_FALSE(std::filesystem::exists(file(".t.h5.lock")));
}

TEST_F(Together, ARefusedRunLeavesTheResultsOfAnotherOne) {
  std::ofstream(file("s.toml")) << "[study]\nname = \"s\"\nlightings = [\"point\"]\n"
                                   "[[family]]\nname = \"Ward\"\nmodel = \"ward\"\nm = [0.1, 0.2, 0.3]\n";
  for (int round = 0; round < 3; ++round) {
    SCOPED_TRACE(round);
    const std::string name = "out" + std::to_string(round);
    const auto outcome = run_line("lobe run s.toml -o " + name + " >/dev/null 2>one & lobe run s.toml -o " + name +
                                      " >/dev/null 2>two; wait; cat one two",
                                  {.directory = file(".")});
    EXPECT_THAT(outcome.error, IsEmpty());
    EXPECT_THAT(outcome.output, ::testing::AnyOf(HasSubstr("is being written by"), HasSubstr(" exists; ")));
    make({"report", name + "/s.h5", "-o", name + ".html"});
    EXPECT_TRUE(std::filesystem::exists(file(name + "/s.point.distance.csv")));
    EXPECT_TRUE(std::filesystem::exists(file(name + "/s.point.map.png")));
  }
}

using Killed = CommandTest;

TEST_F(Killed, CommandsGoOnWhenGivenAgain) {
  std::ofstream(file("s.toml")) << "[study]\nname = \"s\"\nlightings = [\"point\", \"daylight\"]\n"
                                   "[[family]]\nname = \"Ward\"\nmodel = \"ward\"\nm = [0.1, 0.2, 0.3]\n";
  const std::vector<Words> all{{"run", "s.toml", "-o", "out"},
                               {"tabulate", "ward:m=0.2", "--grid", "gauss:16x32", "-o", "t.h5"},
                               {"export", "phong:n=5", "--format", "csv", "-o", "p.csv"}};
  for (const Words& words : all) {
    // From before anything is written to after everything is.
    for (auto after = 50ms; after < 1300ms; after += 190ms) {
      (void)run(words, {.interrupt_after = after, .signal = SIGKILL});
      for (const char* name : {"out/s.h5", "t.h5"}) {
        if (std::filesystem::exists(file(name))) make({"info", name});
      }
    }
    const auto last = run(words);
    EXPECT_TRUE(last.status == 0 || last.error.find("exists; use --force") != last.error.npos) << last.error;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(file("."))) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(name.front() != '.' && name.find(".tmp-") == name.npos) << entry.path();
    }
  }
}

using Streams = CommandTest;

TEST_F(Streams, TakeFilesThatAreAskedFor) {
  const auto piped = run_line(
      "lobe sample lambert --theta 30 -n 5 -o - | wc -l; lobe sample lambert --theta 30 -n 5 "
      "-o /dev/stdout >there.csv; wc -l <there.csv",
      {.directory = file(".")});
  EXPECT_EQ(piped.output, "6\n6\n") << piped.error;
  const auto exported = run_line("lobe export lambert --format csv -o - | head -1", {.directory = file(".")});
  EXPECT_THAT(exported.output, HasSubstr("# reflectance in sr^-1")) << exported.error;
  EXPECT_THAT(exported.error, IsEmpty()) << "head has seen enough";
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  const auto fifo = run_line("cat pipe >from & lobe sample lambert --theta 30 -n 5 -o pipe --force; wait; wc -l <from",
                             {.directory = file(".")});
  EXPECT_EQ(fifo.output, "6\n") << fifo.error;
  EXPECT_TRUE(std::filesystem::is_fifo(file("pipe")));
}

TEST_F(Streams, TakeTables) {
  const auto piped = run_line(
      "lobe tabulate lambert --grid gauss:4x8 -o - | cat >piped.h5 && lobe verify piped.h5; "
      "lobe tabulate lambert --grid gauss:4x8 --json -o /dev/stdout 2>said | cat >json.h5 && lobe verify json.h5",
      {.directory = file(".")});
  EXPECT_THAT(piped.output, HasSubstr("piped.h5: sound"));
  EXPECT_THAT(piped.output, HasSubstr("json.h5: sound"));
  EXPECT_THAT(piped.error, Not(HasSubstr("error: ")));
  EXPECT_THAT(read_text(file("said")), HasSubstr("\"file\": \"/dev/stdout\""));
}

using Resume = CommandTest;

TEST_F(Resume, TakesWhatAnInterruptedRunHasKept) {
  // Patch lights of lobes this narrow take seconds each.
  const std::string study =
      "[study]\nname = \"s\"\npatch_tolerance = 1e-7\nlightings = [\"patch:0.5\", \"patch:0.3\"]\n"
      "[[family]]\nname = \"Ward\"\nmodel = \"ward\"\nm = {linspace = [0.05, 0.06], count = 3}\n";
  std::ofstream(file("s.toml")) << study;
  const Words words{"run", "s.toml", "-o", "out"};

  const auto interrupted = run(words, {.interrupt_when = file("out/s.checkpoint")});
  ASSERT_EQ(interrupted.status, 130) << interrupted.error;
  EXPECT_THAT(interrupted.error, HasSubstr("results kept: "));
  EXPECT_THAT(interrupted.error, HasSubstr("out/s.checkpoint; the same command goes on from there"));
  EXPECT_TRUE(std::filesystem::exists(file("out/s.checkpoint")));

  const auto resumed = make(words);
  EXPECT_THAT(resumed.error, HasSubstr("lobe: goes on from the results kept: "));
  EXPECT_FALSE(std::filesystem::exists(file("out/s.checkpoint"))) << "complete: no longer needed";

  const auto whole = make({"run", "s.toml", "-o", "whole", "--no-checkpoint"});
  EXPECT_THAT(whole.error, IsEmpty());
  for (const char* name : {"s.patch-0.5.distance.csv", "s.patch-0.3.distance.csv"}) {
    EXPECT_EQ(read_text(file(std::string("out/") + name)), read_text(file(std::string("whole/") + name))) << name;
  }
}

}  // namespace
}  // namespace lobe::test
