// Bad input: one line on standard error that says what and what to do, the right exit status, nothing on standard
// output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <ostream>

#include "cli/process.hpp"
#include "interface/exit_code.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

struct FailureCase {
  std::string name;
  Words arguments;
  ExitCode code = ExitCode::usage;
  std::string message;  ///< a part of it
  std::vector<std::pair<std::string, std::string>> environment = {};
};

/// GoogleTest shows a case by its name.
std::ostream& operator<<(std::ostream& stream, const FailureCase& failure) {
  return stream << failure.name;
}

const Words kEval{"eval", "lambert", "--theta-in", "0", "--theta-out", "0", "--delta-phi", "0"};

const std::vector<FailureCase>& failure_cases() {
  static const std::vector<FailureCase> kCases{
      {"no_command", {}, ExitCode::usage, "no command given; see 'lobe --help'"},
      {"unknown_command", {"distence"}, ExitCode::usage, "did you mean 'distance'?"},
      {"unknown_option",
       {"distance", "--lightnig", "point", "lambert", "lambert"},
       ExitCode::usage,
       "did you mean '--lighting'?"},
      {"option_of_a_command_before_it", {"--json", "devices"}, ExitCode::usage, "after the command's name"},
      {"option_without_value",
       {"distance", "lambert", "lambert", "--lighting"},
       ExitCode::usage,
       "option --lighting needs a value"},
      {"option_instead_of_value",
       {"distance", "lambert", "lambert", "--lighting", "--json"},
       ExitCode::usage,
       "option --lighting needs a value, LIGHTING"},
      {"unknown_choice",
       {"distance", "lambert", "lambert", "--lighting", "pont"},
       ExitCode::usage,
       "did you mean 'point'?"},
      {"missing_argument", {"distance", "lambert"}, ExitCode::usage, "'lobe distance' needs B"},
      {"missing_option",
       {"eval", "lambert", "--theta-in", "0", "--theta-out", "0"},
       ExitCode::usage,
       "needs --delta-phi"},
      {"too_many_arguments",
       {"distance", "lambert", "lambert", "ward:m=1"},
       ExitCode::usage,
       "too many arguments, from 'ward:m=1' on"},
      {"no_number", {"albedo", "lambert", "--theta", "0,1x"}, ExitCode::usage, "'1x' in --theta is not a number"},
      {"angle_out_of_range", {"albedo", "lambert", "--theta", "90"}, ExitCode::usage, "less than 90 degrees"},
      {"nothing_to_compute", {"albedo", "lambert"}, ExitCode::usage, "or --mean, or --plot"},
      {"tolerance_out_of_range",
       {"distance", "lambert", "lambert", "--tolerance", "0"},
       ExitCode::usage,
       "--tolerance 0 is out of range"},
      {"nothing_to_check", {"check"}, ExitCode::usage, "give materials or tables, or --catalogue"},
      {"materials_beside_the_catalogue", {"check", "lambert", "--catalogue"}, ExitCode::usage, "give no materials"},
      {"unknown_model", {"models", "wrad"}, ExitCode::usage, "unknown model 'wrad'; did you mean 'ward'?"},
      {"unknown_model_in_material", {"distance", "lambert", "phnog:n=1"}, ExitCode::usage, "did you mean 'phong'?"},
      {"unknown_parameter", {"distance", "lambert", "oren_nayar:sigmo=1"}, ExitCode::usage, "did you mean 'sigma'?"},
      {"value_out_of_range", {"distance", "lambert", "ward:m=-1"}, ExitCode::usage, "'m' of model 'ward' is -1"},
      {"missing_parameter", {"distance", "lambert", "ward"}, ExitCode::usage, "needs the parameter 'm'"},
      {"adjusted_anisotropic_model",
       {"mean-albedo", "ward_anisotropic:m_x=0.2,m_y=0.4@normalise"},
       ExitCode::numeric,
       "contains the anisotropic model 'ward_anisotropic'; expected isotropic ones for the adjustment 'normalise'"},
      {"negative_value_of_a_density",
       {"norm", "lambert", "--lighting", "density:0=1,1=-1"},
       ExitCode::usage,
       "value -1 of a density of patch lights is negative or not finite; expected 0 or more"},
      {"azimuth_without_angle",
       {"albedo", "lambert", "--mean", "--azimuth", "30"},
       ExitCode::usage,
       "give these by --theta"},
      {"missing_study", {"run", "absent.toml"}, ExitCode::file, "cannot read absent.toml: No such file"},
      {"missing_material_file", {"distance", "lambert", "absent.toml"}, ExitCode::file, "cannot read absent.toml"},
      {"unknown_device", {"distance", "lambert", "lambert", "--device", "nonsuch"}, ExitCode::device, "'nonsuch'"},
      {"no_device", kEval, ExitCode::device, "no OpenCL device found; install", {{"OCL_ICD_VENDORS", "/nonexistent"}}},
      {"no_device_to_list",
       {"devices"},
       ExitCode::device,
       "no OpenCL device found; install",
       {{"OCL_ICD_VENDORS", "/nonexistent"}}},
      {"kernel_cache_is_a_file", kEval, ExitCode::device, "POCL_CACHE_DIR", {{"POCL_CACHE_DIR", "/etc/passwd"}}},
      {"kernel_cache_cannot_be_made", kEval, ExitCode::device, "; ", {{"POCL_CACHE_DIR", "/proc/1/none"}}},
      {"kernel_cache_without_a_name",
       kEval,
       ExitCode::device,
       "POCL_CACHE_DIR is empty; expected a directory",
       {{"POCL_CACHE_DIR", ""}}}};
  return kCases;
}

