// UTIA files: against a reading by loops over sixteen neighbours, written and read again, and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "io/measured_files.hpp"
#include "lobe/core/directions.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::size_t kValues = std::size_t{288} * 288;

std::size_t place(std::size_t plane, int theta_i, int phi_i, int theta_v, int phi_v) {
  return plane * kValues + static_cast<std::size_t>(288 * (48 * theta_i + phi_i) + 48 * theta_v + phi_v);
}

std::vector<double> random_values(unsigned seed) {
  std::vector<double> values(3 * kValues);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> value(0, 1);
  for (double& one : values) one = value(engine);
  return values;
}

double tent(double distance) {
  return std::max(0.0, 1 - std::abs(distance));
}

/// Over all samples, by hats of one step; degrees.
double reference(const std::vector<double>& values, std::size_t plane, double theta_i, double phi_i, double theta_v,
                 double phi_v) {
  double sum = 0;
  const auto turned = [](double phi, int k) { return std::remainder(phi / 7.5 - k, 48.0); };
  for (int ti = 0; ti < 6; ++ti) {
    for (int tv = 0; tv < 6; ++tv) {
      const double weight = tent(std::min(theta_i, 75.0) / 15 - ti) * tent(std::min(theta_v, 75.0) / 15 - tv);
      if (weight == 0) continue;
      for (int from = 0; from < 48; ++from) {
        for (int pv = 0; pv < 48; ++pv) {
          sum += weight * tent(turned(phi_i, from)) * tent(turned(phi_v, pv)) * values[place(plane, ti, from, tv, pv)];
        }
      }
    }
  }
  return sum;
}

double linear_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

class Utia : public ::testing::Test {
 protected:
  [[nodiscard]] BrdfFunction load(const std::vector<double>& values, const ReadOptions& options = {}) const {
    write_file(path(), bytes_of(values));
    return load_measured(path(), options);
  }
  [[nodiscard]] static std::string bytes_of(const std::vector<double>& values) {
    std::string bytes;
    append_bytes(bytes, values);
    return bytes;
  }
  [[nodiscard]] std::filesystem::path path() const { return directory_.path() / "fabric.bin"; }

  TemporaryDirectory directory_;
};

void expect_reference_values(const BrdfFunction& brdf, const std::vector<double>& values) {
  const auto pairs = twenty_geometries();
  const auto found = brdf.at(pairs).value;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& p = pairs[i];
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(found(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)),
                  reference(values, c, p.theta_in / kDegree, p.phi_in / kDegree, p.theta_out / kDegree,
                            (p.phi_in + p.delta_phi) / kDegree),
                  1e-13)
          << i;
    }
  }
}

TEST_F(Utia, HasTheValuesOfAnIndependentReading) {
  const auto values = random_values(1);
  const BrdfFunction brdf = load(values);
  EXPECT_EQ(brdf.format, "UTIA .bin (Filip and Vávra 2014)");
  EXPECT_THAT(brdf.channels, ElementsAre("red", "green", "blue"));
  EXPECT_THAT(brdf.remarks, ::testing::IsEmpty());
  EXPECT_FALSE(brdf.is_isotropic);
  expect_reference_values(brdf, values);
}

TEST_F(Utia, IsDecodedBeforeItIsInterpolated) {
  auto values = random_values(2);
  const BrdfFunction brdf = load(values, {.decode_srgb = true});
  EXPECT_THAT(brdf.conventions, HasSubstr("decoded from sRGB"));
  for (double& value : values) value = linear_srgb(value);
  expect_reference_values(brdf, values);
}

TEST_F(Utia, HasItsPeakHalfATurnFromTheLight) {
  std::vector<double> values(3 * kValues, 0.125);
  for (int phi = 0; phi < 48; ++phi) values[place(1, 3, phi, 3, (phi + 24) % 48)] = 7;
  const BrdfFunction brdf = load(values);
  for (const double phi_in : {0.0, 37.5, 352.5, -7.5}) {
    SCOPED_TRACE(phi_in);
    const auto found = brdf.at(std::vector<Directions>{{45 * kDegree, 45 * kDegree, pi, phi_in * kDegree},
                                                       {45 * kDegree, 45 * kDegree, 0, phi_in * kDegree}})
                           .value;
    EXPECT_EQ(found(0, 1), 7);
    EXPECT_EQ(found(1, 1), 0.125);
    EXPECT_EQ(found(0, 0), 0.125);
  }
}

