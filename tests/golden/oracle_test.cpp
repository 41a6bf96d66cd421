// Numbers computed apart from this library (tests/golden/README.md), to 1e-6 relative or to the accuracy they have.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/metric/metric.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/options.hpp"
#include "support/oracle.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
constexpr double kTolerance = 1e-6;
constexpr double kPatchTolerance = 5e-6;  // what the records of patch lights are good for

double allowed(const OracleRecord& record, double value) {
  return std::max(kTolerance * std::abs(value), record.uncertainty);
}

/// Names with a number in front: several records may concern the same material.
struct ByIndexAndName {
  std::string operator()(const ::testing::TestParamInfo<OracleRecord>& info) const {
    return std::to_string(info.index) + "_" + test_name(info.param.name);
  }
};

/// Records of pumping-up before the first step; golden/pumping_test.cpp has the others.
std::vector<OracleRecord> unpumped(std::vector<OracleRecord> records) {
  std::erase_if(records, [](const OracleRecord& record) { return record.name.find('@') != std::string::npos; });
  return records;
}

std::vector<OracleRecord> joined(std::vector<OracleRecord> first, const std::vector<OracleRecord>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST(Oracle, HasRecordsOfEveryQuantity) {
  EXPECT_EQ(oracle_family().size(), 13U);
  EXPECT_GE(oracle_records("scalar product: point light").size(), 50U);
  EXPECT_GE(oracle_records("scalar product: daylight").size(), 50U);
  EXPECT_GE(oracle_records("albedo").size(), 20U);
  EXPECT_GE(oracle_records("mean_albedo").size(), 20U);
}

// --- Scalar products: one measurement of the whole family per lighting.
// -----------------------------------------------

const MetricResult& family_metric(const Lighting& lighting) {
  static std::map<std::string, MetricResult> results;
  const auto found = results.find(lighting.name());
  if (found != results.end()) return found->second;
  std::vector<Material> materials;
  for (const auto& text : oracle_family()) materials.push_back(parse_material(text));
  MetricOptions options;
  options.patch_tolerance = 1e-6;
  return results.emplace(lighting.name(), measure(device(), materials, lighting, options)).first->second;
}

Estimate family_product(const OracleRecord& record, const Lighting& lighting) {
  const auto family = oracle_family();
  const auto index = [&](const std::string& text) {
    return static_cast<Eigen::Index>(std::find(family.begin(), family.end(), text) - family.begin());
  };
  const auto& metric = family_metric(lighting).combined;
  const auto i = index(record.materials[0]);
  const auto j = index(record.materials[1]);
  return {metric.gram(i, j), metric.gram_error(i, j)};
}

class OraclePoint : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OraclePoint, ProductAgrees) {
  const double expected = GetParam().values.at(0);

  const auto product = family_product(GetParam(), Lighting::point());

  EXPECT_NEAR(product.value, expected, allowed(GetParam(), expected));
}

TEST_P(OraclePoint, EstimateCoversTheError) {
  const double expected = GetParam().values.at(0);

  const auto product = family_product(GetParam(), Lighting::point());

  EXPECT_LE(std::abs(product.value - expected), product.error + GetParam().uncertainty);
  EXPECT_LE(product.error, kTolerance * product.value);
}

INSTANTIATE_TEST_SUITE_P(oracle, OraclePoint, ::testing::ValuesIn(oracle_records("scalar product: point light")),
                         ByIndexAndName{});

class OracleDaylight : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleDaylight, ProductAgrees) {
  const double expected = GetParam().values.at(0);

  const auto product = family_product(GetParam(), Lighting::daylight());

  EXPECT_NEAR(product.value, expected, allowed(GetParam(), expected));
}

TEST_P(OracleDaylight, EstimateCoversTheError) {
  const double expected = GetParam().values.at(0);

  const auto product = family_product(GetParam(), Lighting::daylight());

  EXPECT_LE(std::abs(product.value - expected), product.error + GetParam().uncertainty);
  EXPECT_LE(product.error, kTolerance * product.value);
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleDaylight, ::testing::ValuesIn(oracle_records("scalar product: daylight")),
                         ByIndexAndName{});

class OraclePatchLight : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OraclePatchLight, ProductAgreesAndTheEstimateCoversTheError) {
  const double expected = GetParam().values.at(0);

