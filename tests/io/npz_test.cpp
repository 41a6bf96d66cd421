// Arrays of NumPy with their angles: values at and between them, stated errors, and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "formats/npy.hpp"
#include "io/measured_files.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/formats/measurement.hpp"
#include "support/temporary_directory.hpp"
#include "support/zipped.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Members = std::vector<std::pair<std::string, std::string>>;

std::pair<std::string, std::string> array(const std::string& name, const std::vector<std::size_t>& shape,
                                          const std::vector<double>& values) {
  return {name + ".npy", npy_content(shape, values)};
}
std::pair<std::string, std::string> list(const std::string& name, const std::vector<double>& values) {
  return array(name, {values.size()}, values);
}

std::vector<double> steps(double first, double step, double last) {
  std::vector<double> angles;
  for (int i = 0; first + i * step <= last + 1e-9; ++i) angles.push_back(first + i * step);
  return angles;
}

using Reflectance = std::function<double(double theta_in, double theta_out, double delta_phi)>;

/// An isotropic table, degrees.
Members members_of(const Reflectance& f, const std::vector<double>& theta, const std::vector<double>& phi) {
  std::vector<double> values;
  for (const double in : theta)
    for (const double out : theta)
      for (const double turn : phi) values.push_back(f(in * kDegree, out * kDegree, turn * kDegree));
  return {list("theta_in_deg", theta), list("theta_out_deg", theta), list("delta_phi_deg", phi),
          array("values", {theta.size(), theta.size(), phi.size()}, values)};
}

class Npz : public ::testing::Test {
 protected:
  BrdfFunction load(const Members& members, bool is_packed = false, const ReadOptions& options = {}) const {
    write_file(directory_.path() / "paint.npz", zipped(members, is_packed));
    return load_measured(directory_.path() / "paint.npz", options);
  }
  void refused(const std::string& content, const std::string& complaint) const {
    expect_unreadable(directory_.path() / "bad.npz", content, complaint);
  }
  static double value(const BrdfFunction& brdf, const Directions& degrees, Eigen::Index channel = 0) {
    return brdf
        .at(std::vector<Directions>{{degrees.theta_in * kDegree, degrees.theta_out * kDegree,
                                     degrees.delta_phi * kDegree, degrees.phi_in * kDegree}})
        .value(0, channel);
  }

  TemporaryDirectory directory_;
};

/// Neither reciprocal nor bilateral.
double crooked(double in, double out, double phi) {
  return 1 + in + 2 * out * out + std::sin(phi);
}

TEST_F(Npz, ValuesAreThoseOfTheArraysAndLinearBetween) {
  const auto theta = steps(0, 15, 75);
  const auto phi = steps(0, 30, 330);
  for (const bool is_packed : {false, true}) {
    SCOPED_TRACE(is_packed);
    const auto brdf = load(members_of(crooked, theta, phi), is_packed);
    EXPECT_EQ(brdf.name, "paint");
    EXPECT_TRUE(brdf.is_isotropic);
    EXPECT_FALSE(brdf.is_bilateral);
    EXPECT_THAT(brdf.channels, ElementsAre("value"));
    EXPECT_TRUE(brdf.remarks.empty());
    EXPECT_NEAR(value(brdf, {15, 45, 270, 0}), crooked(15 * kDegree, 45 * kDegree, 270 * kDegree), 1e-14);
    EXPECT_NEAR(value(brdf, {30, 60, -30, 0}), crooked(30 * kDegree, 60 * kDegree, -30 * kDegree), 1e-14);
    const double low = crooked(30 * kDegree, 60 * kDegree, 330 * kDegree);
    const double high = crooked(30 * kDegree, 60 * kDegree, 0);
    EXPECT_NEAR(value(brdf, {30, 60, 340, 0}), (2 * low + high) / 3, 1e-14);
    EXPECT_NEAR(value(brdf, {30, 89, 0, 0}), crooked(30 * kDegree, 75 * kDegree, 0), 1e-14);
  }
}

