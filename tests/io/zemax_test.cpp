// Zemax tables: against an independent reading, against the same measurement in another program's frame, and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/formats/measured.hpp"
#include "support/device.hpp"
#include "support/functions.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::Contains;
using ::testing::HasSubstr;

class Zemax : public MeasuredData {
 protected:
  Zemax() : MeasuredData("zemax") {}
};

/// The viewer for light at theta_in and azimuth 0, by spherical trigonometry in the triangle of normal, specular
/// direction and viewer: azimuth is the angle at the specular direction, from the arc to the normal.
Directions pair_of(double theta_in, double azimuth, double radial) {
  const double cosine =
      std::cos(theta_in) * std::cos(radial) + std::sin(theta_in) * std::sin(radial) * std::cos(azimuth);
  const double theta_out = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double at_normal = std::atan2(std::sin(radial) * std::sin(azimuth),
                                      (std::cos(radial) - std::cos(theta_in) * cosine) / std::sin(theta_in));
  return {theta_in, theta_out, pi - at_normal, 0};
}

TEST_F(Zemax, SamplesHaveTheValuesOfAnIndependentReader) {
  const auto brdf = load_measured(data_ / "AnoBlackEC1onAlum.bsdf");
  EXPECT_THAT(brdf.channels, ::testing::ElementsAre("value"));
  EXPECT_TRUE(brdf.is_bilateral);
  EXPECT_THAT(brdf.remarks, Contains(HasSubstr("67 values above the horizon are 0")));
  std::ifstream file(data_ / "AnoBlackEC1onAlum.bsdf");
  std::string word;
  while (word != "DataBegin") file >> word;
  const std::vector<double> incidences{10, 30, 50, 70};
  const std::vector<double> radials{0, 5, 10, 15, 20, 30, 40, 50, 60, 70, 80, 90};
  int compared = 0;
  for (const double incidence : incidences) {
    SCOPED_TRACE(incidence);
    double tis = 0;
    file >> word >> tis;
    ASSERT_EQ(word, "TIS");
    for (int azimuth = 0; azimuth <= 180; azimuth += 10) {
      for (const double radial : radials) {
        double value = 0;
        file >> value;
        const auto pair = pair_of(incidence * kDegree, azimuth * kDegree, radial * kDegree);
        // In the plane of incidence some coincide with others by reciprocity.
        if (azimuth % 40 != 20 || azimuth == 180 || radial < 5 || value == 0 || pair.theta_out > pi / 2) continue;
        EXPECT_NEAR(brdf.at(std::vector<Directions>{pair}).value(0, 0), value, 1e-9) << incidence << " " << azimuth;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

struct FredRow {
  Directions pair;
  double value;
};

/// Rows "theta phi value" after "theta_i phi_i", degrees; phi = 0 is the mirror side.
std::vector<FredRow> fred_rows(const fs::path& path) {
  std::vector<FredRow> rows;
  double theta_in = 0;
  for (const auto& row : number_rows(path)) {
    if (row.size() == 3) {
      rows.push_back({{theta_in, row[0] * kDegree, pi + row[1] * kDegree, 0}, row[2]});
    } else if (row.size() == 2) {
      theta_in = row[0] * kDegree;
    }
  }
  return rows;
}

TEST_F(Zemax, TheSameMeasurementInTheFrameOfFredAgrees) {
  for (const char* name : {"AnoBlackEC1onAlum", "AnoBlackEC2onAlum", "AnoBlackNiTEonINVAR", "AnoBlackNiTEonSteel"}) {
    const auto brdf = load_measured(data_ / (std::string(name) + ".bsdf"));
    const auto rows = fred_rows(data_ / (std::string(name) + ".txt"));
    ASSERT_EQ(rows.size(), 1144U) << name;
    std::vector<double> deviations;
    std::vector<double> turned;
    for (const FredRow& row : rows) {
      deviations.push_back(std::abs(brdf.at(std::vector<Directions>{row.pair}).value(0, 0) / row.value - 1));
      Directions other = row.pair;
      other.delta_phi += pi;
      turned.push_back(std::abs(brdf.at(std::vector<Directions>{other}).value(0, 0) / row.value - 1));
    }
    const auto middle = static_cast<std::ptrdiff_t>(deviations.size() / 2);
    std::ranges::nth_element(deviations, deviations.begin() + middle);
    std::ranges::nth_element(turned, turned.begin() + middle);
    // 7 to 12 %: the Zemax files were interpolated and shifted by what the light was misaligned.
    EXPECT_LT(deviations[static_cast<std::size_t>(middle)], 0.13) << name;
    EXPECT_GT(turned[static_cast<std::size_t>(middle)], 0.3) << name;
  }
}

/// A file of our own: f = 0.1 + 0.05 cos^2 of the angle of the light to the turned sample's x axis, for all viewers.
void write_turned(const fs::path& path, const char* content, int sections) {
  std::ofstream file(path);
  file << "# turned\nSource  Measured\nSymmetry  ASymmetrical4D\nSpectralContent  " << content
       << "\nScatterType  BRDF\nSampleRotation  12\n0 30 60 90 120 150\n180 210 240 270 300 330\n";
  file
      << "AngleOfIncidence 3\n20 40 60\nScatterAzimuth 8\n0 45 90 135 180 225 270 315\nScatterRadial 4\n0 10 20 25\n\n";
  const char* names[] = {"TristimulusX", "TristimulusY", "TristimulusZ"};
  for (int s = 0; s < sections; ++s) {
    file << (sections == 1 ? "Monochrome" : names[s]) << "\nDataBegin\n";
    for (int turn = 0; turn < 360; turn += 30) {
      for (int incidence = 0; incidence < 3; ++incidence) {
        file << "TIS 0.3\n";
        for (int row = 0; row < 8; ++row) {
          for (int column = 0; column < 4; ++column) {
            file << (s + 1) * (0.1 + 0.05 * std::pow(std::cos(turn * kDegree), 2)) << '\t';
          }
          file << '\n';
        }
      }
    }
    file << "DataEnd\n";
  }
}

TEST(ZemaxFiles, OfTurnedSamplesAreAnisotropic) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "turned.bsdf";
  write_turned(path, "XYZ", 3);
  const auto brdf = load_measured(path);
  EXPECT_FALSE(brdf.is_isotropic);
  EXPECT_THAT(brdf.channels, ::testing::ElementsAre("X", "Y", "Z"));
  for (const int turn : {0, 60, 90}) {
    SCOPED_TRACE(turn);
    const auto values = brdf.at(std::vector<Directions>{{40 * kDegree, 40 * kDegree, pi, pi - turn * kDegree}}).value;
    const double expected = 0.1 + 0.05 * std::pow(std::cos(turn * kDegree), 2);
    for (Eigen::Index c = 0; c < 3; ++c) {
      SCOPED_TRACE(c);
      EXPECT_NEAR(values(0, c), expected * static_cast<double>(c + 1), 1e-9);
    }
  }
}

TEST(ZemaxFiles, OfTurnedSamplesMayHaveHalfTheAzimuths) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "half.bsdf";
  const auto value = [](double turn, double incidence, double azimuth, double radial) {
    return (0.1 + 0.05 * std::pow(std::cos(turn * kDegree), 2)) *
           (1 + 0.001 * incidence + 0.02 * radial * std::cos(azimuth / 2 * kDegree));
  };
  const std::array turns{0, 45, 90, 135, 180, 225, 270, 315};
  std::ofstream file(path);
  file << "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n"
       << "SampleRotation 8\n0 45 90 135 180 225 270 315\nAngleOfIncidence 3\n20 40 60\n"
       << "ScatterAzimuth 5\n0 45 90 135 180\nScatterRadial 4\n0 8 16 24\nMonochrome\nDataBegin\n";
  for (const int turn : turns) {
    for (const int incidence : {20, 40, 60}) {
      file << "TIS 0.3\n";
      for (const int azimuth : {0, 45, 90, 135, 180}) {
        for (const int radial : {0, 8, 16, 24}) file << value(turn, incidence, azimuth, radial) << ' ';
        file << '\n';
      }
    }
  }
  file << "DataEnd\n";
  file.close();
  const auto brdf = load_measured(path);
  EXPECT_FALSE(brdf.is_isotropic);
  EXPECT_THAT(brdf.conventions, HasSubstr("the same on both sides of each plane of incidence"));
  for (const int turn : turns) {
    SCOPED_TRACE(turn);
    for (const int azimuth : {45, 90, 135}) {
      SCOPED_TRACE(azimuth);
      Directions pair = pair_of(40 * kDegree, azimuth * kDegree, 16 * kDegree);
      pair.phi_in = pi - turn * kDegree;
      EXPECT_NEAR(brdf.at(std::vector<Directions>{pair}).value(0, 0), value(turn, 40, azimuth, 16), 2e-6);
      pair.delta_phi = -pair.delta_phi;
      EXPECT_NEAR(brdf.at(std::vector<Directions>{pair}).value(0, 0), value(turn, 40, azimuth, 16), 2e-6);
    }
  }
}

TEST(ZemaxFiles, ThatAreDamagedAreRefused) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text, const std::string& complaint) {
    const fs::path path = directory.path() / "damaged.bsdf";
    std::ofstream(path) << text;
    try {
      (void)load_measured(path);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  };
  const std::string start = "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\n";
  refused(start + "ScatterType BTDF\n", "line 4: it is a transmission");
  const std::string angles =
      start +
      "ScatterType BRDF\nSampleRotation 1\n0\nAngleOfIncidence 1\n10\nScatterAzimuth 2\n0 180\nScatterRadial 2\n";
  refused(start + "ScatterType BRDF\nSampleRotation 99999999999\n0\n",
          "line 5: no number of angles after SampleRotation; expected 1 to 10000");
  refused(start + "ScatterType BRDF\nSampleRotation 99\n0\n", "line 6: the file ends; expected 99 angles");
  refused(start +
              "ScatterType BRDF\nSampleRotation 2\n0 90\nAngleOfIncidence 1\n10\nScatterAzimuth 2\n0 270\n"
              "ScatterRadial 1\n0\n",
          "line 12: ScatterAzimuth 270 with PlaneSymmetrical; expected 0 to 180");
  refused(start + "ScatterType BRDF\nSampleRotation 2\n0 -10\n", "line 6: angle -10 of SampleRotation");
  refused(start + "ScatterType BRDF\nScatterRadial 1\n0\n", "line 6: SampleRotation, AngleOfIncidence or");
  refused(angles + "0 10\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n", "line 16: the file ends; expected a row of values");
  refused(angles + "0 10\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n1 2 3\n", "line 17: more than 2 numbers");
  refused(angles + "0 10\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n1 nan\n", "line 17: 'nan' is no finite number");
  refused(angles + "0 10\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n1 2\nTIS 0.2\n", "line 18: expected 'DataEnd'");
  refused(angles + "0 10\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n1 2\nDataEnd\n", "3 samples; expected at least 8");
}

/// The numbers of an announced list.
std::vector<double> announced(std::istream& file, const std::string& name) {
  std::string word;
  while (word != name) file >> word;
  std::size_t count = 0;
  file >> count;
  std::vector<double> list(count);
  for (double& one : list) file >> one;
  return list;
}

TEST(ZemaxFiles, AreWrittenAboutTheSpecularDirection) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "written.bsdf";
  const BrdfFunction brdf = glossy_function({"value"});
  save_measured(device(), brdf, "zemax", path, {.command_line = "lobe export\nglossy"});
  std::ifstream file(path);
  EXPECT_EQ(announced(file, "SampleRotation"), std::vector<double>{0});
  const auto incidences = announced(file, "AngleOfIncidence");
  const auto azimuths = announced(file, "ScatterAzimuth");
  const auto radials = announced(file, "ScatterRadial");
  std::string word;
  while (word != "DataBegin") file >> word;
  std::size_t compared = 0;
  for (const double incidence : incidences) {
    double tis = 0;
    file >> word >> tis;
    ASSERT_EQ(word, "TIS") << incidence;
    const std::vector<double> theta{incidence * kDegree};
    EXPECT_NEAR(tis, albedo(device(), Reflectance(brdf), theta).front().front().value, 1e-6) << incidence;
    for (const double azimuth : azimuths) {
      for (const double radial : radials) {
        double value = 0;
        file >> value;
        if (incidence == 0) continue;  // the triangle has no angle at the normal
        const Directions pair = pair_of(incidence * kDegree, azimuth * kDegree, radial * kDegree);
        if (pair.theta_out > 89.9 * kDegree) continue;
        EXPECT_NEAR(value, glossy_at(pair), 1e-9) << incidence << " " << azimuth << " " << radial;
        ++compared;
      }
    }
  }
  file >> word;
  EXPECT_EQ(word, "DataEnd");
  EXPECT_GT(compared, 2000U);
}

