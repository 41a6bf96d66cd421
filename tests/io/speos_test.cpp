// Tables of Ansys SPEOS: against an integration of the test's own, by the layout that Ansys' converter writes, and
// damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "io/measured_files.hpp"
#include "lobe/core/directions.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Shape = std::function<double(double theta_out, double phi)>;  // degrees; phi = 0 is the mirror side

std::string list_of(const std::vector<double>& numbers) {
  std::ostringstream text;
  text.precision(17);
  for (const double number : numbers) text << number << '\t';
  return text.str() + "\n";
}

std::vector<double> steps(double step, double end) {
  std::vector<double> angles;
  for (double angle = 0; angle <= end; angle += step) angles.push_back(angle);
  return angles;
}

std::string table(const std::vector<double>& theta, const std::vector<double>& phi, const Shape& shape) {
  std::string text = std::to_string(theta.size()) + "\t" + std::to_string(phi.size()) + "\n\t" + list_of(phi);
  for (const double t : theta) {
    std::vector<double> row{t};
    for (const double p : phi) row.push_back(shape(t, p));
    text += list_of(row);
  }
  return text;
}

/// The light that a bilinear table reflects, by the midpoint rule.
double integral(const std::vector<double>& theta, const std::vector<double>& phi, const Shape& shape, bool has_cosine) {
  constexpr int kSteps = 1800;
  const auto between = [](const std::vector<double>& nodes, double x) {
    std::size_t i = 1;
    while (i + 1 < nodes.size() && nodes[i] < x) ++i;
    return std::pair{i, std::clamp((x - nodes[i - 1]) / (nodes[i] - nodes[i - 1]), 0.0, 1.0)};
  };
  const double turn = phi.back();
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 90.0 * (i + 0.5) / kSteps;
    const auto [row, share] = between(theta, t);
    double mean = 0;
    for (int k = 0; k < 360; ++k) {
      const double p = turn * (k + 0.5) / 360;
      const auto [column, part] = between(phi, p);
      mean += ((1 - share) *
                   ((1 - part) * shape(theta[row - 1], phi[column - 1]) + part * shape(theta[row - 1], phi[column])) +
               share * ((1 - part) * shape(theta[row], phi[column - 1]) + part * shape(theta[row], phi[column]))) /
              360;
    }
    sum += mean * std::sin(t * kDegree) * (has_cosine ? 1 : std::cos(t * kDegree)) * (pi / 2 / kSteps) * 2 * pi;
  }
  return sum;
}

const std::string kStart = "OPTIS - brdf surface file v9.0\n0\nScattering surface\n0\n\n";

class SpeosFile : public ::testing::Test {
 protected:
  BrdfFunction load(const std::string& text, const ReadOptions& options = {}) const {
    write_file(directory_.path() / "surface.brdf", text);
    return load_measured(directory_.path() / "surface.brdf", options);
  }
  void refused(const std::string& text, const std::string& complaint) const {
    expect_unreadable(directory_.path() / "bad.brdf", text, complaint);
  }
  static double value(const BrdfFunction& brdf, double in, double out, double phi, Eigen::Index channel = 0,
                      double phi_in = 0) {
    return brdf.at(std::vector<Directions>{{in * kDegree, out * kDegree, pi + phi * kDegree, phi_in * kDegree}})
        .value(0, channel);
  }

  TemporaryDirectory directory_;
};

/// Brighter about the mirror side, and steeper with the number.
Shape lobe_shape(double n) {
  return [n](double theta, double phi) {
    return 3 + n * std::sin(theta * kDegree) * std::cos(phi * kDegree) + std::cos(2 * theta * kDegree);
  };
}