  const auto product = family_product(GetParam(), Lighting::patch(GetParam().light_radius));

  EXPECT_NEAR(product.value, expected, kPatchTolerance * expected);
  // The records state less than they are off: the first, Lambert's norm at R = 0.25, 7e-7 of its closed form.
  const double uncertainty = std::max(GetParam().uncertainty, 1e-6 * expected);
  EXPECT_LE(std::abs(product.value - expected), product.error + uncertainty);
}

INSTANTIATE_TEST_SUITE_P(oracle, OraclePatchLight,
                         ::testing::ValuesIn(oracle_records("scalar product: general lighting")), ByIndexAndName{});

TEST(OracleFamily, EveryPairReachesTheTolerance) {
  EXPECT_TRUE(family_metric(Lighting::point()).unresolved.empty());
  EXPECT_TRUE(family_metric(Lighting::daylight()).unresolved.empty());
}

TEST(OracleWard, PointNormOfASharpLobeIsRightToNineDigits) {
  const auto ward = parse_material("ward:m=0.00781");

  const auto square = scalar_product(device(), ward, ward, Lighting::point(), with_tolerance(1e-10));

  EXPECT_NEAR(square.value, 2049.186361, 0.5e-6);
}

// --- Albedos.
// ---------------------------------------------------------------------------------------------------------

Estimate mean_albedo_of(const std::string& text) {
  static std::map<std::string, Estimate> known;
  const auto found = known.find(text);
  if (found != known.end()) return found->second;
  return known.emplace(text, mean_albedo(device(), parse_material(text)).at(0)).first->second;
}

class OracleMeanAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleMeanAlbedo, Agrees) {
  const double expected = GetParam().values.at(0);

  const auto value = mean_albedo_of(GetParam().materials.at(0));

  EXPECT_NEAR(value.value, expected, allowed(GetParam(), expected));
  EXPECT_LE(std::abs(value.value - expected), value.error + GetParam().uncertainty);
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleMeanAlbedo,
                         ::testing::ValuesIn(joined(oracle_records("mean_albedo"),
                                                    oracle_records("mean_albedo (daylight module)"))),
                         ByIndexAndName{});

class OracleMeanAlbedoProduct : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleMeanAlbedoProduct, Agrees) {
  const double expected = GetParam().values.at(0);

  const double product =
      pi * pi * mean_albedo_of(GetParam().materials.at(0)).value * mean_albedo_of(GetParam().materials.at(1)).value;

  EXPECT_NEAR(product, expected, 2 * allowed(GetParam(), expected));
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleMeanAlbedoProduct, ::testing::ValuesIn(oracle_records("mean-albedo product")),
                         ByIndexAndName{});

std::vector<Estimate> albedos(const std::string& material, const std::vector<double>& theta_deg) {
  std::vector<double> theta;
  // Records at 90 degrees are limits.
  for (const double degrees : theta_deg) theta.push_back(std::min(degrees, 90 - 1e-7) * kDegree);
  return albedo(device(), parse_material(material), theta).at(0);
}

class OracleAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleAlbedo, AgreesAtEveryAngle) {
  const auto values = albedos(GetParam().materials.at(0), GetParam().theta_deg);

  ASSERT_EQ(values.size(), GetParam().values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = GetParam().values[i];
    EXPECT_NEAR(values[i].value, expected, allowed(GetParam(), expected)) << GetParam().theta_deg[i] << " deg";
    EXPECT_LE(std::abs(values[i].value - expected), values[i].error + GetParam().uncertainty + 1e-15)
        << GetParam().theta_deg[i] << " deg";
  }
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleAlbedo,
                         ::testing::ValuesIn(joined(oracle_records("albedo"),
                                                    unpumped(oracle_records("pumped albedo")))),
                         ByIndexAndName{});

class OracleGrazingAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleGrazingAlbedo, TendsToTheLimit) {
  const double expected = GetParam().values.at(0);
  // At N.L = 1e-9 what is missing to the limit is far below the tolerance.
  const std::vector<double> theta{pi / 2 - 1e-9};

  const double tolerance = std::max(kTolerance, 4 * GetParam().uncertainty);
  const AlbedoOptions options{.tolerance = tolerance, .precision = Precision::double_precision};

