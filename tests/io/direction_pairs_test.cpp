// Values at lists of pairs of directions: what a list may look like, and what is written for it.
#include "lobe/formats/direction_pairs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "formats/npy.hpp"
#include "hdf5/hdf5_input.hpp"
#include "io/measured_files.hpp"
#include "lobe/core/directions.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Tells every coordinate from the others, and a turn of an azimuth from none.
double told(const Directions& at) {
  return at.theta_in + 10 * at.theta_out + 100 * std::cos(at.delta_phi) + 1000 * std::sin(at.phi_in);
}

BrdfFunction function(std::vector<std::string> channels = {"value"}, bool has_errors = false) {
  BrdfFunction brdf;
  brdf.name = "told";
  brdf.channels = std::move(channels);
  brdf.is_isotropic = false;
  const auto count = static_cast<Eigen::Index>(brdf.channels.size());
  brdf.at = [count, has_errors](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), count);
    for (Eigen::Index i = 0; i < values.value.rows(); ++i) {
      for (Eigen::Index c = 0; c < count; ++c) {
        values.value(i, c) = told(pairs[static_cast<std::size_t>(i)]) * static_cast<double>(c + 1);
      }
    }
    if (has_errors) values.error = values.value / 1000;
    return values;
  };
  return brdf;
}

class DirectionPairs : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return directory_.path() / name; }

  /// The rows of CSV for a list, the heading first.
  std::vector<std::string> answer(const std::string& list, const PairOptions& options = {},
                                  const BrdfFunction& brdf = function()) const {
    write_file(file("pairs.csv"), list);
    std::string text;
    summary_ = evaluate_pairs(device(), brdf, file("pairs.csv"), text, options);
    std::vector<std::string> rows;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) rows.push_back(line);
    return rows;
  }
  /// The value of the only row.
  double value(const std::string& list, const PairOptions& options = {}) const {
    const auto rows = answer(list, options);
    EXPECT_EQ(rows.size(), 2U);
    return std::stod(rows.back().substr(rows.back().rfind(',') + 1));
  }
  void expect_refusal(const std::string& list, const std::string& complaint, const PairOptions& options = {}) const {
    expect_complaint([&] { (void)answer(list, options); }, complaint);
    expect_complaint([&] { (void)answer(list, options); }, "pairs.csv");
  }

  mutable PairSummary summary_;

 private:
  TemporaryDirectory directory_;
};

TEST_F(DirectionPairs, SayTheSameInAnglesAndVectors) {
  const Directions at{.theta_in = 30 * kDegree, .theta_out = 70 * kDegree, .delta_phi = 100 * kDegree, .phi_in = 0.3};
  const double isotropic = told({at.theta_in, at.theta_out, at.delta_phi, 0});
  EXPECT_DOUBLE_EQ(value("theta_in,theta_out,delta_phi\n30,70,100\n"), isotropic);
  EXPECT_DOUBLE_EQ(value("30 70 100\n"), isotropic);

  const double phi_in = at.phi_in / kDegree;
  std::ostringstream four;
  four.precision(17);
  four << "30;" << phi_in << ";70;" << phi_in + 100 << "\n";
  EXPECT_NEAR(value(four.str()), told(at), 1e-10);
  EXPECT_NEAR(value("phi_in;theta_in;phi_out;theta_out\n" + std::to_string(phi_in) + ";30;" +
                    std::to_string(phi_in + 100) + ";70\n"),
              told(at), 1e-3);
  std::ostringstream azimuth;
  azimuth.precision(17);
  azimuth << "delta_phi\tphi_in\ttheta_out\ttheta_in\n100\t" << phi_in << "\t70\t30\n";
  EXPECT_NEAR(value(azimuth.str()), told(at), 1e-10);

  // Three times and half as long as a unit vector.
  const double phi_out = at.phi_in + at.delta_phi;
  std::ostringstream vectors;
  vectors.precision(17);
  vectors << 3 * std::sin(at.theta_in) * std::cos(at.phi_in) << ',' << 3 * std::sin(at.theta_in) * std::sin(at.phi_in)
          << ',' << 3 * std::cos(at.theta_in) << ',' << std::sin(at.theta_out) * std::cos(phi_out) / 2 << ','
          << std::sin(at.theta_out) * std::sin(phi_out) / 2 << ',' << std::cos(at.theta_out) / 2 << '\n';
  EXPECT_NEAR(value(vectors.str()), told(at), 1e-10);
  EXPECT_NEAR(value("x_in,y_in,z_in,x_out,y_out,z_out\n" + vectors.str()), told(at), 1e-10);
}

