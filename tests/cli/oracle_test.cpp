// The independent reference values through the command: what a user types gives the numbers of tests/golden.
#include "support/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/process.hpp"
#include "core/text.hpp"
#include "support/names.hpp"

namespace lobe::test {
namespace {

using Json = nlohmann::json;

Json answer(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const auto outcome = run_lobe(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  return Json::parse(outcome.output);
}

void expect_agreement(const Json& estimate, const OracleRecord& record, std::size_t index) {
  constexpr double kTolerance = 1e-6;
  const double expected = record.values.at(index);
  const double value = estimate.at("value");

  EXPECT_NEAR(value, expected, std::max(kTolerance * std::abs(expected), record.uncertainty));
  EXPECT_LE(std::abs(value - expected), estimate.at("error").get<double>() + record.uncertainty + 1e-15);
}

/// Names with a number in front: several records may concern the same material.
struct ByIndexAndName {
  std::string operator()(const ::testing::TestParamInfo<OracleRecord>& test) const {
    return std::to_string(test.index) + "_" + test_name(test.param.name);
  }
};

class CommandPoint : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(CommandPoint, ProductAgrees) {
  const auto& materials = GetParam().materials;
  expect_agreement(answer({"distance", materials.at(0), materials.at(1)})["product"], GetParam(), 0);
}

INSTANTIATE_TEST_SUITE_P(oracle, CommandPoint, ::testing::ValuesIn(oracle_records("scalar product: point light")),
                         ByIndexAndName{});

class CommandDaylight : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(CommandDaylight, ProductAgrees) {
  const auto& materials = GetParam().materials;
  expect_agreement(answer({"distance", materials.at(0), materials.at(1), "--lighting", "daylight"})["product"],
                   GetParam(), 0);
}

INSTANTIATE_TEST_SUITE_P(oracle, CommandDaylight, ::testing::ValuesIn(oracle_records("scalar product: daylight")),
                         ByIndexAndName{});

class CommandAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(CommandAlbedo, AgreesAtEveryAngle) {
  std::string angles;
  for (const double angle : GetParam().theta_deg) {
    if (!angles.empty()) angles += ',';
    angles += shortest(std::min(angle, 90 - 1e-7));  // records at 90 degrees are limits
  }

  const Json albedos = answer({"albedo", GetParam().materials.at(0), "--theta", angles})["albedos"];

  ASSERT_EQ(albedos.size(), GetParam().values.size());
  for (std::size_t i = 0; i < albedos.size(); ++i) expect_agreement(albedos[i]["albedo"][0], GetParam(), i);
}

INSTANTIATE_TEST_SUITE_P(oracle, CommandAlbedo, ::testing::ValuesIn(oracle_records("albedo")), ByIndexAndName{});

class CommandMeanAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(CommandMeanAlbedo, Agrees) {
  const Json found = answer({"mean-albedo", GetParam().materials.at(0)});
  expect_agreement(found["materials"][0]["mean_albedo"][0], GetParam(), 0);
}

INSTANTIATE_TEST_SUITE_P(oracle, CommandMeanAlbedo, ::testing::ValuesIn(oracle_records("mean_albedo")),
                         ByIndexAndName{});

class CommandConstant : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(CommandConstant, IsTheValueAtTheNormal) {
  const double expected = GetParam().values.at(0);

  const Json values =
      answer({"eval", GetParam().materials.at(0), "--theta-in", "0", "--theta-out", "0", "--delta-phi", "0"})["values"];

  EXPECT_NEAR(values[0]["brdf"][0].get<double>(), expected, 1e-12 * expected);
}

/// But those of the corrected Ward model, whose constant is a share of the value at the normal (tests/golden).
std::vector<OracleRecord> values_at_the_normal() {
  auto records = oracle_records("C_max");
  std::erase_if(records, [](const OracleRecord& r) { return r.materials[0].starts_with("ward_metal"); });
  return records;
}

INSTANTIATE_TEST_SUITE_P(oracle, CommandConstant, ::testing::ValuesIn(values_at_the_normal()), ByIndexAndName{});

TEST(CommandWard, PointNormOfASharpLobeIsRightToNineDigits) {
  const Json norm = answer({"distance", "ward:m=0.00781", "lambert", "--tolerance", "1e-10"})["norm_a"];

  EXPECT_NEAR(std::pow(norm["value"].get<double>(), 2), 2049.186361, 0.5e-6);
}

}  // namespace
}  // namespace lobe::test
