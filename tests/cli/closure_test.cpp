// Every verb takes files with sharp highlights and trees of cells: with a number, its error, and no grid to be chosen.
// What cannot be reached is said in one line, and refused with --strict.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "cli/command_test.hpp"
#include "interface/command.hpp"
#include "lobe/hdf5/table_file.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A file of the MERL form with a highlight that gauss:64x128 does not resolve.
class SharpFiles : public CommandTest {
 protected:
  void SetUp() override {
    make({"export", "ggx:alpha=0.05", "--format", "merl", "-o", "m.binary"});
    mean_ = mean_albedo_of(kSharp);
  }

  [[nodiscard]] double mean_albedo_of(const std::string& text) const {
    return json({"mean-albedo", text})["materials"][0]["mean_albedo"][0]["value"];
  }
  /// Whether the mean albedo of an answer is a known one within the errors of both.
  static void expect_mean(const Json& answer, double expected) {
    const Json& mean = answer["mean_albedo"][0];
    EXPECT_NEAR(mean["value"], expected, mean["error"].get<double>() + 1e-3 * expected);
    EXPECT_LT(mean["error"], 0.2 * expected);
  }

  const std::string kSharp = "m.binary[luminance=rec709]";
  double mean_ = 0;
};

TEST_F(SharpFiles, AreScaledMixedTransposedAndRepaired) {
  const auto outcome = make({"scale", kSharp, "0.5", "-o", "half.h5", "--json"});
  EXPECT_THAT(outcome.error, IsEmpty());
  const Json half = Json::parse(outcome.output);
  EXPECT_EQ(half["is_unresolved"], false);
  expect_mean(half, 0.5 * mean_);
  const std::string grid = half["grid"];
  EXPECT_NE(grid, "gauss:64x128");

  const Json mixed = json({"mix", kSharp, "lambert:scale=0.4", "--weights", "0.5,0.25", "-o", "mixed.h5"});
  EXPECT_EQ(mixed["grid"], grid);
  expect_mean(mixed, 0.5 * mean_ + 0.1);

  make({"transpose", kSharp, "-o", "t.h5"});
  make({"transpose", "t.h5", "-o", "tt.h5"});
  make({"scale", kSharp, "1", "-o", "same.h5"});
  const BrdfTable twice = load_table(file("tt.h5"));
  const BrdfTable once = load_table(file("same.h5"));
  EXPECT_TRUE(std::ranges::equal(twice.values, once.values));

  const Json normalised = json({"normalise", kSharp});
  EXPECT_EQ(normalised["grid"], grid);
  EXPECT_NEAR(normalised["albedo_in"][0]["max"]["value"], 1, 1e-12);
}

TEST_F(SharpFiles, OnATooCoarseGridKeepTheirTrueErrorWithOneWarning) {
  const Words words{"scale", kSharp, "0.5", "--grid", "gauss:16x32", "-o", "coarse.h5", "-f", "--json"};
  const auto outcome = make(words);
  EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("warning: grid gauss:16x32 does not resolve"));
  EXPECT_THAT(outcome.error, HasSubstr("--strict refuses them"));
  const Json answer = Json::parse(outcome.output);
  EXPECT_EQ(answer["is_unresolved"], true);
  const Json& mean = answer["mean_albedo"][0];
  EXPECT_NEAR(mean["value"], 0.5 * mean_, mean["error"].get<double>());

  Words strict = words;
  strict.emplace_back("--strict");
  expect_refusal(strict, ExitCode::numeric, "gauss:16x32 does not resolve");
  Words allowed = words;
  allowed.emplace_back("--allow-unresolved");
  EXPECT_THAT(make(allowed).error, IsEmpty());
}

TEST_F(SharpFiles, HaveProductsUnderTabulatedLight) {
  make({"tabulate", "lambert:scale=0.4", "--grid", "gauss:16x32", "-o", "w.h5"});
  const auto outcome = make({"product", kSharp, "phong:n=5", "--lighting", "table:w.h5", "--json"});
  EXPECT_THAT(outcome.error, IsEmpty());
  const Json answer = Json::parse(outcome.output);
  // Under W = 0.4 / pi the product is pi 0.4 times that of mean albedos.
  const double other = mean_albedo_of("phong:n=5");
  const double expected =
      0.4 / std::numbers::pi *
      json({"product", kSharp, "phong:n=5", "--lighting", "daylight"})["product"]["value"].get<double>();
  EXPECT_NEAR(answer["product"]["value"], expected, answer["product"]["error"].get<double>() + 0.02 * expected);
  EXPECT_GT(other, 0);
}

