// ASTM rows, written by the test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "support/device.hpp"
#include "support/functions.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::HasSubstr;

/// Brighter towards the mirror side.
double astm_reference(double theta_in, double theta_out, double delta_phi) {
  return 0.2 - 0.1 * std::sin(theta_in) * std::sin(theta_out) * std::cos(delta_phi);
}

TEST(AstmFiles, HoldColumnsInAnyOrder) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "rows.astm";
  std::ofstream file(path);
  file.precision(17);
  file << "LAB_NAME here\r\nNUM_POINTS 60\r\nVARS 633nm,theta_s,phi_s,theta_i,phi_i,532nm\r\n";
  for (int i = 0; i < 60; ++i) {
    const double in = 1.4 * std::fmod(0.618 * i, 1);
    const double out = 1.4 * std::fmod(0.755 * i, 1);
    const double phi = 6.2 * std::fmod(0.57 * i, 1);
    const double value = astm_reference(in, out, phi);
    file << 2 * value << ',' << out << ',' << phi + 0.5 << ',' << in << ",0.5," << value << "\r\n";
  }
  file.close();
  const auto brdf = load_measured(path);
  EXPECT_THAT(brdf.channels, ::testing::ElementsAre("633 nm", "532 nm"));
  EXPECT_EQ(brdf.wavelengths, (std::vector<double>{633, 532}));
  EXPECT_TRUE(brdf.is_bilateral);
  for (int i = 0; i < 60; i += 3) {
    const Directions pair{1.4 * std::fmod(0.618 * i, 1), 1.4 * std::fmod(0.755 * i, 1), 6.2 * std::fmod(0.57 * i, 1),
                          0};
    const auto values = brdf.at(std::vector<Directions>{pair}).value;
    const double expected = astm_reference(pair.theta_in, pair.theta_out, pair.delta_phi);
    EXPECT_NEAR(values(0, 0), 2 * expected, 1e-9) << i;
    EXPECT_NEAR(values(0, 1), expected, 1e-9) << i;
  }
  const auto sides = brdf.at(std::vector<Directions>{{1, 1, pi, 0}, {1, 1, 0.1, 0}}).value;
  EXPECT_GT(sides(0, 0), sides(1, 0));
}

TEST(AstmFiles, WithSeveralAzimuthsOfTheLightAreAnisotropic) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "rows.astm";
  std::ofstream file(path);
  file << "VARS theta_i,phi_i,theta_s,phi_s,R,G,B\n";
  for (int i = 0; i < 40; ++i) file << 0.03 * i << ',' << 0.15 * i << ',' << 0.5 << ',' << 0.3 * i << ",0.1,0.2,0.3\n";
  file.close();
  const auto brdf = load_measured(path);
  EXPECT_FALSE(brdf.is_isotropic);
  EXPECT_THAT(brdf.channels, ::testing::ElementsAre("red", "green", "blue"));
  EXPECT_NEAR(brdf.at(std::vector<Directions>{{0.4, 0.6, 1, 2}}).value(0, 2), 0.3, 1e-9);
}

TEST(AstmFiles, ThatAreDamagedAreRefused) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text, const std::string& complaint) {
    const fs::path path = directory.path() / "damaged.astm";
    std::ofstream(path) << text;
    try {
      (void)load_measured(path);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  };
  refused("VARS theta_i,phi_i,theta_s,value\n", "line 1: VARS has no 'phi_s'");
  refused("LAB x\nVARS theta_i,phi_i,theta_s,phi_s\n", "line 2: VARS has no column of values");
  const std::string start = "VARS theta_i,phi_i,theta_s,phi_s,f\n";
  refused(start + "0,0,0,0\n", "line 2: 4 numbers; expected 5");
  refused(start + "0,0,0,0,x\n", "line 2: 'x' is no finite number");
  refused(start + "30,0,0,0,0.1\n", "line 2: polar angle 30; expected 0 to pi/2");
  refused("NUM_POINTS 7\n" + start + "0,0,0,0,1\n", "1 rows; NUM_POINTS announces 7");
  refused(start, "0 samples; expected at least 8");
}

