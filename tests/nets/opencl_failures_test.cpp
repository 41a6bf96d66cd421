// OpenCL calls that fail, every entry point at several calls: one line, exit status 4, nothing half-done.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <ostream>

#include "nets/opencl_failures.hpp"

namespace lobe::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Case {
  Job job;
  Calls calls = Calls::ends;
};

/// GoogleTest shows a case by its name.
std::ostream& operator<<(std::ostream& stream, const Case& one) {
  return stream << one.job.name;
}

Case lobe(const std::string& name, Calls calls, std::vector<std::string> words, Files inputs = {}) {
  words.insert(words.begin(), LOBE_COMMAND);
  return {{name, std::move(words), std::move(inputs)}, calls};
}

const char* const kStudy =
    "[study]\nname = \"s\"\nlightings = [\"point\"]\n"
    "[[family]]\nname = \"P\"\nmodel = \"phong\"\nn = [2, 3]\n";

/// Between them they use every entry point and every kernel.
const std::vector<Case>& cases() {
  static const std::vector<Case> kCases{
      lobe("devices", Calls::ends, {"devices"}),
      lobe("norm", Calls::inside, {"norm", "phong:n=5"}),
      lobe("patch_norm", Calls::ends, {"norm", "phong:n=2", "--lighting", "patch:0.7", "--tolerance", "1e-2"}),
      lobe("tabulate", Calls::ends, {"tabulate", "phong:n=3", "--grid", "gauss:8x16", "-o", "t.h5"}),
      lobe("compose", Calls::inside, {"compose", "phong:n=3", "lambert", "--grid", "gauss:8x16", "-o", "c.h5"}),
      lobe("sample", Calls::ends, {"sample", "phong:n=3", "--theta", "30", "-n", "3"}),
      lobe("preview", Calls::inside, {"preview", "lambert", "--size", "16", "-o", "p.png"}),
      lobe("export", Calls::ends, {"export", "phong:n=3", "--format", "csv", "-o", "e.csv"}),
      lobe("run", Calls::inside, {"run", "s.toml", "-o", "out"}, {{"s.toml", kStudy}})};
  return kCases;
}

/// For script/soak, which has the time.
std::vector<Case> more_cases() {
  return {
      lobe("daylight_product", Calls::ends, {"product", "phong:n=5", "ward:m=0.5", "--lighting", "daylight"}),
      lobe("single_precision", Calls::ends, {"gram", "phong:n=3", "lambert", "--precision", "single"}),
      lobe("comparison", Calls::ends, {"run", "s.toml", "-o", "out"},
           {{"s.toml",
             "[study]\nname = \"s\"\nlightings = [\"point\"]\ncomparison_metrics = [\"ngan-l2\"]\n"
             "comparison_tolerance = 0.1\n[[family]]\nname = \"P\"\nmodel = \"phong\"\nn = [2, 3]\n"}}),
      lobe("albedo", Calls::ends, {"albedo", "phong:n=3+lambert:scale=0.2", "--theta", "30"}),
      lobe("eval", Calls::ends,
           {"eval", "oren_nayar:sigma=0.3", "--theta-in", "0", "--theta-out", "0", "--delta-phi", "0"}),
      lobe("compose_anisotropic", Calls::ends,
           {"compose", "ward_anisotropic:m_x=0.6,m_y=0.9", "phong:n=2", "--grid", "gauss:8x16", "-o", "c.h5"}),
      lobe("compose_at", Calls::ends, {"compose", "phong:n=3", "lambert", "--at", "30,30,0", "--tolerance", "1e-3"}),
      lobe("approximate", Calls::ends,
           {"approximate", "phong:n=3", "-b", "lambert", "-b", "phong:n=2", "-o", "a.toml"})};
}

std::vector<Case> chosen_cases() {
  std::vector<Case> all = cases();
  if (std::getenv("LOBE_NETS") != nullptr) std::ranges::move(more_cases(), std::back_inserter(all));
  return all;
}

class OpenclFailures : public ::testing::TestWithParam<Case> {};

TEST_P(OpenclFailures, AreOneLineAndAnExitStatus) {
  EXPECT_THAT(opencl_complaints(GetParam().job, GetParam().calls), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Commands, OpenclFailures, ::testing::ValuesIn(chosen_cases()),
                         [](const auto& test) { return test.param.job.name; });

TEST(OpenclFailuresNet, CatchesAProgramThatLooksAtNoError) {
  const auto complaints = opencl_complaints({"careless_host", {LOBE_CARELESS_HOST}}, Calls::ends);

  for (const char* name : {"clBuildProgram", "clSetKernelArg", "clEnqueueNDRangeKernel", "clEnqueueReadBuffer"}) {
    SCOPED_TRACE(name);
    EXPECT_THAT(complaints, Contains(HasSubstr(std::string(name) + ":1 of")));
  }
}

TEST(OpenclShim, CountsTheCallsOfTheSource) {
  const auto ending = run_job({"careless_host", {LOBE_CARELESS_HOST}}, LOBE_OPENCL_SHIM, "LOBE_CL_LOG");

  EXPECT_EQ(ending.outcome.output, "12\n") << ending.outcome.error;
  EXPECT_EQ(std::ranges::count(ending.events, "clSetKernelArg"), 2);
  EXPECT_EQ(std::ranges::count(ending.events, "clEnqueueReadBuffer"), 1);
}

TEST(OpenclShim, PerturbsWhatAProgramComputes) {
  const auto perturbed = [](const std::string& source) {
    const auto ending = run_job({"careless_host", {LOBE_CARELESS_HOST}}, LOBE_OPENCL_SHIM, "LOBE_CL_PERTURB_LOG",
                                {{"LOBE_CL_PERTURB", "0.25"}, {"LOBE_CL_PERTURB_SOURCE", source}});
    return std::pair(ending.outcome.output, ending.events);
  };
  EXPECT_EQ(perturbed("").first, "15\n");
  EXPECT_EQ(perturbed("void sum(").first, "15\n");
  EXPECT_EQ(perturbed("void sum(").second, std::vector<std::string>{"clEnqueueReadBuffer 8"});
  EXPECT_EQ(perturbed("void product(").first, "12\n");
}

}  // namespace
}  // namespace lobe::test