TEST_F(Npz, HalfATurnServesBothSidesAndAWholeOneCloses) {
  const auto even = [](double in, double out, double phi) { return 2 + in * out + std::cos(phi); };
  const auto half = load(members_of(even, steps(0, 30, 90), steps(0, 20, 180)));
  EXPECT_TRUE(half.is_bilateral);
  EXPECT_EQ(value(half, {30, 60, -50, 0}), value(half, {30, 60, 50, 0}));
  EXPECT_NEAR(value(half, {30, 60, 310, 0}), value(half, {30, 60, 50, 0}), 1e-14);
  const auto closed = load(members_of([](double, double, double phi) { return std::round(1e6 * (2 + std::cos(phi))); },
                                      steps(0, 30, 90), steps(-180, 20, 180)));
  const auto open = load(members_of([](double, double, double phi) { return std::round(1e6 * (2 + std::cos(phi))); },
                                    steps(0, 30, 90), steps(-180, 20, 160)));
  for (const double turn : {-190.0, -175.0, 0.0, 171.0, 200.0}) {
    SCOPED_TRACE(turn);
    EXPECT_NEAR(value(closed, {30, 60, turn, 0}), value(open, {30, 60, turn, 0}), 1e-6);
  }
}

TEST_F(Npz, RadiansChannelsAndAnisotropicArraysAreRead) {
  const std::vector<double> theta{0, 0.5, 1};
  const std::vector<double> phi{0, pi / 2, pi, 3 * pi / 2};
  std::vector<double> values;
  const auto f = [](double in, double phi_in, double out, double phi_out, int c) {
    return 1 + in + 2 * out + std::sin(phi_in) + 0.5 * std::cos(phi_out) + c;
  };
  for (const double in : theta)
    for (const double a : phi)
      for (const double out : theta)
        for (const double b : phi)
          for (const int c : {0, 1, 2}) values.push_back(f(in, a, out, b, c));
  std::string names = "\x93NUMPY";
  const std::string dictionary = "{'descr': '<U5', 'fortran_order': False, 'shape': (3,), }\n";
  names += {'\1', '\0', static_cast<char>(dictionary.size()), '\0'};
  names += dictionary;
  for (const std::string name : {"red", "green", "blue"}) {
    for (std::size_t i = 0; i < 5; ++i) names += {i < name.size() ? name[i] : '\0', '\0', '\0', '\0'};
  }
  const auto brdf = load({list("theta_in_rad", theta),
                          list("phi_in_rad", phi),
                          list("theta_out_rad", theta),
                          list("phi_out_rad", phi),
                          array("values", {3, 4, 3, 4, 3}, values),
                          {"channels.npy", names}});
  EXPECT_FALSE(brdf.is_isotropic);
  EXPECT_THAT(brdf.channels, ElementsAre("red", "green", "blue"));
  const std::vector<Directions> pair{{0.5, 1, pi / 2 - pi, pi}};
  for (const int c : {0, 1, 2}) EXPECT_NEAR(brdf.at(pair).value(0, c), f(0.5, pi, 1, pi / 2, c), 1e-14) << c;
  const std::vector<Directions> between{{0.25, 1, pi / 4 - pi, pi}};
  EXPECT_NEAR(brdf.at(between).value(0, 1),
              (f(0, pi, 1, 0, 1) + f(0, pi, 1, pi / 2, 1) + f(0.5, pi, 1, 0, 1) + f(0.5, pi, 1, pi / 2, 1)) / 4, 1e-14);
}

TEST_F(Npz, WavelengthsAndOtherArrays) {
  const auto brdf = load({list("theta_in_deg", {0, 60}), list("theta_out_deg", {0, 60}), list("delta_phi_deg", {0}),
                          array("values", {2, 2, 1, 2}, {1, 2, 1, 2, 1, 2, 1, -3}),
                          list("wavelengths_nm", {450, 550.5}), list("notes", {7})},
                         false, {.wavelengths = {500.25}});
  EXPECT_THAT(brdf.channels, ElementsAre("500.25 nm"));
  EXPECT_THAT(brdf.remarks, ElementsAre("1 of 8 values are negative, and kept", "array 'notes' is not used"));
  EXPECT_NEAR(value(brdf, {0, 0, 77, 0}), 1.5, 1e-14);
}

// --- The stated errors.

/// A lobe of a width about the mirror direction over a ground that grows towards the horizon.
Reflectance lobe(double width) {
  return [width](double in, double out, double phi) {
    const double mirror = std::cos(in) * std::cos(out) - std::sin(in) * std::sin(out) * std::cos(phi);
    const double angle = std::acos(std::clamp(mirror, -1.0, 1.0));
    return 0.2 + 0.1 * std::pow(std::sin(in) * std::sin(out), 2) + std::exp(-angle * angle / (2 * width * width));
  };
}