/// A command that asks for more than can be had.
struct Wish {
  std::string name;
  Words words;
};

class MissedTolerances : public CommandTest, public ::testing::WithParamInterface<Wish> {};

TEST_P(MissedTolerances, EndWithTheValueOneWarningAndSuccessUnlessStrict) {
  make({"export", "phong:n=5", "--format", "csv", "-o", "rows.csv"});
  make({"tabulate", "phong:n=20", "--grid", "gauss:16x32", "-o", "t.h5"});
  const auto outcome = make(GetParam().words);
  EXPECT_FALSE(outcome.output.empty());
  EXPECT_EQ(std::ranges::count(outcome.error, '\n'), 1) << outcome.error;
  EXPECT_THAT(outcome.error, ::testing::StartsWith("lobe: warning: "));
  EXPECT_THAT(outcome.error, ::testing::AnyOf(HasSubstr("reaches a relative error of"), HasSubstr("miss the tolerance"),
                                              HasSubstr("not converged")));
  Words strict = GetParam().words;
  strict.emplace_back("--strict");
  expect_refusal(strict, ExitCode::numeric, "give a larger tolerance");
}

INSTANTIATE_TEST_SUITE_P(
    All, MissedTolerances,
    ::testing::Values(
        Wish{"product", {"product", "rows.csv", "lambert", "--tolerance", "1e-15"}},
        Wish{"norm", {"norm", "rows.csv", "--tolerance", "1e-15"}},
        Wish{"distance", {"distance", "rows.csv", "lambert", "--tolerance", "1e-15"}},
        Wish{"angle", {"angle", "rows.csv", "lambert", "--tolerance", "1e-15"}},
        Wish{"gram", {"gram", "rows.csv", "lambert", "--tolerance", "1e-15"}},
        Wish{"distance_matrix", {"distance-matrix", "rows.csv", "lambert", "--tolerance", "1e-15"}},
        Wish{"norm_of_a_table", {"norm", "t.h5", "--tolerance", "1e-15"}},
        Wish{"albedo", {"albedo", "rows.csv", "--theta", "30", "--tolerance", "1e-15"}},
        Wish{"mean_albedo", {"mean-albedo", "rows.csv", "--tolerance", "1e-15"}},
        Wish{"mean_albedo_of_a_formula", {"mean-albedo", "patch_power:n=0.3", "--tolerance", "1e-16"}},
        Wish{"approximate", {"approximate", "rows.csv", "-b", "lambert", "-b", "phong:n=4", "--tolerance", "1e-15"}},
        Wish{"fit", {"fit", "rows.csv", "--family", "lambert", "--tolerance", "1e-15"}},
        Wish{"compose_at", {"compose", "rows.csv", "lambert", "--at", "30,30,0", "--tolerance", "1e-15"}},
        Wish{"pump_of_a_table",
             {"pump", "t.h5", "--correction", "g1", "--times", "until-converged", "--tolerance", "1e-300"}}),
    [](const auto& instance) { return instance.param.name; });

// Ten steps of some seconds.
INSTANTIATE_TEST_SUITE_P(Long, MissedTolerances,
                         ::testing::ValuesIn(full_scale() ? std::vector{Wish{
                                                                "pump",
                                                                {"pump", "phong:n=20", "--correction", "g1", "--times",
                                                                 "until-converged", "--tolerance", "1e-12"}}}
                                                          : std::vector<Wish>{}),
                         [](const auto& instance) { return instance.param.name; });

TEST(CommandOptions, OfToleranceComeWithStrict) {
  for (const auto& command : cli::commands()) {
    const auto takes = [&](std::string_view name) {
      return std::ranges::any_of(command.options, [&](const cli::Option& one) { return one.name() == name; });
    };
    EXPECT_TRUE(takes("strict") || !(takes("tolerance") || takes("allow-unresolved"))) << command.name;
  }
}

}  // namespace
}  // namespace lobe::test