void expect_one_line(const Outcome& outcome, ExitCode code) {
  EXPECT_EQ(outcome.status, static_cast<int>(code)) << outcome.error;
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_THAT(outcome.error, StartsWith("lobe: error: "));
  EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("; ")) << "says what to do";
  EXPECT_THAT(outcome.error, Not(HasSubstr("std::")));
}

class Failure : public ::testing::TestWithParam<FailureCase> {};

TEST_P(Failure, IsOneLineAndAnExitStatus) {
  const auto outcome = run_lobe(GetParam().arguments, {.environment = GetParam().environment});

  expect_one_line(outcome, GetParam().code);
  EXPECT_THAT(outcome.error, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(Inputs, Failure, ::testing::ValuesIn(failure_cases()),
                         [](const auto& test) { return test.param.name; });

TEST(ExitStatus, HasTheDocumentedNumbers) {
  EXPECT_EQ(static_cast<int>(ExitCode::success), 0);
  EXPECT_EQ(static_cast<int>(ExitCode::negative), 1);
  EXPECT_EQ(static_cast<int>(ExitCode::usage), 2);
  EXPECT_EQ(static_cast<int>(ExitCode::file), 3);
  EXPECT_EQ(static_cast<int>(ExitCode::device), 4);
  EXPECT_EQ(static_cast<int>(ExitCode::numeric), 5);
  EXPECT_EQ(static_cast<int>(ExitCode::interrupted), 130);
}

TEST(ExitStatus, IsNegativeWhereADistanceIsAboveTheLimit) {
  EXPECT_EQ(run_lobe({"distance", "lambert", "phong:n=3", "--fail-above", "0.9"}).status, 0);
  EXPECT_EQ(run_lobe({"distance", "lambert", "phong:n=3", "--fail-above", "0.8"}).status, 1);
  EXPECT_EQ(run_lobe({"distance", "lambert", "phong:n=3", "--fail-above", "0.8", "--json"}).status, 1);
}

TEST(ExitStatus, IsNumericWhereAQuantityDoesNotExist) {
  // sides.
  const auto outcome = run_lobe({"distance", "lafortune:c_xy=10,c_z=10,n=1e5", "lambert"});

  expect_one_line(outcome, ExitCode::numeric);
}

/// Libraries that end the process: their own words, then a line of ours.
class EndedProcess : public ::testing::Test {
 protected:
  void expect_device_error(const Outcome& outcome) const {
    EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::device)) << outcome.error;
    EXPECT_THAT(outcome.output, IsEmpty());
    const auto last = outcome.error.rfind('\n', outcome.error.size() - 2);
    EXPECT_THAT(outcome.error.substr(last == std::string::npos ? 0 : last + 1),
                ::testing::AllOf(StartsWith("lobe: error: "), HasSubstr("POCL_CACHE_DIR"), HasSubstr("; ")))
        << outcome.error;
  }
  [[nodiscard]] std::string cache() const { return (directory_.path() / "cache").string(); }

  TemporaryDirectory directory_;
};

TEST_F(EndedProcess, WhereAKernelCannotBeWritten) {
  // As on a full disk.
  expect_device_error(run_lobe(kEval, {.environment = {{"POCL_CACHE_DIR", cache()}}, .largest_file_bytes = 4096}));
}