/// How many of arbitrary pairs within the grid are off by no more than stated, and the stated error over the true one
/// as norms.
std::pair<double, double> coverage(const BrdfFunction& brdf, const Reflectance& f, double theta_max, unsigned seed) {
  constexpr int kPairs = 4000;
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  int covered = 0;
  double stated = 0;
  double off = 0;
  for (int i = 0; i < kPairs; ++i) {
    const Directions pair{theta_max * uniform(engine), theta_max * uniform(engine), 2 * pi * uniform(engine), 0};
    const auto found = brdf.at(std::vector<Directions>{pair});
    const double error = std::abs(found.value(0, 0) - f(pair.theta_in, pair.theta_out, pair.delta_phi));
    if (error <= found.error(0, 0) + 1e-13) ++covered;
    stated += std::pow(found.error(0, 0), 2);
    off += error * error;
  }
  return {covered / static_cast<double>(kPairs), std::sqrt(stated / off)};
}

TEST_F(Npz, StatedErrorsCoverWhatInterpolationLoses) {
  // The margin was chosen on widths of 0.2 and 0.5; the others are held back.
  for (const double width : {0.2, 0.5, 0.13, 0.35, 0.8}) {
    for (const double step : {5.0, 7.5}) {
      const auto brdf = load(members_of(lobe(width), steps(0, step, 90), steps(0, step, 180)));
      const auto [share, ratio] = coverage(brdf, lobe(width), pi / 2, 7);
      // Without the margin 90 to 98 %. Tight: root mean squares are within 1.5 to 2 times the true ones.
      EXPECT_GE(share, 0.985) << width << " " << step;
      EXPECT_LE(ratio, 2.2) << width << " " << step;
      EXPECT_GE(ratio, 1.4) << width << " " << step;
    }
  }
}

TEST_F(Npz, ErrorsAreZeroAtTheAnglesAndUnknownBesideASingleOne) {
  const auto brdf = load(members_of(lobe(0.3), steps(0, 10, 90), steps(0, 20, 180)));
  EXPECT_EQ(brdf.at(std::vector<Directions>{{30 * kDegree, 40 * kDegree, 160 * kDegree, 0}}).error(0, 0), 0);
  const auto single = load(members_of(lobe(0.3), {30}, {0, 90, 180}));
  EXPECT_TRUE(std::isnan(single.at(std::vector<Directions>{{0.5, 0.6, 1, 0}}).error(0, 0)));
}

TEST_F(Npz, ErrorsOfTheValuesAreAdded) {
  const auto with_error = [&](double error) {
    auto members = members_of(lobe(0.5), steps(0, 10, 90), steps(0, 20, 180));
    members.push_back(array("error", {10, 10, 10}, std::vector<double>(1000, error)));
    return load(members).at(std::vector<Directions>{{0.3, 0.5, 1, 0}}).error(0, 0);
  };
  EXPECT_GT(with_error(0), 0);
  EXPECT_NEAR(with_error(0.25), with_error(0) + 0.25, 1e-12);
}

