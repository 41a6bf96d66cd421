// `mpirun lobe run`: however many ranks there are, the results have the bytes of a plain run, and one of them speaks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "cli/process.hpp"
#include "core/files.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using namespace std::chrono_literals;

using Words = std::vector<std::string>;

/// All kinds of units.
constexpr std::string_view kAll = R"([study]
name = "all"
lightings = ["point", "daylight", "patch:0.8", "material:lambert:scale=0.5"]
comparison_metrics = ["cube-root"]
approximations = ["non-negative"]
tolerance = 1e-3
patch_tolerance = 1e-2
comparison_tolerance = 1e-2
allow_unresolved = true
[[family]]
name = "Ward"
model = "ward"
m = [0.4, 0.400001, 0.5]
[[material]]
name = "grey"
model = "oren_nayar"
sigma = 0.5
adjustments = ["normalise"]
[[published]]
title = "Table 1"
quantity = "constant"
model = "blinn"
n = "$n"
columns = ["n", "printed", "corrected"]
rows = [[1, "0.350", ""], [2, "0.382", ""]]
[[chart]]
name = "albedos"
title = "Albedos"
quantity = "albedo"
curves = [{label = "Ward", model = "ward", m = 0.4}, {label = "Phong", model = "phong", n = 5}]
)";

/// Some seconds of work in many units, of which the last ones take longest.
constexpr std::string_view kLong = R"([study]
name = "long"
lightings = ["daylight", "point"]
tolerance = 1e-8
[[family]]
name = "Ward"
model = "ward"
m = {linspace = [0.1, 0.5], count = 24}
)";

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) found[fs::relative(entry.path(), folder)] = read_text(entry.path());
  }
  return found;
}

std::vector<std::string> names_of_different(const fs::path& one, const fs::path& other) {
  const auto ours = contents(one);
  const auto theirs = contents(other);
  std::vector<std::string> names;
  for (const auto& [name, bytes] : ours) {
    if (!theirs.contains(name) || theirs.at(name) != bytes) names.push_back(name);
  }
  for (const auto& [name, bytes] : theirs) {
    if (!ours.contains(name)) names.push_back(name);
  }
  return names;
}

class Mpi : public ::testing::Test {
 protected:
  Mpi() {
    // gnuplot, which draws what is compared, is not found.
    fs::create_directory(file("bin"));
    for (const char* tool : {"/usr/bin/ld", "/bin/sh", "/usr/bin/env"}) {
      if (fs::exists(tool)) fs::create_symlink(tool, file("bin") / fs::path(tool).filename());
    }
    std::ofstream(file("all.toml")) << kAll;
    std::ofstream(file("long.toml")) << kLong;
  }