TEST_F(Utia, SeesTheLightsAzimuth) {
  const auto values = random_values(3);
  const auto found = load(values)
                         .at(std::vector<Directions>{{30 * kDegree, 15 * kDegree, 22.5 * kDegree, 75 * kDegree},
                                                     {30 * kDegree, 15 * kDegree, 22.5 * kDegree, 0}})
                         .value;
  EXPECT_EQ(found(0, 2), values[place(2, 2, 10, 1, 13)]);
  EXPECT_EQ(found(1, 2), values[place(2, 2, 0, 1, 3)]);
}

TEST_F(Utia, StaysAsItIsBeyondTheLastAngle) {
  const BrdfFunction brdf = load(random_values(4));
  const auto found = brdf.at(std::vector<Directions>{{75 * kDegree, 0.3, 1, 2}, {89.9 * kDegree, 0.3, 1, 2}}).value;
  EXPECT_LT((found.row(0) - found.row(1)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST_F(Utia, CountsNegativeValuesAndKeepsThem) {
  auto values = random_values(5);
  for (const int k : {0, 1, 17}) values[place(0, 0, k, 0, 0)] = -0.5;
  const BrdfFunction brdf = load(values);
  EXPECT_THAT(brdf.remarks, ElementsAre("3 of 248832 values are negative, and kept"));
  EXPECT_EQ(brdf.at(std::vector<Directions>{{0, 0, 0, 0}}).value(0, 0), -0.5);
  EXPECT_EQ(load(values, {.decode_srgb = true}).at(std::vector<Directions>{{0, 0, 0, 0}}).value(0, 0),
            -linear_srgb(0.5));
}

TEST_F(Utia, IsWrittenAsItWasRead) {
  auto values = random_values(6);
  values[77] = -1;
  save_measured(device(), load(values), "utia", directory_.path() / "again.bin");
  EXPECT_TRUE(read_file(directory_.path() / "again.bin") == bytes_of(values));
}

TEST_F(Utia, HoldsOneChannelThreeTimes) {
  save_measured(device(), load(random_values(7), {.channels = {"green"}}), "utia", directory_.path() / "green.bin");
  const std::string bytes = read_file(directory_.path() / "green.bin");
  ASSERT_EQ(bytes.size(), 3 * kValues * 8);
  EXPECT_TRUE(bytes.substr(0, kValues * 8) == bytes_of(random_values(7)).substr(kValues * 8, kValues * 8));
  EXPECT_TRUE(bytes.substr(0, kValues * 8) == bytes.substr(kValues * 8, kValues * 8));
  EXPECT_TRUE(bytes.substr(0, kValues * 8) == bytes.substr(2 * kValues * 8));
}

TEST_F(Utia, IsNotWrittenForWhatItCannotHold) {
  const std::filesystem::path other = directory_.path() / "other.bin";
  const BrdfFunction two = load(random_values(8), {.channels = {"red", "blue"}});
  expect_complaint([&] { save_measured(device(), two, "utia", other); }, "'fabric' has 2 channels");
  BrdfFunction nowhere = two;
  nowhere.channels = {"value"};
  nowhere.at = [](std::span<const Directions> pairs) {
    return BrdfValues{Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(pairs.size()), 1, HUGE_VAL), {}};
  };
  expect_complaint([&] { save_measured(device(), nowhere, "utia", other); },
                   "'fabric' has values that are no finite numbers");
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST_F(Utia, IsRefusedWhereItIsDamaged) {
  const std::string whole = bytes_of(random_values(9));
  expect_unreadable(path(), whole.substr(1), "no known format");
  expect_unreadable(path(), with_number(whole, 8000, std::nan("")), "byte 8000: a value is no finite number");
  expect_unreadable(path(), with_number(whole, whole.size() - 8, -HUGE_VAL), "byte 1990648: a value is no finite");
}

}  // namespace
}  // namespace lobe::test
