// ALTA files: text against binary, against an independent reading, every parametrisation, and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::Contains;
using ::testing::HasSubstr;

class Alta : public MeasuredData {
 protected:
  Alta() : MeasuredData("alta") {}
};

TEST_F(Alta, TextAndBinaryAreTheSameToTheDigitsOfTheText) {
  const auto text = load_measured(data_ / "brdf_small_simu_two_layers_txt.alta");
  const auto binary = load_measured(data_ / "brdf_small_simu_two_layers_binary.alta");
  EXPECT_THAT(text.channels, ::testing::ElementsAre("red", "green", "blue"));
  std::vector<Directions> pairs;
  for (int i = 0; i < 200; ++i) pairs.push_back({0.007 * i, 1.5 - 0.005 * i, 0.03 * i, 0});
  const auto one = text.at(pairs);
  const auto other = binary.at(pairs);
  // The text has 17 decimals: 95 of its 174 numbers are not those of the binary file to the last bit.
  EXPECT_LT((one.value - other.value).cwiseAbs().maxCoeff(), 1e-17);
  EXPECT_EQ(text.remarks, binary.remarks);
}

TEST_F(Alta, SmallFilesHaveTheValuesOfAnIndependentReader) {
  const auto brdf = load_measured(data_ / "brdf_small_simu_two_layers_txt.alta");
  const auto rows = number_rows(data_ / "brdf_small_simu_two_layers_txt.alta");
  ASSERT_EQ(rows.size(), 29U);
  // Viewers at the normal do not see delta_phi: all rows are at one point and count with their mean.
  std::vector<double> mean(3, 0.0);
  for (const auto& row : rows) {
    SCOPED_TRACE(::testing::PrintToString(row));
    ASSERT_EQ(row[0], 0);
    ASSERT_EQ(row[1], rows[0][1]);
    for (std::size_t c = 0; c < 3; ++c) mean[c] += row[3 + c] / 29;
  }
  const auto values = brdf.at(std::vector<Directions>{{rows[0][1], 0, 0, 0}}).value;
  for (std::size_t c = 0; c < 3; ++c) {
    SCOPED_TRACE(c);
    EXPECT_NEAR(values(0, static_cast<Eigen::Index>(c)), mean[c], 1e-12);
  }
}

TEST_F(Alta, RetroReflectorsHaveTheValuesOfAnIndependentReader) {
  const auto brdf = load_measured(data_ / "retro-3M-jaune.dat");
  const auto rows = number_rows(data_ / "retro-3M-jaune.dat");
  ASSERT_EQ(rows.size(), 7397U);
  int compared = 0;
  int near = 0;
  for (std::size_t i = 40; i < rows.size(); i += 350) {
    const double theta = std::hypot(rows[i][1], rows[i][2]);
    if (theta > 1.5) continue;
    const auto found = brdf.at(std::vector<Directions>{{rows[i][0], theta, std::atan2(rows[i][2], rows[i][1]), 0}});
    const double expected = rows[i][3] / std::cos(theta);
    // Twins by symmetry, of which the mean counts, are not the same at the flanks of the lobes.
    if (std::abs(found.value(0, 0) - expected) < 0.2 * expected) ++near;
    ++compared;
  }
  EXPECT_GE(compared, 18);
  EXPECT_GE(near, compared - 2);
  // Bright where light and viewer coincide, and less so beyond.
  const auto peak =
      brdf.at(std::vector<Directions>{{0.52, 0.52, 0, 0}, {0.52, 0.9, 0, 0}, {0.52, 0.52, pi / 2, 0}}).value;
  EXPECT_GT(peak(0, 0), 20 * peak(1, 0));
  EXPECT_GT(peak(0, 0), 20 * peak(2, 0));
}