TEST(AstmFiles, AreWrittenInRadiansDenseAboutTheSpecularDirection) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "written.astm";
  BrdfFunction brdf;
  brdf.name = "reference";
  brdf.channels = {"532 nm", "633 nm"};
  brdf.wavelengths = {532, 633};
  brdf.is_bilateral = true;
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues found{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), 2), {}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double value = astm_reference(pairs[i].theta_in, pairs[i].theta_out, pairs[i].delta_phi);
      found.value.row(static_cast<Eigen::Index>(i)) << value, 2 * value;
    }
    return found;
  };
  save_measured(device(), brdf, "astm", path, {.command_line = "lobe export\nreference"});
  std::ifstream file(path);
  std::string line;
  std::size_t points = 0;
  while (std::getline(file, line) && !line.starts_with("VARS")) {
    if (line.starts_with("NUM_POINTS ")) points = std::stoul(line.substr(11));
  }
  EXPECT_EQ(line, "VARS theta_i,phi_i,theta_s,phi_s,532nm,633nm");
  std::size_t rows = 0;
  std::size_t near_mirror = 0;
  for (; std::getline(file, line); ++rows) {
    std::array<double, 6> row{};
    std::ranges::replace(line, ',', ' ');
    std::istringstream numbers(line);
    for (double& one : row) numbers >> one;
    ASSERT_TRUE(numbers) << line;
    const auto [theta_i, phi_i, theta_s, phi_s, first, second] = row;
    EXPECT_NEAR(first, astm_reference(theta_i, theta_s, phi_s - phi_i), 1e-12) << line;
    EXPECT_NEAR(second, 2 * first, 1e-12) << line;
    if (std::abs(theta_s - theta_i) < 0.06 && std::cos(phi_s - phi_i) < -0.998) ++near_mirror;
  }
  EXPECT_EQ(rows, points);
  EXPECT_GT(near_mirror, rows / 8);
  const auto read = load_measured(path);
  EXPECT_EQ(read.wavelengths, brdf.wavelengths);
  const std::vector<Directions> pairs{{0.43, 0.7, 2, 0}, {1.1, 0.3, 0.5, 0}};
  EXPECT_LT((read.at(pairs).value - brdf.at(pairs).value).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(AstmFiles, OfAnisotropicReflectancesHaveAzimuthsOfTheLight) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "brushed.astm";
  const auto value = [](const Directions& pair) {
    return 0.2 + 0.1 * std::cos(2 * pair.phi_in) * std::cos(pair.phi_in + pair.delta_phi) * std::sin(pair.theta_out);
  };
  BrdfFunction brdf = function_of(value);
  brdf.is_isotropic = false;
  save_measured(device(), brdf, "astm", path);
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line) && !line.starts_with("VARS")) {
  }
  std::set<double> azimuths;
  while (std::getline(file, line)) {
    std::array<double, 5> row{};
    std::ranges::replace(line, ',', ' ');
    std::istringstream numbers(line);
    for (double& one : row) numbers >> one;
    ASSERT_TRUE(numbers) << line;
    const auto [theta_i, phi_i, theta_s, phi_s, written] = row;
    EXPECT_TRUE(phi_s >= 0 && phi_s < 2 * pi) << line;
    EXPECT_NEAR(written, value({theta_i, theta_s, phi_s - phi_i, phi_i}), 1e-12) << line;
    azimuths.insert(phi_i);
  }
  EXPECT_EQ(azimuths.size(), 12U);
}

TEST(AstmFiles, HoldChannelsWithPlainNames) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "not.astm";
  BrdfFunction brdf;
  brdf.name = "odd";
  brdf.channels = {"a, b"};
  brdf.at = [](std::span<const Directions> pairs) {
    return BrdfValues{Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(pairs.size()), 1), {}};
  };
  EXPECT_THROW(save_measured(device(), brdf, "astm", path), ArgumentError);
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace lobe::test
