// Plain tables: values of the rows themselves, linear between them, and what is written reads back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Csv : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path() const { return directory_.path() / "table.csv"; }

  [[nodiscard]] BrdfFunction read(const std::string& text, const ReadOptions& options = {}) const {
    std::ofstream(path(), std::ios::binary) << text;
    return load_measured(path(), options);
  }

  void expect_refusal(const std::string& text, const std::string& complaint) const {
    try {
      (void)read(text);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  }

  TemporaryDirectory directory_;
};

double value(const BrdfFunction& brdf, const Directions& degrees, Eigen::Index channel = 0) {
  const std::vector<Directions> pair{
      {degrees.theta_in * kDegree, degrees.theta_out * kDegree, degrees.delta_phi * kDegree, degrees.phi_in * kDegree}};
  return brdf.at(pair).value(0, channel);
}

/// Neither reciprocal nor symmetric.
BrdfFunction crooked(bool is_isotropic) {
  BrdfFunction brdf;
  brdf.name = "crooked";
  brdf.channels = {"532 nm", "633 nm"};
  brdf.is_isotropic = is_isotropic;
  brdf.at = [is_isotropic](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 2);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [in, out, delta_phi, phi_in] = pairs[i];
      const double f = 1 + in + 2 * out * out + std::sin(delta_phi) + (is_isotropic ? 0 : std::cos(2 * phi_in));
      values.value.row(static_cast<Eigen::Index>(i)) << f, f / 3;
    }
    return values;
  };
  return brdf;
}

constexpr const char* kSmall =
    "# a comment, with commas\n"
    "theta_in_deg,theta_out_deg,delta_phi_deg,red, blue \r\n"
    "\n"
    "0,10,0,1,-8\n"
    "0,10,180,2,8\n"
    "60,10,180,4,0.5\n"
    "60,10,0,3,8\n"
    "# another\n"
    "0,50,0,5,8\n"
    "0,50,180,6,8\n"
    "60,50,0,7,8\n"
    "60,50,180,+8e0,8";

TEST_F(Csv, RowsInAnyOrderAreTheValuesAtTheirDirections) {
  const auto brdf = read(kSmall);
  EXPECT_THAT(brdf.channels, ElementsAre("red", "blue"));
  EXPECT_TRUE(brdf.wavelengths.empty());
  EXPECT_TRUE(brdf.is_isotropic);
  EXPECT_THAT(brdf.remarks,
              ElementsAre("1 of 16 values are negative, and kept", HasSubstr("its last line is not ended")));
  EXPECT_EQ(value(brdf, {0, 10, 0, 0}), 1);
  EXPECT_EQ(value(brdf, {60, 10, 0, 0}), 3);
  EXPECT_EQ(value(brdf, {60, 10, 180, 0}), 4);
  EXPECT_EQ(value(brdf, {60, 10, 180, 0}, 1), 0.5);
  EXPECT_EQ(value(brdf, {60, 50, 180, 0}), 8);
}

TEST_F(Csv, BetweenRowsValuesAreLinearInEachAngle) {
  const auto brdf = read(kSmall);
  EXPECT_NEAR(value(brdf, {15, 10, 0, 0}), 1.5, 1e-14);
  EXPECT_NEAR(value(brdf, {0, 20, 0, 0}), 2, 1e-14);
  EXPECT_NEAR(value(brdf, {0, 10, 45, 0}), 1.25, 1e-14);
  // 1 + 2 (in/60) + 4 (out-10)/40 + phi/180.
  EXPECT_NEAR(value(brdf, {30, 30, 90, 0}), 4.5, 1e-14);
}

TEST_F(Csv, BeyondTheOutermostAnglesValuesStay) {
  const auto brdf = read(kSmall);
  EXPECT_NEAR(value(brdf, {89, 50, 180, 0}), 8, 1e-14);
  EXPECT_NEAR(value(brdf, {0, 89, 0, 0}), 5, 1e-14);
  EXPECT_NEAR(value(brdf, {0, 0, 0, 0}), 1, 1e-14);
}