  const auto value = albedo(device(), parse_material(GetParam().materials.at(0)), theta, options).at(0).at(0);

  EXPECT_NEAR(value.value, expected, value.error + std::max(GetParam().uncertainty, 1e-7));
  EXPECT_LE(value.error, tolerance * expected);
}

/// Records of models that are black at grazing angles are values at N.L = 1e-13, far from the limit.
std::vector<OracleRecord> grazing_limits() {
  auto records = joined(oracle_records("albedo_limit_90"), oracle_records("a(90)"));
  std::erase_if(records, [](const OracleRecord& record) {
    return record.materials[0].starts_with("minnaert") || record.materials[0].starts_with("sandwich");
  });
  return records;
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleGrazingAlbedo, ::testing::ValuesIn(grazing_limits()), ByIndexAndName{});

class OracleWardAlbedo : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleWardAlbedo, IsLargestAtNormalIncidence) {
  const auto values = albedos(GetParam().materials.at(0), {0, 30, 60, 89});
  const double expected = GetParam().values.at(0);

  EXPECT_NEAR(values[0].value, expected, allowed(GetParam(), expected));
  EXPECT_LT(std::max({values[1].value, values[2].value, values[3].value}), values[0].value);
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleWardAlbedo, ::testing::ValuesIn(oracle_records("max_albedo_0_89deg")),
                         ByIndexAndName{});

class OracleWardCrossing : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleWardCrossing, IsWhereTheAlbedoIsOne) {
  EXPECT_NEAR(albedos(GetParam().materials.at(0), GetParam().values).at(0).value, 1, kTolerance);
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleWardCrossing,
                         ::testing::ValuesIn(oracle_records("theta where albedo crosses 1")), ByIndexAndName{});

class OracleOvershoot : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleOvershoot, IsTheAlbedoAboveOne) {
  const auto value = albedos(GetParam().materials.at(0), GetParam().theta_deg).at(0).value;

  EXPECT_NEAR(value - 1, GetParam().values.at(0), kTolerance);
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleOvershoot, ::testing::ValuesIn(oracle_records("max albedo overshoot")),
                         ByIndexAndName{});

// --- Values.
// ----------------------------------------------------------------------------------------------------------

class OracleConstant : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleConstant, IsTheValueAtTheNormal) {
  const Directions normal{0, 0, 0};
  const double expected = GetParam().values.at(0);

  const auto values = evaluate(device(), parse_material(GetParam().materials.at(0)), {&normal, 1});

  EXPECT_NEAR(values(0, 0), expected, std::max(1e-12 * expected, GetParam().uncertainty));
}

/// Those of the corrected Ward model, whose value at the normal is C / (4 pi m^2), apart.
std::vector<OracleRecord> constants(bool of_ward) {
  auto records = oracle_records("C_max");
  std::erase_if(records, [=](const OracleRecord& r) { return r.materials[0].starts_with("ward_metal") != of_ward; });
  return records;
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleConstant, ::testing::ValuesIn(constants(false)), ByIndexAndName{});

class OracleWardConstant : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleWardConstant, IsTheShareOfTheValueAtTheNormal) {
  const Directions normal{0, 0, 0};
  const std::string& material = GetParam().materials.at(0);
  const double m = std::stod(material.substr(material.find('=') + 1));

  const auto values = evaluate(device(), parse_material(material), {&normal, 1});

  EXPECT_NEAR(values(0, 0) * 4 * pi * m * m, GetParam().values.at(0), GetParam().uncertainty);
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleWardConstant, ::testing::ValuesIn(constants(true)), ByIndexAndName{});

/// Metals of Table 1.2.
class OracleMetal : public ::testing::TestWithParam<OracleRecord> {};

TEST_P(OracleMetal, ReflectsItsShareAtNormalIncidence) {
  const Directions normal{0, 0, 0};

  const auto metal = evaluate(device(), parse_material(GetParam().materials.at(0) + ",m=0.2"), {&normal, 1});
  const auto without_loss = evaluate(device(), parse_material("cook_torrance:m=0.2"), {&normal, 1});

  EXPECT_NEAR(100 * metal(0, 0) / without_loss(0, 0), GetParam().values.at(0), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleMetal, ::testing::ValuesIn(oracle_records("a0_percent")), ByIndexAndName{});

}  // namespace
}  // namespace lobe::test