TEST_F(Alta, SlicesAreFunctionsOfTheHalfVector) {
  const auto brdf = load_measured(data_ / "pink-felt-1d.alta");
  const auto rows = number_rows(data_ / "pink-felt-1d.alta");
  for (std::size_t i = 3; i < rows.size(); i += 4) {
    const double theta = std::acos(rows[i][0]);
    const auto values =
        brdf.at(std::vector<Directions>{{theta, theta, 0, 0}, {theta + 0.01, theta + 0.01, 0.0, 0}}).value;
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(values(0, static_cast<Eigen::Index>(c)), rows[i][1 + c], 1e-9) << i << " " << c;
  }
  // The mirror side has the half-vector at the normal.
  const auto values = brdf.at(std::vector<Directions>{{0.7, 0.7, pi, 0}, {0, 0, 0, 0}}).value;
  EXPECT_NEAR(values(0, 0), values(1, 0), 1e-12);
}

// --- Files of our own.

/// Reciprocal, by the cosines alone; its values tell parametrisations apart.
double reference(double theta_in, double theta_out, double delta_phi) {
  return 0.1 + 0.05 * std::cos(theta_in) * std::cos(theta_out) +
         0.03 * std::sin(theta_in) * std::sin(theta_out) * std::cos(delta_phi);
}

/// Samples at 500 pairs, written by `row`.
void write_alta(const fs::path& path, const std::string& header,
                const std::function<std::string(double, double, double, double)>& row) {
  std::ofstream file(path);
  file.precision(17);
  file << header;
  for (int i = 0; i < 500; ++i) {
    const double theta_in = 1.4 * std::fmod(0.618 * i, 1.0);
    const double theta_out = 1.4 * std::fmod(0.755 * i + 0.1, 1.0);
    const double delta_phi = pi * std::fmod(0.57 * i, 1.0);
    const double phi_in = 2 * pi * std::fmod(0.37 * i, 1.0);
    file << row(theta_in, theta_out, delta_phi, phi_in) << '\n';
  }
}

template <typename... Numbers>
std::string line_of(Numbers... numbers) {
  std::ostringstream text;
  text.precision(17);
  ((text << numbers << ' '), ...);
  return text.str();
}

void expect_reference(const fs::path& path, bool is_isotropic) {
  const auto brdf = load_measured(path);
  EXPECT_EQ(brdf.is_isotropic, is_isotropic);
  for (int i = 0; i < 20; ++i) {
    const Directions pair{0.06 * i, 1.2 - 0.05 * i, 0.15 * i, 0.3 * i};
    const double expected = reference(pair.theta_in, pair.theta_out, pair.delta_phi);
    EXPECT_NEAR(brdf.at(std::vector<Directions>{pair}).value(0, 0), expected, 0.03 * expected) << path << " " << i;
  }
}

TEST(AltaFiles, OfAllParametrisationsAreTheSameReflectance) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "samples.alta";
  write_alta(path, "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT INV_STERADIAN\n",
             [](double in, double out, double phi, double) { return line_of(out, in, phi, reference(in, out, phi)); });
  expect_reference(path, true);
  write_alta(path, "#DIM 3 1\n#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n#VS 2\n",
             [](double in, double out, double phi, double) {
               return line_of(in, out * std::cos(phi), out * std::sin(phi), reference(in, out, phi) * std::cos(out), 0,
                              1);
             });
  expect_reference(path, true);
  write_alta(path, "#DIM 4 1\n#PARAM_IN SPHERICAL_TL_PL_TV_PV\n#PARAM_OUT INV_STERADIAN\n#ALTA END HEADER\n",
             [](double in, double out, double phi, double turn) {
               return line_of(in, turn, out, turn + phi, reference(in, out, phi));
             });
  expect_reference(path, false);
  write_alta(path, "#DIM 6 1\n# a comment\n#PARAM_IN CARTESIAN\n#PARAM_OUT INV_STERADIAN\n#VS 1\n",
             [](double in, double out, double phi, double turn) {
               return line_of(std::sin(out) * std::cos(turn + phi), std::sin(out) * std::sin(turn + phi), std::cos(out),
                              std::sin(in) * std::cos(turn), std::sin(in) * std::sin(turn), std::cos(in),
                              reference(in, out, phi), 0.1);
             });
  expect_reference(path, false);
  // theta_h, theta_d and phi_d of the pair by dot products: N.H, L.H, and the part of N.(L - V) in the plane of N and
  // H.
  write_alta(path, "#DIM 3 1\n#PARAM_IN RUSIN_TH_TD_PD\n#PARAM_OUT INV_STERADIAN\n",
             [](double in, double out, double phi, double) {
               const double lv = std::cos(in) * std::cos(out) + std::sin(in) * std::sin(out) * std::cos(phi);
               const double theta_d = std::acos(std::min(1.0, lv)) / 2;
               const double theta_h =
                   std::acos(std::min(1.0, (std::cos(in) + std::cos(out)) / (2 * std::cos(theta_d))));
               const double along = (std::cos(out) - std::cos(in)) / (2 * std::sin(theta_h) * std::sin(theta_d));
               return line_of(theta_h, theta_d, std::acos(std::clamp(along, -1.0, 1.0)), reference(in, out, phi));
             });
  expect_reference(path, true);
}