TEST_F(Csv, AzimuthsUpToHalfATurnServeBothSides) {
  const auto brdf = read(kSmall);
  EXPECT_TRUE(brdf.is_bilateral);
  EXPECT_EQ(value(brdf, {60, 20, -70, 0}), value(brdf, {60, 20, 70, 0}));
  EXPECT_NEAR(value(brdf, {60, 20, 290, 0}), value(brdf, {60, 20, 70, 0}), 1e-14);
}

TEST_F(Csv, AzimuthsOfAWholeTurnAreACircle) {
  const auto brdf =
      read("theta_in_deg,theta_out_deg,delta_phi_deg,value\n0,0,-90,4\n0,0,0,1\n0,0,90,2\n0,0,180,3\n0,0,360,1\n");
  EXPECT_FALSE(brdf.is_bilateral);
  EXPECT_EQ(value(brdf, {0, 0, 270, 0}), 4);
  EXPECT_NEAR(value(brdf, {0, 0, 315, 0}), 2.5, 1e-14);
  EXPECT_NEAR(value(brdf, {0, 0, -45, 0}), 2.5, 1e-14);
  EXPECT_NEAR(value(brdf, {0, 0, 45, 0}), 1.5, 1e-14);
  EXPECT_NEAR(value(brdf, {0, 0, 225 + 720, 0}), 3.5, 1e-13);
}

TEST_F(Csv, IsotropicFunctionsAreWrittenAndReadBack) {
  const auto brdf = crooked(true);
  save_measured(device(), brdf, "csv", path());
  const auto back = load_measured(path());
  EXPECT_THAT(back.channels, ElementsAre("532 nm", "633 nm"));
  EXPECT_THAT(back.wavelengths, ElementsAre(532, 633));
  EXPECT_TRUE(back.is_isotropic);
  EXPECT_FALSE(back.is_bilateral);
  const auto rows = number_rows(path());
  ASSERT_EQ(rows.size(), 19U * 19U * 72U);
  for (std::size_t i = 7; i < rows.size(); i += 1299) {
    const auto& row = rows[i];
    const Directions degrees{row[0], row[1], row[2], 0};
    EXPECT_EQ(row[3], value(brdf, degrees)) << i;
    EXPECT_NEAR(value(back, degrees), row[3], 1e-14) << i;
    EXPECT_NEAR(value(back, degrees, 1), row[4], 1e-14) << i;
  }
}

TEST_F(Csv, AnisotropicFunctionsAreWrittenAndReadBack) {
  const auto brdf = crooked(false);
  save_measured(device(), brdf, "csv", path(), {.command_line = "lobe export\nx"});
  std::ifstream file(path());
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(text, HasSubstr("# written by: lobe export\\x0ax\n"));
  EXPECT_THAT(text, HasSubstr("\ntheta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,532 nm,633 nm\n"));
  const auto back = load_measured(path());
  EXPECT_FALSE(back.is_isotropic);
  const auto rows = number_rows(path());
  ASSERT_EQ(rows.size(), 10U * 24U * 10U * 24U);
  for (std::size_t i = 11; i < rows.size(); i += 2879) {
    const auto& row = rows[i];
    EXPECT_NEAR(value(back, {row[0], row[2], row[3] - row[1], row[1]}), row[4], 1e-12) << i;
  }
}