TEST_F(Npz, WhatIsNotReadIsSaidAtOnce) {
  const auto good = members_of(lobe(0.5), {0, 30, 60}, {0, 180});
  const auto without = [&](std::size_t index) {
    Members members = good;
    members.erase(members.begin() + static_cast<std::ptrdiff_t>(index));
    return members;
  };
  refused(zipped({list("theta_i", {1})}),
          "byte 0: it lacks the arrays theta_in_deg (or theta_in_rad), theta_out_deg (or theta_out_rad), delta_phi_deg "
          "(or delta_phi_rad), values; it has theta_i");
  refused(zipped(without(3)), "it lacks the arrays values; it has theta_in_deg, theta_out_deg, delta_phi_deg");
  const auto replaced = [&](std::size_t index, std::pair<std::string, std::string> member) {
    Members members = good;
    members[index] = std::move(member);
    return zipped(members);
  };
  refused(replaced(0, list("theta_in_deg", {0, 60, 30})),
          "bad.npz/theta_in_deg.npy: byte 0: element 2 is 30 degrees; expected rising angles from 0 to a right one");
  refused(replaced(0, list("theta_in_deg", {0, 60, 95})), "element 2 is 95 degrees");
  refused(replaced(0, list("theta_in_rad", {0, 1, 2})), "element 2 is 2; expected rising angles");
  refused(replaced(2, list("delta_phi_deg", {0, 400})), "azimuths span more than a whole turn");
  refused(replaced(3, array("values", {3, 2, 3}, std::vector<double>(18, 1))),
          "bad.npz/values.npy: byte 0: the shape is 3 x 2 x 3; expected 3 x 3 x 2 (theta_in x theta_out x delta_phi), "
          "with channels behind");
  refused(replaced(3, array("values", {3, 3, 2}, std::vector<double>(18, std::nan("")))),
          "element 0 is no finite number");
  Members twice = good;
  twice.push_back(list("theta_in_rad", {0, 0.5, 1}));
  refused(zipped(twice), "it has theta_in_deg and theta_in_rad; expected one of them");
  Members named = good;
  named.push_back(list("wavelengths_nm", {500, 600}));
  refused(zipped(named), "expected 1 wavelengths above 0, as many as channels");
  refused(replaced(2, list("delta_phi_deg", {-180, 180})), "values at the first and the last delta_phi");
  std::string damaged = zipped(good);
  damaged[damaged.find("NUMPY") + 130] ^= 1;  // of the first angle
  refused(damaged, "'theta_in_deg.npy' is damaged");
  refused(zipped(good).substr(0, 900), "it is no zip archive that can be read");
  std::string crowded = zipped(good);
  crowded.replace(crowded.size() - 14, 4, "\x30\x75\x30\x75");
  refused(crowded, "byte 0: it announces 30000 members, more than it can hold");
}

TEST_F(Npz, HasReplicatesWithinItsStandardDeviations) {
  Members members = members_of([](double, double, double) { return 0.2; }, {0, 45, 90}, {0, 90, 180});
  EXPECT_FALSE(load(members).has_deviations);
  members.push_back(array("std", {3, 3, 3}, std::vector<double>(27, 0.01)));
  EXPECT_TRUE(load(members).has_deviations);
  EXPECT_EQ(load(members).replicates, 0U);

  const BrdfFunction brdf = load(members, false, {.replicates = 2000});
  ASSERT_EQ(brdf.replicates, 2000U);
  const auto values = brdf.at(std::vector<Directions>{{45 * kDegree, 0, 0}}).value;
  EXPECT_EQ(values(0, 0), 0.2);
  const std::vector<double> numbers(values.row(0).begin(), values.row(0).end());
  EXPECT_NEAR(measurement_deviations(brdf, numbers)[0], 0.01, 4 * 0.01 / std::sqrt(4000.0));
}

// Waves that are turned by half a turn are the same across the seam as they are elsewhere.
TEST_F(Npz, StatesTheSameErrorAcrossTheSeamOfAzimuths) {
  const auto error_of = [&](double turn, double phi_deg) {
    const auto wave = load(members_of([turn](double, double, double phi) { return 2 + std::cos(phi - turn); },
                                      steps(0, 30, 90), steps(-180, 20, 160)));
    return wave.at(std::vector<Directions>{{0.5, 0.7, phi_deg * pi / 180, 0}}).error(0, 0);
  };
  // With the crest at the last node and at the first one.
  for (const double crest : {160 * pi / 180, pi}) {
    SCOPED_TRACE(crest);
    for (const double beside : {4.0, 10.0, 16.0}) {
      SCOPED_TRACE(beside);
      EXPECT_GT(error_of(crest, 160 + beside), 1e-3);
      EXPECT_NEAR(error_of(crest, 160 + beside), error_of(crest - pi, -20 + beside), 1e-12) << beside;
    }
  }
}

TEST_F(Npz, RefusesStandardDeviationsThatAreNone) {
  Members members = members_of([](double, double, double) { return 0.2; }, {0, 45}, {0, 180});
  members.push_back(array("std", {2, 2, 2}, {0, 0, 0, 0, 0, -1, 0, 0}));
  refused(zipped(members), "element 5 of std is a standard deviation of -1; expected 0 or more");
}

}  // namespace
}  // namespace lobe::test