TEST(AltaFiles, WithoutAKindOfValuesHoldReflectances) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "plain.alta";
  const auto row = [](double in, double out, double phi, double) {
    return line_of(out, in, phi, reference(in, out, phi));
  };
  write_alta(path, "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n", row);
  expect_reference(path, true);
  EXPECT_THAT(load_measured(path).remarks,
              Contains("the header has no PARAM_OUT; values are taken for sr^-1 without a cosine"));
  EXPECT_THAT(load_measured(path).conventions, HasSubstr("INV_STERADIAN,"));
  write_alta(path, "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT UNKNOWN_OUTPUT\n", row);
  expect_reference(path, true);
  EXPECT_THAT(load_measured(path).remarks, Contains(HasSubstr("the header says PARAM_OUT UNKNOWN_OUTPUT")));
}

std::string binary_header(int count) {
  return "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT INV_STERADIAN\n#VS 0\n#VERSION 0\n#FORMAT binary\n"
         "#ENDIAN little\n#PRECISION ieee754-double\n#SAMPLE_COUNT " +
         std::to_string(count) + "\n#ALTA_END_HEADER\n";
}

std::string bytes_of(const std::vector<double>& numbers) {
  std::string bytes(numbers.size() * sizeof(double), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

TEST(AltaFiles, OfBothBinaryVariantsAreTheSame) {
  const TemporaryDirectory directory;
  std::vector<double> numbers;
  for (int i = 0; i < 30; ++i) {
    for (const double x : {0.04 * i, 0.9 - 0.02 * i, 0.1 * i, 0.2 + 0.01 * i}) numbers.push_back(x);
  }
  const fs::path one = directory.path() / "one.alta";
  const fs::path other = directory.path() / "other.alta";
  std::ofstream(one, std::ios::binary) << binary_header(30) << bytes_of(numbers);
  std::ofstream(other, std::ios::binary) << binary_header(30) << "#BEGIN_STREAM\n"
                                         << bytes_of(numbers) << "\n#END_STREAM\n";
  const std::vector<Directions> pair{{0.9 - 0.02 * 7, 0.04 * 7, 0.7, 0}};
  EXPECT_NEAR(load_measured(one).at(pair).value(0, 0), 0.27, 1e-12);
  EXPECT_EQ(load_measured(one).at(pair).value, load_measured(other).at(pair).value);
}

TEST(AltaFiles, AreWrittenAndReadBack) {
  const TemporaryDirectory directory;
  BrdfFunction brdf;
  brdf.name = "reference";
  brdf.channels = {"red", "green", "blue"};
  brdf.is_bilateral = true;
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues found{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), 3), {}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double value = reference(pairs[i].theta_in, pairs[i].theta_out, pairs[i].delta_phi);
      found.value.row(static_cast<Eigen::Index>(i)) << value, 2 * value, 3 * value;
    }
    return found;
  };
  const fs::path path = directory.path() / "written.alta";
  save_measured(device(), brdf, "alta", path, {.command_line = "lobe export\nreference"});
  const auto rows = number_rows(path);
  EXPECT_EQ(rows.size(), 18U * 18 * 19);
  const auto read = load_measured(path);
  EXPECT_EQ(read.channels, brdf.channels);
  const double degree = pi / 180;
  const std::vector<Directions> pairs{{25 * degree, 60 * degree, 70 * degree, 0},
                                      {45 * degree, 70 * degree, 120 * degree, 0}};
  EXPECT_LT((read.at(pairs).value - brdf.at(pairs).value).cwiseAbs().maxCoeff(), 1e-12);
  brdf.is_isotropic = false;
  EXPECT_THROW(save_measured(device(), brdf, "alta", directory.path() / "not.alta"), ArgumentError);
}