TEST_F(Csv, AnisotropicValuesAreLinearInFourAngles) {
  save_measured(device(), crooked(false), "csv", path());
  const auto back = load_measured(path());
  std::map<std::array<double, 4>, double> table;
  for (const auto& row : number_rows(path())) table[{row[0], row[1], row[2], row[3]}] = row[4];
  for (int i = 0; i < 20; ++i) {
    const double theta_in = 3.9 * i;
    const double phi_in = 17.3 * i;
    const double theta_out = 79 - 3.7 * i;
    const double phi_out = 359.9 - 16.1 * i;
    const auto below = [](double x, double step) { return step * std::floor(x / step); };
    double expected = 0;
    for (int corner = 0; corner < 16; ++corner) {
      double weight = 1;
      std::array<double, 4> node{};
      const std::array<double, 4> at{theta_in, phi_in, theta_out, phi_out};
      for (std::size_t a = 0; a < 4; ++a) {
        const double step = a % 2 == 0 ? 10 : 15;
        const double share = (at[a] - below(at[a], step)) / step;
        const bool is_upper = (corner >> a) % 2 == 1;
        weight *= is_upper ? share : 1 - share;
        node[a] = below(at[a], step) + (is_upper ? step : 0);
        if (a % 2 == 1) node[a] = std::fmod(node[a], 360);
      }
      expected += weight * table.at(node);
    }
    EXPECT_NEAR(value(back, {theta_in, theta_out, phi_out - phi_in, phi_in}), expected, 1e-12) << i;
  }
}

/// A gloss over a ground, reciprocal, with streaks along x for a share of it.
double streaky(double theta_in, double phi_in, double theta_out, double phi_out, double share) {
  const auto x = [](double theta, double phi) { return std::sin(theta * kDegree) * std::cos(phi * kDegree); };
  const auto y = [](double theta, double phi) { return std::sin(theta * kDegree) * std::sin(phi * kDegree); };
  const double along = x(theta_in, phi_in) + x(theta_out, phi_out);
  const double across = y(theta_in, phi_in) + y(theta_out, phi_out);
  return 0.1 + 0.3 * std::exp(-2 * across * across - (2 - share) * along * along);
}

TEST_F(Csv, RowsWithoutAGridAreScatteredSamples) {
  // Rings of viewers that are others for each light.
  std::string text = "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,550 nm,650 nm\n";
  std::vector<std::array<double, 4>> angles;
  for (int in = 0; in < 5; ++in) {
    for (int turn = 0; turn < 12; ++turn) {
      for (int ring = 0; ring < 6; ++ring) {
        for (int k = 0; k < 1 + 3 * ring; ++k) {
          angles.push_back({5.0 + 15 * in, 30.0 * turn, 14.0 * ring + in, 360.0 * k / (1 + 3 * ring) + 7 * turn});
        }
      }
    }
  }
  for (const auto& [in, phi_in, out, phi_out] : angles) {
    const double f = streaky(in, phi_in, out, phi_out, 1.5);
    text += std::to_string(in) + "," + std::to_string(phi_in) + "," + std::to_string(out) + "," +
            std::to_string(phi_out) + "," + std::to_string(f) + "," + std::to_string(2 * f) + "\n";
  }
  const auto brdf = read(text);
  EXPECT_FALSE(brdf.is_isotropic);
  EXPECT_THAT(brdf.wavelengths, ElementsAre(550, 650));
  EXPECT_THAT(brdf.remarks, ::testing::Contains(HasSubstr("3060 rows make no complete grid of 5 theta_in_deg x 12")));
  // Those that coincide by reciprocity have the same values; six decimals.
  for (std::size_t i = 5; i < angles.size(); i += 97) {
    SCOPED_TRACE(i);
    const auto& [in, phi_in, out, phi_out] = angles[i];
    EXPECT_NEAR(value(brdf, {in, out, phi_out - phi_in, phi_in}, 1), 2 * streaky(in, phi_in, out, phi_out, 1.5), 4e-6);
  }
  EXPECT_NEAR(value(brdf, {33, 40, 150, 12}), streaky(33, 12, 40, 162, 1.5), 0.02);
  EXPECT_NEAR(value(brdf, {40, 33, -150, 162}), value(brdf, {33, 40, 150, 12}), 1e-12);
}