// 0 marks what was not measured.
TEST(ZemaxFiles, AreReadBackWithTheirZeros) {
  const TemporaryDirectory directory;
  BrdfFunction brdf = glossy_function({"X", "Y", "Z"});
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues found{Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pairs.size()), 3), {}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (pairs[i].theta_out < 0.8) found.value.row(static_cast<Eigen::Index>(i)) << 0.1, 0.2, 0.3;
    }
    return found;
  };
  save_measured(device(), brdf, "zemax", directory.path() / "written.bsdf");
  const auto read = load_measured(directory.path() / "written.bsdf");
  EXPECT_EQ(read.channels, brdf.channels);
  EXPECT_TRUE(std::ranges::none_of(read.remarks, [](const auto& one) { return one.find("not measured") != one.npos; }));
  const auto values = read.at(std::vector<Directions>{{0.3, 0.3, pi, 0}, {0.3, 1.3, 1, 0}}).value;
  EXPECT_NEAR(values(0, 1), 0.2, 1e-3);
  EXPECT_NEAR(values(1, 1), 0, 0.02);
}

/// The same for turns by half a circle, and not the same on both sides.
double brushed_at(const Directions& pair) {
  const double light = std::sin(pair.theta_in) * std::cos(pair.phi_in);
  const double viewer = std::sin(pair.theta_out) * std::cos(pair.phi_in + pair.delta_phi);
  return 0.2 + 0.1 * light * viewer +
         0.05 * std::sin(pair.theta_in) * std::sin(pair.theta_out) * std::sin(2 * pair.phi_in + pair.delta_phi);
}

