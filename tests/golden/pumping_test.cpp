// Pumping-up against values computed apart from this library (tests/golden/README.md), to 1e-6 relative.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "energy/prepare.hpp"
#include "energy/repair.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/oracle.hpp"
#include "support/scale.hpp"
#include "table/evaluate.hpp"

namespace lobe::test {
namespace {

// The file's values after five steps are good to 1e-5.
double tolerance(const OracleRecord& record) {
  return std::max(1e-6, 2 * record.uncertainty);
}

/// Beyond these a step takes many seconds: each one adds kinks where maxima of albedos and cosines change sides.
int steps_to_test(const std::string& name) {
  if (!full_scale()) return 2;
  return name.find("correction=g1") != std::string::npos ? 5 : 3;
}

/// Records after some steps; golden/oracle_test.cpp has those before the first.
std::vector<OracleRecord> pumped_records(const std::string& quantity) {
  auto records = oracle_records(quantity);
  std::erase_if(records, [](const OracleRecord& record) {
    const auto at = record.name.find("times=");
    return at == std::string::npos || std::stoi(record.name.substr(at + 6)) > steps_to_test(record.name);
  });
  return records;
}

/// The material of a record, step by step so that each is done once.
const Material& pumped(const std::string& specification) {
  static std::map<std::string, Material> known;
  const auto found = known.find(specification);
  if (found != known.end()) return found->second;
  const auto at = specification.find("times=") + 6;
  const int times = std::stoi(specification.substr(at));
  Material material = parse_material(specification);
  if (times > 1) {
    auto step = material.adjustments.front();
    step.times = 1;
    material = pumped(specification.substr(0, at) + std::to_string(times - 1));
    material.adjustments = {step};
  }
  return known.emplace(specification, prepare(device(), material)).first->second;
}

class PumpedAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(PumpedAlbedo, Agrees) {
  const OracleRecord& record = GetParam();
  const Material& material = pumped(record.materials.at(0));
  std::vector<double> angles;
  for (const double degrees : record.theta_deg) angles.push_back(degrees * kDegree);
  const auto albedos = albedo(device(), material, angles).at(0);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    SCOPED_TRACE(record.theta_deg[i]);
    EXPECT_NEAR(albedos[i].value, record.values[i], tolerance(record) * record.values[i]);
    EXPECT_LE(albedos[i].value, 1 + albedos[i].error + 1e-7);  // (2.19)
  }
}

INSTANTIATE_TEST_SUITE_P(oracle, PumpedAlbedo, ::testing::ValuesIn(pumped_records("pumped albedo")), ByName{});

class PumpedMeanAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(PumpedMeanAlbedo, Agrees) {
  const OracleRecord& record = GetParam();
  const Material& material = pumped(record.materials.at(0));
  const auto mean = mean_albedo(device(), material).at(0);
  EXPECT_NEAR(mean.value, record.values.at(0), tolerance(record) * record.values[0]);
}

INSTANTIATE_TEST_SUITE_P(oracle, PumpedMeanAlbedo, ::testing::ValuesIn(pumped_records("pumped mean_albedo")), ByName{});

class PumpedMirror : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(PumpedMirror, Agrees) {
  const OracleRecord& record = GetParam();
  const Material& material = pumped(record.materials.at(0));
  std::vector<Directions> pairs;
  for (const double degrees : record.theta_deg) {
    pairs.push_back({degrees * kDegree, degrees * kDegree, std::numbers::pi});
  }
  const auto values = evaluate(device(), material, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double radiance = values(static_cast<Eigen::Index>(i), 0) * std::cos(pairs[i].theta_in);
    EXPECT_NEAR(radiance, record.values[i], tolerance(record) * record.values[i]) << record.theta_deg[i];
  }
}

INSTANTIATE_TEST_SUITE_P(oracle, PumpedMirror, ::testing::ValuesIn(pumped_records("pumped f(L,R)cosL")), ByName{});

class PumpedTableAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(PumpedTableAlbedo, AgreesWithinItsErrors) {
  const OracleRecord& record = GetParam();
  Material material = parse_material(record.materials.at(0));
  const Adjustment step = material.adjustments.front();
  material.adjustments.clear();
  const auto grid = HemisphereGrid::gauss(48, 96);
  const auto table = pump(tabulate(device(), material, grid), step.correction, {.times = step.times}).table;
  std::vector<double> angles;
  for (const double degrees : record.theta_deg) angles.push_back(degrees * kDegree);
  const auto albedos = albedo(table, angles).at(0);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    EXPECT_NEAR(albedos[i].value, record.values[i], albedos[i].error + tolerance(record)) << record.theta_deg[i];
    // The kink where albedos or cosines change sides holds sums over 48 rings at 5e-4.
    if (record.theta_deg[i] <= 75) {
      EXPECT_NEAR(albedos[i].value, record.values[i], 1e-3) << record.theta_deg[i];
    }
  }
}

