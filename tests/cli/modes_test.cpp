// lobe modes: numbers for solvers of radiative transfer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <string>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;

class ModesCommand : public CommandTest {};

TEST_F(ModesCommand, PrintsModesWithTheirErrors) {
  const auto outcome = make({"modes", "lambert:scale=0.5", "--cosines", "0.25,0.75", "--modes", "2"});
  EXPECT_THAT(outcome.output, HasSubstr("mode"));
  EXPECT_THAT(outcome.output, HasSubstr("0.159154943"));
  EXPECT_EQ(std::ranges::count(outcome.output, '\n'), 1 + 2 * 4);
}

TEST_F(ModesCommand, AnswersInJson) {
  const Json answer = json({"modes", "phong:n=4", "--cosines", "4", "--cosines-in", "0.5", "--modes", "3"});
  EXPECT_EQ(answer["schema"], "lobe.modes/1");
  EXPECT_EQ(answer["convention"], "brdf");
  ASSERT_EQ(answer["modes"].size(), 1U);
  ASSERT_EQ(answer["modes"][0].size(), 3U);
  ASSERT_EQ(answer["modes"][0][0].size(), 4U);
  ASSERT_EQ(answer["modes"][0][0][0].size(), 1U);
  EXPECT_EQ(answer["tolerance"], 1e-8);
  EXPECT_EQ(answer["reached_tolerance"], true);
  double weights = 0;
  for (const Json& weight : answer["weights_out"]) weights += weight.get<double>();
  EXPECT_NEAR(weights, 1, 1e-14);
  const Json disort =
      json({"modes", "phong:n=4", "--cosines", "4", "--cosines-in", "0.5", "--modes", "3", "--convention", "disort"});
  EXPECT_NEAR(disort["modes"][0][1][2][0].get<double>(),
              -2 * std::numbers::pi * answer["modes"][0][1][2][0].get<double>(), 1e-14);
}

TEST_F(ModesCommand, TakesANumberOfNodesOrCosines) {
  EXPECT_EQ(json({"modes", "lambert", "--cosines", "1"})["cosines_in"], Json::array({0.5}));
  const Json normal = json({"modes", "lambert", "--cosines", "1.0", "--cosines-in", "2"});
  EXPECT_EQ(normal["cosines_out"], Json::array({1.0}));
  EXPECT_EQ(normal["weights_in"].size(), 2U);
  EXPECT_FALSE(normal.contains("weights_out"));
}

TEST_F(ModesCommand, WritesFilesThatVerifyKnows) {
  const auto outcome = make({"modes", "phong:n=4", "--cosines", "4", "-o", "m.h5"});
  EXPECT_THAT(outcome.output, HasSubstr("left out"));
  make({"verify", "m.h5"});
  const Json described = json({"info", "m.h5"});
  EXPECT_EQ(described["file_schema"], "lobe-modes/1");
  EXPECT_EQ(described["attributes"]["material"], "phong:n=4");
  EXPECT_THAT(make({"info", "m.h5"}).output, ::testing::ContainsRegex("\nmodes_error +1 x [0-9]+ x 4 x 4, "));
  expect_refusal({"modes", "phong:n=4", "-o", "m.h5"}, ExitCode::file, "--force");
  make({"modes", "phong:n=4", "--cosines", "4", "-o", "m.npy"});
  EXPECT_GE(std::filesystem::file_size(file("m.npy")), 16U * 16 * 8);
}

TEST_F(ModesCommand, RefusesInOneLine) {
  expect_refusal({"modes", "lambert", "--cosines", "0.5,0.2"}, ExitCode::usage, "does not rise");
  expect_refusal({"modes", "lambert", "--cosines", "0.5,0.5"}, ExitCode::usage, "does not rise");
  for (const char* count : {"0", "1001", "99999999999999999999999"}) {
    expect_refusal({"modes", "lambert", "--cosines", count}, ExitCode::usage,
                   "--cosines " + std::string(count) + "; expected 1 to 1000");
  }
  expect_refusal({"modes", "lambert", "--cosines", "0.5,2"}, ExitCode::usage, "expected numbers from 1e-6 to 1");
  expect_refusal({"modes", "lambert", "--cosines", "1000", "--modes", "40"}, ExitCode::usage, "40000000 numbers");
  for (const char* count : {"0", "513"}) {
    expect_refusal({"modes", "lambert", "--modes", count}, ExitCode::usage,
                   "--modes " + std::string(count) + " is out of range; expected a whole number from 1 to 512");
  }
  expect_refusal({"modes", "lambert", "-o", "m.csv"}, ExitCode::usage, ".h5, .nc or .npy");
  expect_refusal({"modes", "mirror"}, ExitCode::usage, "has delta parts");
  expect_refusal({"modes", "basic_patch:R=0.5", "--modes", "2", "--cosines", "4", "--tolerance", "1e-13", "--strict"},
                 ExitCode::numeric, "modes at cosines");
}

}  // namespace
}  // namespace lobe::test