TEST_F(Csv, ScatteredRowsWithoutAzimuthsOfTheLightAreIsotropic) {
  std::string three = "theta_in_deg,theta_out_deg,delta_phi_deg,value\n";
  std::string four = "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,value\n";
  for (int i = 0; i < 400; ++i) {
    const double in = std::fmod(29.7 * i, 80);
    const double out = std::fmod(17.1 * i, 80);
    const double phi = std::fmod(61.3 * i, 180);
    const std::string f = std::to_string(streaky(in, 0, out, phi, 0));
    three += std::to_string(in) + "," + std::to_string(out) + "," + std::to_string(phi) + "," + f + "\n";
    four += std::to_string(in) + ",20," + std::to_string(out) + "," + std::to_string(phi + 20) + "," + f + "\n";
  }
  const auto a = read(three);
  const auto b = read(four);
  EXPECT_TRUE(a.is_isotropic);
  EXPECT_TRUE(b.is_isotropic);
  EXPECT_TRUE(b.is_bilateral);
  for (const double phi : {10.0, 100.0, 170.0}) {
    SCOPED_TRACE(phi);
    // isotropic: share 0 makes both directions of the gloss alike
    EXPECT_NEAR(value(a, {30, 50, phi, 0}), streaky(30, 0, 50, phi, 0), 0.02);
    EXPECT_NEAR(value(b, {30, 50, phi, 0}), value(a, {30, 50, phi, 0}), 1e-9);
  }
}

TEST_F(Csv, ChannelsAreChosenByWavelength) {
  const std::string text = "theta_in_deg,theta_out_deg,delta_phi_deg,400 nm,500 nm\n0,0,0,1,3\n";
  EXPECT_NEAR(value(read(text, {.wavelengths = {450}}), {0, 0, 0, 0}), 2, 1e-14);
}

TEST_F(Csv, WhatIsNotReadIsSaidWithItsLine) {
  const std::string header = "theta_in_deg,theta_out_deg,delta_phi_deg,value\n";
  expect_refusal("# x\ntheta_in_deg,theta_out_deg,delta_phi_deg\n0,0,0",
                 "line 2: no column of values beside theta_in_deg,theta_out_deg,delta_phi_deg");
  expect_refusal("theta_in_deg,theta_out_deg,delta_phi_deg,red,\n0,0,0,1,1", "line 1: a channel without a name");
  expect_refusal(header, "line 1: no rows of numbers");
  expect_refusal(header + "0,0,0,nan\n", "line 2: 'nan' in column 4 is no finite number");
  expect_refusal(header + "0,0,0,1e999\n", "line 2: '1e999' in column 4");
  expect_refusal(header + "0,0,0\n", "line 2: expected 4 numbers");
  expect_refusal(header + "0,0,0,1,2\n", "line 2: expected 4 numbers");
  expect_refusal(header + "0,,0,1\n", "line 2: '' in column 2");
  expect_refusal(header + "\n91,0,0,1\n", "line 3: theta_in_deg of 91; expected 0 to 90");
  expect_refusal(header + "0,-1,0,1\n", "line 2: theta_out_deg of -1");
  expect_refusal(header + "0,0,0,1\n#\n0,0,0,2\n", "line 4: the directions of line 2 with other values");
  expect_refusal(header + "0,0,0,1\n10,20,0,2\n20,10,0,3\n",
                 "line 4: 3 rows make no complete grid of 3 theta_in_deg x 3 theta_out_deg x 1 delta_phi_deg");
  expect_refusal(header + "0,0,0,1\n10,0,0,2\n0,10,0,3\n0,0,360,1\n",
                 "line 5: 4 rows make no complete grid of 2 theta_in_deg x 2 theta_out_deg x 1 delta_phi_deg");
}

TEST_F(Csv, WithAByteOrderMarkIsRead) {
  // As spreadsheets save it.
  const auto brdf = read("\xEF\xBB\xBFtheta_in_deg,theta_out_deg,delta_phi_deg,value\r\n0,0,0,3\r\n");
  EXPECT_EQ(value(brdf, {0, 0, 0, 0}), 3);
}