TEST_F(EndedProcess, WithoutALinker) {
  expect_device_error(run_lobe(kEval, {.environment = {{"POCL_CACHE_DIR", cache()}, {"PATH", "/nonexistent"}}}));
}

TEST(KernelCache, IsFilledWithoutAWord) {
  const TemporaryDirectory directory;
  const Outcome outcome = run_lobe(kEval, {.environment = {{"POCL_CACHE_DIR", (directory.path() / "cache").string()}}});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.error, "") << "compilers count their warnings";
}

TEST(Memory, BeyondALimitIsRefusedBeforehand) {
  const auto outcome =
      run_line("ulimit -v 1500000; lobe tabulate ward_anisotropic:m_x=0.5,m_y=0.7 --grid gauss:96x192 --dense -o t.h5");

  EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::numeric)) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("this takes about"));
  EXPECT_THAT(outcome.error, HasSubstr("that the limit on this process (ulimit -v) leaves; use a smaller grid"));
}

TEST(Memory, DriversMayBeMissingForWantOfAddresses) {
  const auto outcome = run_line("ulimit -v 2048000; OCL_ICD_VENDORS=/nonexistent lobe devices");

  expect_one_line(outcome, ExitCode::device);
  EXPECT_THAT(outcome.error, HasSubstr("the process may use 2000 MiB of addresses (ulimit -v)"));
}

TEST(StandardOutput, FullDiskIsAFileError) {
  const auto outcome = run_lobe({"models"}, {.output = "/dev/full"});

  expect_one_line(outcome, ExitCode::file);
  EXPECT_THAT(outcome.error, HasSubstr("No space left"));
}

TEST(StandardOutput, ReaderThatHasGoneIsSuccess) {
  EXPECT_EQ(run_line("{ lobe models; echo $? >&2; } | true").error, "0\n");
}

TEST(StandardOutput, ClosedIsAFileError) {
  const auto outcome = run_line("lobe models >&-");

  expect_one_line(outcome, ExitCode::file);
  EXPECT_THAT(outcome.error, HasSubstr("cannot write to standard output: it is closed"));
}

TEST(Infinity, IsNoAnswer) {
  const TemporaryDirectory directory;
  const std::string huge = "lafortune:c_xy=-5,c_z=5,n=1e10";
  std::ofstream(directory.path() / "pairs.csv") << "theta_in,theta_out,delta_phi\n10,20,30\n30,30,180\n";
  const std::vector<Words> all{{"eval", huge, "--theta-in", "30", "--theta-out", "30", "--delta-phi", "180"},
                               {"eval", huge, "--pairs", "pairs.csv"},
                               {"tabulate", huge, "--grid", "gauss:8x16", "--allow-unresolved", "-o", "t.h5"},
                               {"sample", huge, "--theta", "30", "-n", "3"},
                               {"albedo", huge, "--theta", "30"}};
  for (const Words& words : all) {
    const auto outcome = run_lobe(words, {.directory = directory.path()});
    expect_one_line(outcome, ExitCode::numeric);
    EXPECT_THAT(outcome.error, HasSubstr("no finite number")) << words.front();
  }
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "t.h5"));
}

TEST(BuildFailure, KeepsTheCompilersLogInANamedFile) {
  const TemporaryDirectory directory;
  const Words arguments = kEval;

  const auto outcome =
      run_lobe(arguments, {.environment = {{"POCL_CACHE_DIR", "/etc/passwd"}, {"TMPDIR", directory.path().string()}}});

  const auto at = outcome.error.find(directory.path().string());
  ASSERT_NE(at, std::string::npos) << outcome.error;
  const auto path = outcome.error.substr(at, outcome.error.find_first_of(" \n", at) - at);
  EXPECT_TRUE(std::filesystem::exists(path)) << path;
}

TEST(Formula, ThatCannotBeReadIsReportedAtTheUsersLine) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "mine.toml";
  std::ofstream(path) << "model = \"custom\"\nformula = \"\"\"\nrho / pi\n  * cosine_i\n\"\"\"\nrho = 0.5\n";

  const auto outcome = run_lobe({"albedo", path.string(), "--theta", "0"});

  EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::usage));
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_THAT(outcome.error, HasSubstr(path.string() + ":4:5: unknown name 'cosine_i'; known: rho, cos_i"));
}

}  // namespace
}  // namespace lobe::test