TEST(ZemaxFiles, OfAnisotropicReflectancesAreOfTurnedSamples) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "brushed.bsdf";
  BrdfFunction brdf = function_of(brushed_at);
  brdf.is_isotropic = false;
  save_measured(device(), brdf, "zemax", path);
  std::ifstream file(path);
  const auto rotations = announced(file, "SampleRotation");
  const auto incidences = announced(file, "AngleOfIncidence");
  const auto azimuths = announced(file, "ScatterAzimuth");
  const auto radials = announced(file, "ScatterRadial");
  EXPECT_GT(rotations.size(), 8U);
  EXPECT_GT(azimuths.back(), 180);
  std::string word;
  while (word != "DataBegin") file >> word;
  std::size_t compared = 0;
  for (const double rotation : rotations) {
    for (const double incidence : incidences) {
      double tis = 0;
      file >> word >> tis;
      ASSERT_EQ(word, "TIS") << rotation << " " << incidence;
      for (const double azimuth : azimuths) {
        for (const double radial : radials) {
          double value = 0;
          file >> value;
          if (incidence == 0) continue;  // the triangle has no angle at the normal
          Directions pair = pair_of(incidence * kDegree, azimuth * kDegree, radial * kDegree);
          pair.phi_in = pi - rotation * kDegree;
          if (pair.theta_out > 89.9 * kDegree) continue;
          EXPECT_NEAR(value, brushed_at(pair), 1e-9) << rotation << " " << incidence << " " << azimuth << " " << radial;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 20000U);

  const auto read = load_measured(path);
  EXPECT_FALSE(read.is_isotropic);
  EXPECT_THAT(read.conventions, HasSubstr("linear between the angles"));
  const std::vector<Directions> pairs{{0.43, 0.7, 2, 0.3}, {1.1, 0.3, 0.5, 4}, {0.8, 0.82, 3.1, -2}, {0, 0.5, 1, 1}};
  const auto found = read.at(pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    // Curvatures of 0.2 times the squares of steps, up to 0.35: an eighth of 0.025.
    EXPECT_NEAR(found.value(row, 0), brushed_at(pairs[i]), 4e-3) << i;
    EXPECT_LE(std::abs(found.value(row, 0) - brushed_at(pairs[i])), found.error(row, 0) + 1e-12) << i;  // rounding
  }
}

TEST(ZemaxFiles, HoldOneChannelOrXyz) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "not.bsdf";
  EXPECT_THROW(save_measured(device(), glossy_function({"red", "green", "blue"}), "zemax", path), ArgumentError);
  BrdfFunction brdf = glossy_function({"value"});
  brdf.is_bilateral = false;
  EXPECT_THROW(save_measured(device(), brdf, "zemax", path), ArgumentError);
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace lobe::test