TEST_F(SpeosFile, TablesAreScaledToTheReflectanceOfEach) {
  const auto theta = steps(10, 90);
  const auto phi = steps(20, 360);
  const std::vector<std::pair<double, double>> cases{{20, 0.5}, {30, 1}, {0, 1}, {60, 1.5}};
  std::string text = kStart + "1\t0\n1\n2\t2\n0\t60\n450\t600.5\n";
  for (const auto& [percent, n] : cases) text += std::to_string(percent) + "\n" + table(theta, phi, lobe_shape(n));
  const auto brdf = load(text + "End of file\n");
  EXPECT_EQ(brdf.format, "Ansys SPEOS .brdf and .anisotropicbsdf, text");
  EXPECT_THAT(brdf.channels, ElementsAre("450 nm", "600.5 nm"));
  EXPECT_THAT(brdf.wavelengths, ElementsAre(450, 600.5));
  EXPECT_TRUE(brdf.is_isotropic);
  EXPECT_FALSE(brdf.is_bilateral);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const auto& [percent, n] = cases[k];
    const double factor = percent / 100 / integral(theta, phi, lobe_shape(n), false);
    const double in = k < 2 ? 0 : 60;
    const auto channel = static_cast<Eigen::Index>(k % 2);
    for (const double out : {10.0, 50.0}) {
      for (const double turn : {0.0, 100.0, 260.0}) {
        // The sum of the test has steps of 0.05 degrees.
        EXPECT_NEAR(value(brdf, in, out, turn, channel), factor * lobe_shape(n)(out, turn), 1e-5) << k;
      }
    }
  }
  // Between the incident angles it is linear.
  EXPECT_NEAR(value(brdf, 15, 20, 40, 1), 0.75 * value(brdf, 0, 20, 40, 1) + 0.25 * value(brdf, 60, 20, 40, 1), 1e-12);
}

TEST_F(SpeosFile, IntensitiesAreDividedByTheCosineOfTheViewer) {
  const auto theta = steps(5, 90);
  const auto phi = steps(30, 180);
  const auto lambert = [](double t, double) { return 7 * std::cos(t * kDegree); };
  const auto brdf = load(kStart + "1\t0\n0\n2\t1\n0\t80\n550\n50\n" + table(theta, phi, lambert) + "50\n" +
                         table(theta, phi, lambert));
  EXPECT_TRUE(brdf.is_bilateral);
  // The integral is that of the straight lines between the angles.
  const double factor = 0.5 / integral(theta, phi, lambert, true);
  EXPECT_NEAR(value(brdf, 30, 45, 10), factor * 7, 1e-6);
  EXPECT_NEAR(value(brdf, 30, 45, 10) * pi, 0.5, 1e-3);
  EXPECT_NEAR(value(brdf, 30, 87.5, 10), factor * 7 * std::cos(85 * kDegree) / 2 / std::cos(87.5 * kDegree), 1e-6);
}

std::string anisotropic(const std::string& angles, const std::string& spectrum) {
  return "OPTIS - Anisotropic BSDF surface file v8.0\n0\nComment\n23\nMeasurement description\n0\t1\t0\n1\t0\n1\n" +
         angles + spectrum;
}

TEST_F(SpeosFile, SpectraScaleTheTableWhereTheyWereMeasured) {
  const auto theta = steps(15, 90);
  const auto phi = steps(45, 360);
  const auto brdf = load(anisotropic("1\n0.0\t\n2\n10.0\t50.0\t\n", "10.0\t0\n\n2\n350\t20\n850\t40\n") +
                         table(theta, phi, lobe_shape(1)) + table(theta, phi, lobe_shape(2)) + "End of file\n");
  const double factor = 1 / integral(theta, phi, lobe_shape(1), false);
  EXPECT_THAT(brdf.wavelengths, ElementsAre(350, 850));
  EXPECT_TRUE(brdf.is_isotropic);
  EXPECT_NEAR(value(brdf, 10, 30, 90, 0), 0.2 * factor * lobe_shape(1)(30, 90), 1e-5);
  EXPECT_NEAR(value(brdf, 10, 30, 90, 1), 0.4 * factor * lobe_shape(1)(30, 90), 1e-5);
  // The other table keeps its proportion to the first.
  EXPECT_NEAR(value(brdf, 50, 60, 45, 1), 0.4 * factor * lobe_shape(2)(60, 45), 1e-5);
  // Between two incident angles factors count by the distance.
  const auto between = load(anisotropic("1\n0.0\t\n2\n10.0\t50.0\t\n", "40.0\t0\n\n1\n350\t20\n") +
                            table(theta, phi, lobe_shape(1)) + table(theta, phi, [](double, double) { return 9.0; }));
  EXPECT_NEAR(value(between, 10, 30, 90), 0.2 * (0.25 * factor + 0.75 / (9 * pi)) * lobe_shape(1)(30, 90), 1e-5);
}

