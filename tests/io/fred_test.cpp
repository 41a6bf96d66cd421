// Tabulated scatter of FRED: against an independent reading, against the same measurement for another program, and
// damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "io/measured_files.hpp"
#include "lobe/core/directions.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr const char* kFredStart = "type bsdf_data\nformat angles=deg bsdf=value scale=1\n";

class Fred : public MeasuredData {
 protected:
  Fred() : MeasuredData("zemax") {}
};

TEST_F(Fred, SamplesHaveTheValuesOfAnIndependentReader) {
  const auto brdf = load_measured(data_ / "AnoBlackEC1onAlum.txt");
  EXPECT_EQ(brdf.format, "FRED tabulated scatter");
  EXPECT_TRUE(brdf.is_bilateral);
  double theta_in = 0;
  int compared = 0;
  for (const auto& row : number_rows(data_ / "AnoBlackEC1onAlum.txt")) {
    if (row.size() == 2) theta_in = row[0];
    // Rows of 10, 30, 50 and 70 degrees coincide with each other by reciprocity.
    if (row.size() != 3 || std::fmod(row[0], 20) == 10 || row[0] == 0) continue;
    const Directions pair{theta_in * kDegree, row[0] * kDegree, (180 - row[1]) * kDegree, 0};
    ASSERT_NEAR(brdf.at(std::vector<Directions>{pair}).value(0, 0), row[2], 1e-9) << theta_in << " " << row[0];
    ++compared;
  }
  EXPECT_GT(compared, 700);
}

TEST_F(Fred, TheSameMeasurementAsAZemaxFileAgrees) {
  const std::vector<Directions> pairs{{30 * kDegree, 30 * kDegree, pi, 0},
                                      {50 * kDegree, 20 * kDegree, 2, 0},
                                      {10 * kDegree, 60 * kDegree, 1, 0},
                                      {30 * kDegree, 50 * kDegree, 2.5, 0}};
  for (const char* name : {"AnoBlackEC1onAlum", "AnoBlackNiTEonSteel"}) {
    const auto fred = load_measured(data_ / (std::string(name) + ".txt")).at(pairs).value;
    const auto zemax = load_measured(data_ / (std::string(name) + ".bsdf")).at(pairs).value;
    for (Eigen::Index i = 0; i < fred.rows(); ++i) {
      // The median of all samples is 7 to 12 %, since the other file was shifted and interpolated when it was written.
      EXPECT_NEAR(fred(i, 0) / zemax(i, 0), 1, 0.25) << name << " " << i;
    }
  }
}

TEST_F(Fred, FilesOfWholeTurnsAreThoseOfHalfTurns) {
  const auto half = load_measured(data_ / "AnoBlackEC2onAlum.txt");
  const auto whole = load_measured(data_ / "AnoBlackEC2onAlum_fullAz.txt");
  EXPECT_THAT(whole.remarks, Contains(HasSubstr("1145 of 2175 samples are at the place of another one")));
  for (const auto& pair : {Directions{0.3, 0.6, 2, 0}, Directions{0.9, 0.2, -3, 0}, Directions{0.5, 0.5, pi, 0}}) {
    SCOPED_TRACE(pair.theta_in);
    const std::vector<Directions> one{pair};
    const double expected = half.at(one).value(0, 0);
    EXPECT_NEAR(whole.at(one).value(0, 0), expected, 0.02 * expected);
  }
}

TEST(FredFiles, OfSeveralAzimuthsAreAnisotropic) {
  const TemporaryDirectory directory;
  // f = 0.2 + 0.1 cos(2 phi_in), where the light is opposite to the specular direction.
  std::string text = kFredStart;
  for (int phi = 0; phi < 360; phi += 30) {
    for (int theta = 15; theta <= 75; theta += 15) {
      text += std::to_string(theta) + " " + std::to_string(phi) + "\n";
      for (int out = 10; out <= 70; out += 20) {
        for (int turn = 0; turn < 360; turn += 60) {
          const double f = 0.2 + 0.05 * (std::cos(2 * phi * kDegree) + std::cos(2 * (phi + turn) * kDegree));
          text += std::to_string(out) + " " + std::to_string(phi + turn) + " " + std::to_string(f) + "\n";
        }
      }
    }
  }
  write_file(directory.path() / "turned.txt", text);
  const auto brdf = load_measured(directory.path() / "turned.txt");
  EXPECT_FALSE(brdf.is_isotropic);
  // A sample: specular at 30, scattered at 30 + 60 degrees, so that the light is at 210.
  const std::vector<Directions> pair{{45 * kDegree, 30 * kDegree, (90.0 - 210) * kDegree, 210 * kDegree}};
  EXPECT_NEAR(brdf.at(pair).value(0, 0), 0.2 + 0.05 * (0.5 - 1), 1e-6);
}

TEST(FredFiles, WhatIsNotReadIsSaidWithItsLine) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text, const std::string& complaint) {
    expect_unreadable(directory.path() / "bad.txt", text, complaint);
  };
  const std::string start = kFredStart;
  refused("type bsdf_data\n", "line 1: the file ends; expected 'format angles=deg");
  refused("type bsdf_data\n10 0\n", "line 2: expected 'format angles=deg");
  refused("type bsdf_data\nformat angles=rad bsdf=value scale=1\n", "line 2: format 'angles=rad' is not read");
  refused("type bsdf_data\nformat angles=deg bsdf=log scale=1\n", "line 2: format 'bsdf=log' is not read");
  refused("type bsdf_data\nformat angles=deg bsdf=value scale=2\n", "line 2: format 'scale=2' is not read");
  refused(start + "1 2 3\n", "line 3: 3 numbers; expected the two angles of a specular direction");
  refused(start + "10 0\n5\n", "line 4: 1 numbers; expected theta, phi and a value");
  refused(start + "10 0\n5 0 .1 4\n", "line 4: more than 3 numbers");
  refused(start + "95 0\n", "line 3: polar angle 95; expected 0 to 90 degrees");
  refused(start + "10 0\n-5 0 1\n", "line 4: polar angle -5");
  refused(start + "10 0\n5 0 x\n", "line 4: 'x' is no finite number");
  refused(start + "10 0\n5 0 1\n", "1 samples; expected at least 8");
}

}  // namespace
}  // namespace lobe::test