/// Two channels and replicates of them that lie so far apart.
BrdfFunction replicated(const std::vector<double>& offsets) {
  BrdfFunction brdf = function({"red", "green"});
  brdf.replicates = offsets.size();
  brdf.channels.resize(2 + 2 * offsets.size(), "copy");
  brdf.at = [offsets](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.setZero(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(2 + 2 * offsets.size()));
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      values.value.col(static_cast<Eigen::Index>(2 + 2 * k)).setConstant(offsets[k]);
      values.value.col(static_cast<Eigen::Index>(3 + 2 * k)).setConstant(3 * offsets[k]);
    }
    return values;
  };
  return brdf;
}

TEST_F(DirectionPairs, HaveStandardDeviationsBehindTheErrors) {
  // -1 and 1 scatter by sqrt(2) about their mean.
  const PairOptions options{.replicated = replicated({-1, 1})};
  const auto rows = answer("theta_in,theta_out,delta_phi\n10,20,30\n", options, function({"red", "green"}, true));
  EXPECT_EQ(rows.front(), "theta_in_deg,theta_out_deg,delta_phi_deg,red,green,red_error,green_error,red_std,green_std");
  const double root = std::sqrt(2.0);
  std::istringstream row(rows.back());
  std::vector<double> numbers;
  for (std::string field; std::getline(row, field, ',');) numbers.push_back(std::stod(field));
  ASSERT_EQ(numbers.size(), 9U);
  EXPECT_DOUBLE_EQ(numbers[7], root);
  EXPECT_DOUBLE_EQ(numbers[8], 3 * root);
}

// Fewer pairs than a chunk has rows were refused.
TEST_F(DirectionPairs, OfAShortListMakeAnHdf5File) {
  write_file(file("pairs.csv"), "10 20 30\n");
  (void)evaluate_pairs(device(), function(), file("pairs.csv"), file("values.h5"));
  const hdf5::InputFile input(file("values.h5"));
  EXPECT_DOUBLE_EQ(input.read("/brdf", std::array<hsize_t, 2>{1, 1}).front(),
                   told({10 * kDegree, 20 * kDegree, 30 * kDegree, 0}));
}

TEST_F(DirectionPairs, HaveADatasetOfStandardDeviations) {
  write_file(file("pairs.csv"), "10 20 30\n40 50 60\n");
  (void)evaluate_pairs(device(), function({"red", "green"}), file("pairs.csv"), file("values.h5"),
                       {.replicated = replicated({-1, 1})});
  const hdf5::InputFile input(file("values.h5"));
  const auto deviations = input.read("/brdf_std", std::array<hsize_t, 2>{2, 2});
  const double root = std::sqrt(2.0);
  using ::testing::DoubleEq;
  EXPECT_THAT(deviations, ElementsAre(DoubleEq(root), DoubleEq(3 * root), DoubleEq(root), DoubleEq(3 * root)));
}

TEST_F(DirectionPairs, RefuseReplicatesOfOtherChannels) {
  const std::string pair = "10 20 30\n";
  expect_complaint([&] { (void)answer(pair, {.replicated = function()}); }, "expected some of 1");
  expect_complaint(
      [&] {
        (void)answer(pair, {.replicated = replicated({-1, 1})});
      },
      "2 replicates of 2 channels; expected some of 1");
}

TEST_F(DirectionPairs, AreInDegreesUnlessSaidOtherwise) {
  const double expected = told({0.5, 1.2, 2, 0});
  EXPECT_DOUBLE_EQ(value("theta_in_rad,theta_out_rad,delta_phi_rad\n0.5,1.2,2\n"), expected);
  EXPECT_DOUBLE_EQ(value("theta_in,theta_out,delta_phi\n0.5,1.2,2\n", {.radians = true}), expected);
  EXPECT_THAT(summary_.directions, ElementsAre("theta_in_rad", "theta_out_rad", "delta_phi_rad"));
  EXPECT_DOUBLE_EQ(value("0.5,1.2,2\n", {.radians = true}), expected);
  EXPECT_DOUBLE_EQ(value("theta_in_deg,theta_out_rad,delta_phi\n5,1.2,90\n"),
                   told({5 * kDegree, 1.2, 90 * kDegree, 0}));
  EXPECT_DOUBLE_EQ(value("0.5,1.2,2\n"), told({0.5 * kDegree, 1.2 * kDegree, 2 * kDegree, 0}));
  expect_refusal("theta_in_deg,theta_out_deg,delta_phi_deg\n5,6,7\n", "in degrees; expected no other unit",
                 {.radians = true});
}