  [[nodiscard]] fs::path file(const std::string& name) const { return directory_.path() / name; }
  [[nodiscard]] Surroundings surroundings() const {
    return {.directory = directory_.path(),
            .environment = {{"SOURCE_DATE_EPOCH", "1000000000"},
                            {"PATH", file("bin").string()},
                            // Several ranks on a processor, on this machine alone, and no lines of mpirun's own.
                            {"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                            {"OMPI_MCA_plm", "isolated"},
                            {"OMPI_MCA_orte_execute_quiet", "1"},
                            {"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                            {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"}}};
  }
  [[nodiscard]] Outcome run(const Words& arguments) const { return run_lobe(arguments, surroundings()); }
  [[nodiscard]] Outcome run_ranks(int ranks, Words arguments, const std::string& lobe = LOBE_COMMAND) const {
    arguments.insert(arguments.begin(), {LOBE_MPIRUN, "--noprefix", "-n", std::to_string(ranks), lobe});
    return run_program(arguments, surroundings());
  }
  /// Process of a rank of this test, as soon as there is one; 0: there is none within some time.
  [[nodiscard]] pid_t process_of(int rank) const {
    const std::string variable = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank);
    for (const auto end = Clock::now() + 20s; Clock::now() < end; std::this_thread::sleep_for(20ms)) {
      for (const auto& entry : fs::directory_iterator("/proc")) {
        std::error_code ignored;
        if (fs::read_symlink(entry.path() / "cwd", ignored) != fs::canonical(directory_.path())) continue;
        std::ifstream environment(entry.path() / "environ", std::ios::binary);
        for (std::string one; std::getline(environment, one, '\0');) {
          if (one == variable) return static_cast<pid_t>(std::stol(entry.path().filename()));
        }
      }
    }
    return 0;
  }
  /// How a run of three ranks ends, of which the last gets a signal once there is a checkpoint.
  [[nodiscard]] Outcome run_with_signal(int signal, milliseconds& after) const {
    auto ending = std::async(std::launch::async, [&] { return run_ranks(3, {"run", "long.toml", "-o", "out"}); });
    const auto is_over = [&] { return ending.wait_for(5ms) == std::future_status::ready; };
    // Found before there is a checkpoint: the study does not wait while one looks for it.
    const pid_t victim = process_of(2);
    EXPECT_GT(victim, 0);
    while (!fs::exists(file("out/long.checkpoint")) && !is_over()) {
    }
    EXPECT_FALSE(is_over()) << "the study is too short";
    const auto begin = Clock::now();
    if (victim > 0) ::kill(victim, signal);
    Outcome outcome = ending.get();
    after = std::chrono::duration_cast<milliseconds>(Clock::now() - begin);
    if (victim > 0) ::kill(victim, SIGKILL);
    return outcome;
  }
  /// PoCL may add that it was interrupted while it compiled.
  static void expect_one_line(const Outcome& outcome, const std::string& text) {
    const std::string lines = "\n" + outcome.error;
    const std::size_t first = lines.find("\nlobe: ");
    ASSERT_NE(first, std::string::npos) << outcome.error;
    EXPECT_EQ(lines.find("\nlobe: ", first + 1), std::string::npos) << outcome.error;
    EXPECT_THAT(lines.substr(first), HasSubstr(text));
    EXPECT_THAT(outcome.output, IsEmpty());
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(Mpi, ResultsHaveTheBytesOfAPlainRun) {
  const Words words{"run", "all.toml", "-o", "out"};
  const Outcome plain = run(words);
  ASSERT_EQ(plain.status, 0) << plain.error;
  fs::rename(file("out"), file("plain"));
  for (const int ranks : {1, 2, 3, 4}) {
    const Outcome outcome = run_ranks(ranks, words);
    EXPECT_EQ(outcome.status, 0) << ranks << " ranks: " << outcome.error;
    EXPECT_EQ(outcome.output, plain.output) << ranks << " ranks: one speaks, as a plain run does";
    EXPECT_EQ(outcome.error, plain.error) << ranks;
    EXPECT_THAT(names_of_different(file("plain"), file("out")), IsEmpty()) << ranks;
    fs::remove_all(file("out"));
  }
}

TEST_F(Mpi, RanksShareTheUnits) {
  const Outcome outcome = run_ranks(3, {"run", "all.toml", "-o", "out", "--verbose"});
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const std::size_t at = outcome.error.find("together: ");
  ASSERT_NE(at, std::string::npos) << outcome.error;
  EXPECT_GT(std::stoul(outcome.error.substr(at + std::string("together: ").size())), 0U) << "units of other ranks";
}

TEST_F(Mpi, AStudyThatDoesNotExistIsToldOnce) {
  const Outcome outcome = run_ranks(3, {"run", "none.toml", "-o", "out"});
  EXPECT_EQ(outcome.status, 3);
  expect_one_line(outcome, "cannot read none.toml");
  EXPECT_FALSE(fs::exists(file("out")));
}

TEST_F(Mpi, AMistakeOnTheCommandLineIsToldOnce) {
  const Outcome outcome = run_ranks(3, {"run", "all.toml", "--no-such-option"});
  EXPECT_EQ(outcome.status, 2);
  expect_one_line(outcome, "--no-such-option");
}

TEST_F(Mpi, ResultsThatAreThereAreLeftAlone) {
  fs::create_directory(file("out"));
  std::ofstream(file("out/all.h5")) << "results\n";
  const auto before = contents(file("out"));
  const Outcome outcome = run_ranks(2, {"run", "all.toml", "-o", "out"});
  EXPECT_EQ(outcome.status, 3);
  expect_one_line(outcome, "out/all.h5 exists");
  EXPECT_EQ(contents(file("out")), before);
}

TEST_F(Mpi, ADryRunWritesNothingAndIsToldOnce) {
  std::ofstream(file("tiny.toml")) << "[study]\nname = \"tiny\"\nlightings = [\"mean-albedo\"]\n"
                                      "[[family]]\nname = \"Phong\"\nmodel = \"phong\"\nn = [1, 2]\n";
  const Outcome outcome = run_ranks(2, {"run", "tiny.toml", "-o", "out", "--dry-run"});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  const std::size_t first = outcome.output.find("study       tiny");
  ASSERT_NE(first, std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("study       tiny", first + 1), std::string::npos);
  EXPECT_FALSE(fs::exists(file("out")));
}

// mpirun ends the others with a rank that has ended; with one that hangs, lobe does.
TEST_F(Mpi, ARankThatIsKilledEndsTheRunWhichGoesOnLater) {
  milliseconds after{};
  const Outcome killed = run_with_signal(SIGKILL, after);
  EXPECT_THAT(after, Lt(10s));
  EXPECT_NE(killed.status, 0);
  EXPECT_THAT(killed.error, HasSubstr("rank 2 of 3 (on "));
  expect_one_line(killed, "has ended before its work was done; give the same command again");
  EXPECT_TRUE(fs::exists(file("out/long.checkpoint")));
  EXPECT_FALSE(fs::exists(file("out/long.h5")));

  const Outcome resumed = run_ranks(2, {"run", "long.toml", "-o", "out"});
  EXPECT_EQ(resumed.status, 0) << resumed.error;
  EXPECT_THAT(resumed.error, HasSubstr("goes on from the results kept"));
  EXPECT_FALSE(fs::exists(file("out/long.checkpoint")));
  fs::rename(file("out"), file("resumed"));
  ASSERT_EQ(run({"run", "long.toml", "-o", "out"}).status, 0);
  EXPECT_THAT(names_of_different(file("out"), file("resumed")), IsEmpty());
}

TEST_F(Mpi, ARankThatIsKilledInTheMiddleOfATextIsToldInTheSameWords) {
  Surroundings patient = surroundings();
  // Seconds until mpirun kills the rank that tells.
  patient.environment.emplace_back("OMPI_MCA_odls_base_sigkill_timeout", "30");
  const Outcome outcome = run_program({LOBE_MPIRUN, "--noprefix", "-n", "2", LOBE_HALF_TEXT}, patient);
  EXPECT_THAT(outcome.error, ContainsRegex("rank 1 of 2 \\(on .+\\) has ended before its work was done"));
}

TEST_F(Mpi, ARankThatHangsEndsTheRunWhichGoesOnWithoutMpi) {
  milliseconds after{};
  const Outcome stopped = run_with_signal(SIGSTOP, after);
  EXPECT_THAT(after, Lt(10s));
  EXPECT_EQ(stopped.status, 4);
  expect_one_line(stopped, "has said nothing for ");

  const Outcome resumed = run({"run", "long.toml", "-o", "out"});
  EXPECT_EQ(resumed.status, 0) << resumed.error;
  EXPECT_THAT(resumed.error, HasSubstr("goes on from the results kept"));
  fs::rename(file("out"), file("resumed"));
  ASSERT_EQ(run({"run", "long.toml", "-o", "out"}).status, 0);
  EXPECT_THAT(names_of_different(file("out"), file("resumed")), IsEmpty());
}

TEST_F(Mpi, ACommandWithoutMpiSaysSoOnce) {
  if (std::string(LOBE_COMMAND) == LOBE_WITHOUT_MPI) GTEST_SKIP() << "lobe was built with MPI";
  const Outcome outcome = run_ranks(2, {"run", "all.toml", "-o", "out"}, LOBE_WITHOUT_MPI);
  EXPECT_EQ(outcome.status, 2);
  expect_one_line(outcome, "lobe was built without MPI; build it with LOBE_MPI=ON");
}

TEST_F(Mpi, ShardsAreComputedByWhoeverStartsThem) {
  const Outcome outcome = run_ranks(2, {"run", "all.toml", "--shard", "1/8", "--dry-run"});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, HasSubstr("shard 1/8 of all"));
}

}  // namespace
}  // namespace lobe::test
