// Compositions computed apart from this library (tests/golden/README.md), to 1e-6 relative.
#include <gtest/gtest.h>

#include <cmath>

#include "lobe/algebra/pointwise.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/reflectance/composition.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/oracle.hpp"

namespace lobe::test {
namespace {

class OracleComposition : public ::testing::TestWithParam<OracleRecord> {};

TEST(OracleComposition, HasEveryRecord) {
  EXPECT_EQ(oracle_records("composition").size(), 109U);
}

TEST_P(OracleComposition, AgreesAndItsEstimateCoversTheError) {
  const auto f = parse_material(GetParam().materials.at(0));
  const auto g = parse_material(GetParam().materials.at(1));
  const auto& angles = GetParam().theta_deg;
  const Directions pair{angles.at(0) * kDegree, angles.at(1) * kDegree, angles.at(2) * kDegree};
  const double expected = GetParam().values.at(0);

  const auto value = composition_at(device(), f, g, {&pair, 1}).at(0).at(0);

  EXPECT_NEAR(value.value, expected, 1e-6 * expected);
  EXPECT_LE(std::abs(value.value - expected), value.error + GetParam().uncertainty);
  EXPECT_LE(value.error, 1e-8 * expected);
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleComposition, ::testing::ValuesIn(oracle_records("composition")),
                         [](const auto& instance) {
                           std::string name = std::to_string(instance.index) + '_' + test_name(instance.param.name);
                           for (const double angle : instance.param.theta_deg) {
                             name += '_';
                             name += std::to_string(static_cast<int>(angle));
                           }
                           return name;
                         });

}  // namespace
}  // namespace lobe::test