TEST_F(DirectionPairs, ThatMayBeRadiansAreTold) {
  const auto many = [](const std::string& row) {
    std::string list;
    for (int i = 0; i < 150; ++i) list += row;
    return list;
  };
  static_cast<void>(answer(many("0.5,1.2,2\n")));
  EXPECT_TRUE(summary_.may_be_radians);
  static_cast<void>(answer(many("0.5,1.2,2\n"), {.radians = true}));
  EXPECT_FALSE(summary_.may_be_radians);
  static_cast<void>(answer(many("0.5,1.2,2\n") + "0,7,0\n"));
  EXPECT_FALSE(summary_.may_be_radians);
  static_cast<void>(answer(many("0,0,1,0,0,1\n")));
  EXPECT_FALSE(summary_.may_be_radians);
  static_cast<void>(answer("0.5,1.2,2\n"));
  EXPECT_FALSE(summary_.may_be_radians);
}

TEST_F(DirectionPairs, HaveCommentsBlankLinesMarksAndOtherColumns) {
  const auto rows = answer(
      "\xef\xbb\xbf# from a goniometer\r\n\r\nsample,\"Theta_in\",theta_out,delta_phi,remark\r\n"
      "a 1,10,20,30,\r\n# between\r\nb,40,50,60,good");
  EXPECT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0], "theta_in_deg,theta_out_deg,delta_phi_deg,brdf");
  EXPECT_THAT(rows[1], ::testing::StartsWith("10,20,30,"));
  EXPECT_THAT(rows[2], ::testing::StartsWith("40,50,60,"));
  EXPECT_EQ(summary_.pairs, 2U);
}

TEST_F(DirectionPairs, HaveAColumnForEachChannelAndItsError) {
  EXPECT_EQ(answer("0,0,0\n", {}, function({"red", "green"})).front(),
            "theta_in_deg,theta_out_deg,delta_phi_deg,red,green");
  EXPECT_EQ(answer("0,0,0\n", {}, function({"1", "2"})).front(),
            "theta_in_deg,theta_out_deg,delta_phi_deg,brdf_1,brdf_2");
  EXPECT_EQ(answer("0,0,0\n", {}, function({"luminance"})).front(),
            "theta_in_deg,theta_out_deg,delta_phi_deg,luminance");
  const auto rows = answer("0,0,0\n", {}, function({"red", "green"}, true));
  EXPECT_EQ(rows[0], "theta_in_deg,theta_out_deg,delta_phi_deg,red,green,red_error,green_error");
  EXPECT_EQ(rows[1], "0,0,0,100,200,0.1,0.2");
}

TEST_F(DirectionPairs, ThatAreNoneAreNamedByTheirLine) {
  expect_refusal("theta_in,theta_out,delta_phi\n1,2,3\n\n# x\n1,95,3\n", "line 5: theta_out is 95, below the horizon");
  expect_refusal("1,2,3\n-1,2,3\n", "line 2: theta_in is -1; expected 0 to 90 degrees");
  expect_refusal("0.1,1.6,3\n", "line 1: theta_out is 1.6, below the horizon; expected 0 to pi/2 radians",
                 {.radians = true});
  expect_refusal("1,2,3\n1,2,nan\n", "line 2: 'nan' in column delta_phi_deg is no finite number");
  expect_refusal("1,2,3\n1,x,4\n", "line 2: 'x' in column theta_out_deg");
  expect_refusal("1,2,3\n1,2\n", "line 2: 2 columns; expected 3");
  expect_refusal("1,2,3\n1,2,\n", "line 2: '' in column delta_phi_deg");
  expect_refusal("1,2,3\n1,2,3,4\n", "line 2: 4 columns; expected 3");
  expect_refusal("0,0,1,0,0,1\n0,0,1,0.3,0,-0.1\n",
                 "line 2: the vector (0.3, 0, -0.1) of x_out, y_out, z_out is below");
  expect_refusal("0,0,0,0,0,1\n", "line 1: the vector (0, 0, 0) of x_in, y_in, z_in has no length");
  expect_refusal("1,2,3,4,5\n", "line 1: 5 columns without names; expected 3");
  expect_refusal("theta_in,theta_out,delta_phy\n1,2,3\n", "unknown column 'delta_phy'; did you mean 'delta_phi'?");
  expect_refusal("theta_in,theta_out,phi_out\n1,2,3\n",
                 "line 1: the columns theta_in, theta_out, phi_out are no pairs");
  expect_refusal("theta_in,theta_out,theta_in\n1,2,3\n", "'theta_in' is there twice");
  expect_refusal("# nothing\n", "no pairs of directions");
  expect_refusal("theta_in,theta_out,delta_phi\n", "no pairs of directions");
}

TEST_F(DirectionPairs, OfWhichSeveralAreNoneAreNamedByTheFirst) {
  std::string list;
  for (int i = 0; i < 40000; ++i) list += i == 9000 || i == 30000 ? "1,91,3\n" : "1,2,3\n";
  for (int i = 0; i < 5; ++i) expect_refusal(list, "line 9001: ");
}