TEST_F(SpeosFile, TheSurfaceIsTurnedAgainstTheLight) {
  const auto theta = steps(30, 90);
  const auto phi = steps(90, 360);
  std::string tables;
  for (int turn = 0; turn < 360; turn += 90) {
    tables += table(theta, phi, [turn](double, double) { return 1 + turn / 90.0; });
  }
  const auto brdf =
      load(anisotropic("4\n0\t90\t180\t270\n1\n30\n1\n30\n1\n30\n1\n30\n", "30\t0\n\n1\n550\t10\n") + tables);
  EXPECT_FALSE(brdf.is_isotropic);
  const double unit = 0.1 / pi;
  // The light comes from azimuth 180 where it goes on along the direction of the surface.
  EXPECT_NEAR(value(brdf, 30, 40, 0, 0, 180), unit, 1e-12);
  EXPECT_NEAR(value(brdf, 30, 40, 0, 0, 90), 2 * unit, 1e-12);
  EXPECT_NEAR(value(brdf, 30, 40, 0, 0, 0), 3 * unit, 1e-12);
  EXPECT_NEAR(value(brdf, 30, 40, 0, 0, -90), 4 * unit, 1e-12);
  EXPECT_NEAR(value(brdf, 30, 40, 0, 0, 135), 1.5 * unit, 1e-12);
  // Between the last one and the first.
  EXPECT_NEAR(value(brdf, 30, 40, 0, 0, -135), 2.5 * unit, 1e-12);
}

TEST_F(SpeosFile, TransmissionIsLeftOut) {
  const auto flat = [](double, double) { return 2.0; };
  const std::string one = table(steps(45, 90), steps(180, 360), flat);
  const auto brdf = load(kStart + "1\t1\n1\n1\t1\n0\n550\n50\n" + one + "20\n2\t2\n\t0\t360\n90\t1\t1\n180\t1\t1\n");
  EXPECT_THAT(brdf.remarks, Contains("its transmission is left out"));
  EXPECT_NEAR(value(brdf, 0, 20, 0), 0.5 / pi, 1e-12);
  refused(kStart + "0\t1\n1\n1\t1\n0\n550\n50\n" + one, "line 6: it holds transmission only");
}

TEST_F(SpeosFile, DescriptionsMayHaveSeveralLines) {
  const auto flat = [](double, double) { return 2.0; };
  const auto brdf = load(
      "OPTIS - brdf surface file "
      "v8.0\r\n0\r\nComment\r\n13\r\none\r\ntwo\r\nthree\r\n1\t0\r\n1\r\n1\t1\r\n0\r\n550\r\n50\r\n" +
      table(steps(45, 90), steps(180, 360), flat));
  EXPECT_NEAR(value(brdf, 0, 20, 0), 0.5 / pi, 1e-12);
}

TEST_F(SpeosFile, WhatIsNotReadIsSaidWithItsLine) {
  refused("OPTIS - brdf surface file v7.0\n", "line 1: version 'v7.0'; expected v8.0 or later");
  refused("OPTIS - Anisotropic BSDF surface file v6.0\n0\n", "line 1: version 'v6.0'; expected v7.0 or later");
  refused("OPTIS - brdf surface file v9.0\n1\n", "line 2: it is binary; expected a text");
  refused(kStart, "line 5: the file ends; expected whether there is reflection and transmission");
  const std::string head = kStart + "1\t0\n1\n";
  refused(head + "1e9 1\n", "line 8: incident angles of 1e+09; expected 1 to 10000");
  refused(head + "10000 10000\n", "line 8: the file ends; expected incident angle");
  refused(head + "1 1\n100\n", "line 9: incident angle 100; expected rising ones from 0 to 90 degrees");
  refused(head + "2 1\n20 10\n", "line 9: incident angle 10; expected rising ones");
  refused(head + "1 1\n10\n550\n", "line 10: the file ends; expected a reflectance in percent");
  refused(head + "1 2\n10\n550 540\n1\n1 1\n0\n0 1\n1\n1 1\n0\n0 1\n", "wavelength 540; expected rising ones");
  const std::string start = head + "1 1\n10\n550\n";
  refused(start + "50\n2 2\n0 400\n", "line 13: azimuth 400; expected rising ones from 0 to 360 degrees");
  refused(start + "50\n2 2\n0 360\n0 1\n", "line 14: 2 numbers; expected 3, a polar angle and values");
  refused(start + "50\n2 2\n0 360\n0 1 1\n0 1 1\n", "line 15: polar angle 0; expected rising ones");
  refused(start + "50\n2 2\n0 360\n0 1 nan\n", "line 14: 'nan' is no finite number");
  refused(start + "50\n2 2\n0 360\n0 1 1\n", "line 14: the file ends; expected a polar angle and values");
  refused(start + "50\n1 2\n0 360\n0 0 0\n", "values whose integral is 0, for a reflectance of 50 %");
  refused(start + "-5\n1 2\n0 360\n0 1 1\n", "a reflectance of -5 %; expected one from 0 on");
}

}  // namespace
}  // namespace lobe::test