TEST(AltaFiles, ThatAreDamagedAreRefused) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text, const std::string& complaint) {
    const fs::path path = directory.path() / "damaged.alta";
    std::ofstream(path, std::ios::binary) << text;
    try {
      (void)load_measured(path);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  };
  const std::string start = "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n";
  refused("#DIM 2 1\n#PARAM_IN STARK_2D\n", "line 2: PARAM_IN STARK_2D is not read; those that are: RUSIN_TH_TD_PD");
  refused("#DIM 4 1\n#PARAM_IN COS_TH\n#PARAM_OUT INV_STERADIAN\n1 1\n",
          "line 1: DIM has 4 inputs; PARAM_IN COS_TH has 1");
  refused("#DIM 1e9 1\n#PARAM_IN COS_TH\n", "line 1: no number of inputs");
  refused(start + "#PARAM_OUT ENERGY\n", "line 3: PARAM_OUT 'ENERGY' is not read");
  refused("#PARAM_OUT ENERGY\n" + start + "#VS 0\n", "line 1: PARAM_OUT 'ENERGY' is not read");
  refused("#DIM 3 0\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n", "line 1: DIM has no outputs");
  refused("#VS 2 2\n" + start + "#PARAM_OUT INV_STERADIAN\n", "line 1: VS has more intervals than outputs");
  refused(start + "#PARAM_OUT RGB_COLOR\n", "line 3: RGB_COLOR has 1 outputs; expected 3");
  refused("#PARAM_OUT RGB_COLOR\n" + start, "line 1: RGB_COLOR has 1 outputs; expected 3");
  refused(start + "#PARAM_OUT INV_STERADIAN\n#VS 7\n", "line 4: VS is neither 0, 1 nor 2");
  refused(start + "#PARAM_OUT INV_STERADIAN\n0 0 0 1\n0 0 0\n", "line 5: 3 numbers; expected 4");
  refused(start + "#PARAM_OUT INV_STERADIAN\n0 0 0 nan\n", "line 4: 'nan' is no finite number");
  refused(start + "#PARAM_OUT INV_STERADIAN\n#ENDIAN big\n", "line 4: ENDIAN big; expected little");
  refused(start + "#PARAM_OUT INV_STERADIAN\n0 0 0 1\n", "1 samples; expected at least 8");
  refused(binary_header(2) + bytes_of({0, 0, 0, 1}), "the file ends after 1 of 2 samples");
  refused(binary_header(2000000000) + bytes_of({0, 0, 0, 1}), "the file ends after 1 of 2000000000 samples");
  refused(binary_header(1) + bytes_of({0, 0, 0, 1, 2}), "the file goes on after the last sample");
  refused(binary_header(1) + bytes_of({0, 0, std::nan(""), 1}), "no finite number");
  refused("#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT INV_STERADIAN\n#FORMAT binary\n",
          "without #SAMPLE_COUNT");
}

}  // namespace
}  // namespace lobe::test