TEST_F(DirectionPairs, OfManyBlocksStayInTheirOrderInEveryFormat) {
  constexpr std::size_t kPairs = 20000;  // of blocks of 8192
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 90);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < kPairs; ++i) {
    for (const double scale : {1.0, 4.0, 1.0, 4.0}) numbers.push_back(scale * uniform(random));
  }
  write_file(file("pairs.npy"), npy_content(std::array<std::size_t, 2>{kPairs, 4}, numbers));
  const BrdfFunction brdf = function({"red", "green"}, true);
  for (const auto* name : {"out.csv", "out.npy", "out.h5"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(evaluate_pairs(device(), brdf, file("pairs.npy"), file(name)).pairs, kPairs);
  }
  expect_complaint([&] { evaluate_pairs(device(), brdf, file("pairs.npy"), file("out.h5")); }, "exists");
  evaluate_pairs(device(), brdf, file("pairs.npy"), file("out.h5"), {.overwrite = true});

  const NpyArray values = read_npy(FileBytes::read(file("out.npy")));
  ASSERT_THAT(values.shape, ElementsAre(kPairs, 4U));
  std::istringstream csv(read_file(file("out.csv")));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,red,green,red_error,green_error");
  const hid_t id = H5Fopen(file("out.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const auto dataset = [&](const char* name, std::size_t count) {
    std::vector<double> found(count);
    const hid_t set = H5Dopen2(id, name, H5P_DEFAULT);
    EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, found.data()), 0);
    H5Dclose(set);
    return found;
  };
  EXPECT_EQ(dataset("directions", kPairs * 4), numbers);
  const auto red_and_green = dataset("brdf", kPairs * 2);
  const auto errors = dataset("brdf_error", kPairs * 2);
  H5Fclose(id);
  for (std::size_t i = 0; i < kPairs; ++i) {
    const double* at = &numbers[4 * i];
    const double expected = told({at[0] * kDegree, at[2] * kDegree, (at[3] - at[1]) * kDegree, at[1] * kDegree});
    const double* row = &values.values[4 * i];
    ASSERT_NEAR(row[0], expected, 1e-9) << i;
    ASSERT_EQ(row[1], 2 * row[0]) << i;
    ASSERT_EQ(row[2], row[0] / 1000) << i;
    ASSERT_EQ(red_and_green[2 * i], row[0]) << i;
    ASSERT_EQ(red_and_green[2 * i + 1], row[1]) << i;
    ASSERT_EQ(errors[2 * i + 1], row[3]) << i;
    std::getline(csv, line);
    std::istringstream cells(line);
    for (const double number : {at[0], at[1], at[2], at[3], row[0], row[1], row[2], row[3]}) {
      std::string cell;
      std::getline(cells, cell, ',');
      ASSERT_EQ(std::stod(cell), number) << i;
    }
  }
  EXPECT_FALSE(std::getline(csv, line));
}

TEST_F(DirectionPairs, InArraysAreNamedByTheirRow) {
  const auto refused = [&](std::span<const std::size_t> shape, const std::vector<double>& numbers,
                           const std::string& complaint) {
    write_file(file("pairs.npy"), npy_content(shape, numbers));
    std::string text;
    expect_complaint([&] { evaluate_pairs(device(), function(), file("pairs.npy"), text); }, complaint);
  };
  refused(std::array<std::size_t, 2>{2, 3}, {1, 2, 3, 4, 99, 6}, "row 2: theta_out is 99, below the horizon");
  refused(std::array<std::size_t, 2>{1, 3}, {1, std::nan(""), 3}, "row 1: nan in column theta_out_deg is no finite");
  refused(std::array<std::size_t, 2>{1, 5}, {1, 2, 3, 4, 5}, "5 columns without names");
  refused(std::array<std::size_t, 1>{3}, {1, 2, 3}, "an array of 1 dimensions; expected 2");
  refused(std::array<std::size_t, 2>{0, 3}, {}, "no pairs of directions");
}

TEST_F(DirectionPairs, LeaveNoFileWhereTheyFail) {
  write_file(file("pairs.csv"), "1,2,3\n1,2\n");
  for (const auto* name : {"out.csv", "out.npy", "out.h5"}) {
    SCOPED_TRACE(name);
    EXPECT_THROW(evaluate_pairs(device(), function(), file("pairs.csv"), file(name)), IoError);
    EXPECT_FALSE(std::filesystem::exists(file(name)));
  }
  EXPECT_THROW(evaluate_pairs(device(), function(), file("pairs.csv"), file("out.txt")), ArgumentError);
  write_file(file("pairs.csv"), "1,2,3\n");
  const PairOptions cancelled{.progress = [](std::string_view, double) { return false; }};
  EXPECT_THROW(evaluate_pairs(device(), function(), file("pairs.csv"), file("out.csv"), cancelled), Cancelled);
}

}  // namespace
}  // namespace lobe::test