/// All steps: those of tables take no time.
std::vector<OracleRecord> all_pumped_albedos() {
  auto records = oracle_records("pumped albedo");
  std::erase_if(records, [](const OracleRecord& record) { return record.name.find("times=") == std::string::npos; });
  return records;
}

INSTANTIATE_TEST_SUITE_P(oracle, PumpedTableAlbedo, ::testing::ValuesIn(all_pumped_albedos()), ByName{});

TEST(PumpedPhong, TendsToTheMetal) {
  // Controlled pumping leads to (R.V)^n / max(N.L, N.V), but towards grazing angles after ever more steps.
  const Material twice = pumped("phong:n=20@pump:correction=controlled,times=2");
  const Material metal = parse_material("metal_phong:n=20");
  for (double degrees = 0; degrees <= 85; degrees += 5) {
    SCOPED_TRACE(degrees);
    const std::vector<double> angle{degrees * kDegree};
    EXPECT_NEAR(albedo(device(), twice, angle)[0][0].value, albedo(device(), metal, angle)[0][0].value, 1e-6);
  }
}

TEST(Pumping, OfAMaterialWithChannelsIsThatOfEach) {
  const Material all = prepare(device(), parse_material("blinn:n=4/9,scale=0.5/0.9@pump"));
  ASSERT_EQ(all.channels(), 2U);
  const std::vector<double> angles{0.3, 1.2};
  const auto albedos = albedo(device(), all, angles);
  for (const auto& [channel, text] :
       {std::pair{0, "blinn:n=4,scale=0.5@pump"}, std::pair{1, "blinn:n=9,scale=0.9@pump:times=1"}}) {
    const auto alone = albedo(device(), prepare(device(), parse_material(text)), angles);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      EXPECT_NEAR(albedos[static_cast<std::size_t>(channel)][i].value, alone[0][i].value, 1e-9) << text;
    }
  }
}

TEST(Pumping, SurvivesJson) {
  const std::vector<Directions> pairs{{0.2, 0.3, 3}, {1.5, 1.4, 3}};
  // The albedo after a step of g2 has a kink, around which its curve has parts.
  for (const char* text : {"blinn:n=20@pump:correction=g1,times=1", "blinn:n=20@pump:correction=g2,times=2"}) {
    const Material material = pumped(text);
    EXPECT_EQ(evaluate(device(), material_from_json(to_json(material)), pairs), evaluate(device(), material, pairs))
        << text;
  }
}

// No albedo of a patch is smooth where its disc meets the horizon: 1 before, and falling from there on.
TEST(Pumping, GoesPastTheKinkOfAPatch) {
  const Material patch = prepare(device(), parse_material("basic_patch:R=0.3@pump"));
  const std::vector<double> angles{0.3, 0.7, 0.8, 1.0, 1.3};
  const auto before = albedo(device(), parse_material("basic_patch:R=0.3"), angles).front();
  const auto after = albedo(device(), patch, angles).front();
  for (std::size_t i = 0; i < angles.size(); ++i) {
    EXPECT_GE(after[i].value, before[i].value - 1e-6) << angles[i];  // (2.18, 2.19)
    EXPECT_LE(after[i].value, 1 + 1e-6) << angles[i];
  }
}

TEST(Pumping, RefusesWhatItCannotDo) {
  for (const char* text :
       {"ward_anisotropic:m_x=0.1,m_y=0.2@pump", "lambert:scale=0@pump", "phong:n=5@pump@pump:correction=controlled"}) {
    EXPECT_THROW((void)prepare(device(), parse_material(text)), NumericError) << text;
  }
}

}  // namespace
}  // namespace lobe::test
