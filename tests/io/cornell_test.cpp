// Cornell's measurements: against an independent reading, by their symmetries, and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::HasSubstr;

class Cornell : public MeasuredData {
 protected:
  Cornell() : MeasuredData("cornell_pbrt2") {}
};

/// All numbers of a file, without comments.
std::vector<double> numbers_of(const fs::path& path) {
  std::vector<double> numbers;
  for (const auto& row : number_rows(path)) numbers.insert(numbers.end(), row.begin(), row.end());
  return numbers;
}

TEST_F(Cornell, SamplesHaveTheValuesOfAnIndependentReader) {
  for (const char* name : {"garnet_red", "mystique"}) {
    SCOPED_TRACE(name);
    const auto numbers = numbers_of(data_ / (std::string(name) + ".brdf"));
    ASSERT_EQ(numbers.size(), 1 + 31 + 1439 * 35U);
    const auto brdf = load_measured(data_ / (std::string(name) + ".brdf"));
    EXPECT_EQ(brdf.name, name);
    ASSERT_EQ(brdf.wavelengths, std::vector<double>(numbers.begin() + 1, numbers.begin() + 32));
    EXPECT_EQ(brdf.channels.front(), "400 nm");
    EXPECT_TRUE(brdf.is_bilateral);
    for (std::size_t i = 0; i < 20; ++i) {
      SCOPED_TRACE(i);
      const double* row = &numbers[32 + (13 + 70 * i) * 35];
      const auto values = brdf.at(std::vector<Directions>{{row[0], row[2], row[3] - row[1], 0}}).value;
      for (Eigen::Index c = 0; c < 31; ++c) EXPECT_NEAR(values(0, c), row[4 + c], 1e-9) << name << " " << i;
    }
  }
}

TEST_F(Cornell, LobesAreOnTheMirrorSide) {
  const auto brdf = load_measured(data_ / "cayman.brdf", {.channels = {"550 nm"}});
  const auto values =
      brdf.at(std::vector<Directions>{{0.7, 0.7, pi, 0}, {0.7, 0.7, pi / 2, 0}, {0.7, 0.7, 0, 0}}).value;
  EXPECT_GT(values(0, 0), 10 * values(1, 0));
  EXPECT_GT(values(0, 0), 10 * values(2, 0));
}

TEST_F(Cornell, TablesOfItAreReciprocalAndBalanced) {
  const auto brdf = load_measured(data_ / "krylon_blue.brdf", {.luminance = "photopic"});
  const auto table = tabulate(brdf, HemisphereGrid::gauss(12, 24), {.allow_unresolved = true});
  const auto values = table.channel(0);
  for (std::size_t i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    for (std::size_t j = 0; j < i; ++j) {
      SCOPED_TRACE(j);
      for (std::size_t k = 0; k < 13; ++k) {
        SCOPED_TRACE(k);
        const double there = values[(i * 12 + j) * 13 + k];
        EXPECT_NEAR(values[(j * 12 + i) * 13 + k], there, 1e-12 * there);
      }
    }
  }
}

TEST(CornellFiles, AreReadInAnyLayoutOfTheWavelengths) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "grey.brdf";
  std::ofstream file(path);
  file << "# grey\n\n3 # wavelengths\n400 500\n600\n";
  for (int i = 0; i < 30; ++i) file << 0.05 * i << " 0.5 " << 0.03 * i << ' ' << 0.2 * i + 0.5 << " 0.1 0.2 0.3\r\n";
  file.close();
  const auto brdf = load_measured(path);
  EXPECT_THAT(brdf.channels, ::testing::ElementsAre("400 nm", "500 nm", "600 nm"));
  const auto values = brdf.at(std::vector<Directions>{{1, 0.2, 1, 0}}).value;
  for (Eigen::Index c = 0; c < 3; ++c) EXPECT_NEAR(values(0, c), 0.1 * static_cast<double>(c + 1), 1e-12) << c;
}

TEST(CornellFiles, ThatAreDamagedAreRefused) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text, const std::string& complaint) {
    const fs::path path = directory.path() / "damaged.brdf";
    std::ofstream(path) << text;
    try {
      (void)load_measured(path);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  };
  refused("2\n400 500\n0.1 0 0.2 3 0.1\n", "line 3: 5 numbers; expected 4 angles and 2 values");
  refused("2\n400 500\n0.1 0 0.2 3 0.1 0.1 0.1\n", "line 3: more than 6 numbers");
  refused("2\n400 500 600\n", "line 2: more than 2 numbers");
  refused("3\n400 500\n600 700\n", "line 3: expected 3 wavelengths");
  refused("2\n500 400\n", "line 2: wavelength 400; expected rising ones");
  refused("3\n400 500\n", "line 2: the file ends within the wavelengths; expected 3");
  refused("1e9\n400\n", "line 1: no number of wavelengths; expected one from 1 to 10000");
  refused("1\n400\n0.1 0 x 3 0.1\n", "line 3: 'x' is no finite number");
  refused("1\n400\n0.1 0 0.3 3 nan\n", "line 3: 'nan' is no finite number");
  refused("1\n400\n0.1 0 1.7 3 0.1\n", "line 3: polar angle 1.7; expected 0 to pi/2");
  refused("1\n400\n# nothing\n", "0 samples; expected at least 8");
}

}  // namespace
}  // namespace lobe::test