TEST_F(Csv, ColumnsMayComeInAnyOrder) {
  const auto brdf = read("red,delta_phi_deg,theta_in_deg,green,theta_out_deg\n1,0,10,5,20\n2,180,10,6,20\n");
  EXPECT_THAT(brdf.channels, ElementsAre("red", "green"));
  EXPECT_EQ(value(brdf, {10, 20, 180, 0}), 2);
  EXPECT_EQ(value(brdf, {10, 20, 0, 0}, 1), 5);
}

TEST_F(Csv, WrongNamesOfColumnsAreNamed) {
  const std::string expected =
      "expected theta_in_deg,theta_out_deg,delta_phi_deg or theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg, degrees";
  expect_refusal("theta_in_deg,theta_out,delta_phi_deg,value\n0,0,0,1", "line 1: column 2 is 'theta_out'; " + expected);
  expect_refusal("theta_i,theta_o,phi,value\n0,0,0,1", "line 1: column 1 is 'theta_i'; " + expected);
  expect_refusal("theta_in_rad,theta_out_rad,delta_phi_rad,value\n0,0,0,1", "line 1: column 1 is 'theta_in_rad'; ");
  expect_refusal("phi_i,theta_i,phi_o,theta_o,value\n0,0,0,0,1", "line 1: column 1 is 'phi_i'; " + expected);
  expect_refusal("theta_in_deg,theta_out_deg,delta_phi_deg,phi_in_deg,value\n0,0,0,0,1", "column 4 is 'phi_in_deg'; ");
  expect_refusal("theta_in_deg,theta_out_deg,value\n0,0,1", "line 1: there is no column 'delta_phi_deg'; expected ");
  expect_refusal("theta_in_deg,phi_in_deg,theta_out_deg,value\n0,0,0,1", "line 1: there is no column 'phi_out_deg'; ");
  expect_refusal("theta_in_deg,theta_out_deg,delta_phi_deg,theta_in_deg,v\n0,0,0,0,1",
                 "two columns are 'theta_in_deg'");
  expect_refusal("theta_in_deg;theta_out_deg;delta_phi_deg;value\n0;0;0;1", "line 1: columns are apart by ';'; ");
  expect_refusal("theta_in_deg\ttheta_out_deg\tdelta_phi_deg\tvalue\n0\t0\t0\t1",
                 "columns are apart by tabs; expected ");
}

TEST_F(Csv, OfAGridThatIsCutShortIsRefusedAndOneWithHolesIsScattered) {
  std::vector<std::string> rows;
  for (int in : {0, 30, 60}) {
    for (int out : {0, 30, 60}) {
      for (int phi : {0, 90, 180}) {
        rows.push_back(std::to_string(in) + "," + std::to_string(out) + "," + std::to_string(phi) + ",1\n");
      }
    }
  }
  const std::string header = "theta_in_deg,theta_out_deg,delta_phi_deg,value\n";
  const auto text = [&](std::size_t first, std::size_t second) {
    std::string result = header;
    for (std::size_t i = 0; i < rows.size(); ++i) result += i == first || i == second ? "" : rows[i];
    return result;
  };

  expect_refusal(
      text(25, 26),
      "the file ends 2 rows before its grid of 3 theta_in_deg x 3 theta_out_deg x 3 delta_phi_deg is complete");
  EXPECT_THAT(read(text(4, 17)).remarks, ::testing::Contains(HasSubstr("25 rows make no complete grid of 3")));
}

TEST_F(Csv, WhatCannotBeHeldIsNotWritten) {
  auto brdf = crooked(true);
  brdf.channels = {"red, green", "blue"};
  EXPECT_THROW(save_measured(device(), brdf, "csv", path()), ArgumentError);
  brdf = crooked(true);
  brdf.at = [](std::span<const Directions> pairs) {
    return BrdfValues{Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(pairs.size()), 2, std::nan("")), {}};
  };
  EXPECT_THROW(save_measured(device(), brdf, "csv", path()), NumericError);
  EXPECT_FALSE(fs::exists(path()));
}

}  // namespace
}  // namespace lobe::test
