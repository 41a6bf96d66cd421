// The library that stands before the OpenCL loader, and a program that it has to catch.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nets/opencl_failures.hpp"

namespace lobe::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(OpenclFailuresNet, CatchesAProgramThatLooksAtNoError) {
  const auto complaints = opencl_complaints({"careless_host", {LOBE_CARELESS_HOST}}, 1);

  for (const char* name : {"clBuildProgram", "clSetKernelArg", "clEnqueueNDRangeKernel", "clEnqueueReadBuffer"}) {
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
