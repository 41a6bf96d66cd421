// ASAM OpenMATERIAL 3D lookup tables: rows written by the test, and files read by a general JSON parser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
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
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

/// A file with these rows of a table.
std::string openmaterial_text(const std::string& rows) {
  return "{\"metadata\": {\"name\": \"here\", \"openMaterial3dVersion\": \"1.1.0\"},\n\"brdf\": {\"wavelengths\": "
         "[9.05e-07, 5.5e-07],\n\"lookupTable\": [\n" +
         rows + "]}}\n";
}

TEST(OpenMaterialFiles, HoldARowForEachWavelengthAndPairOfDirections) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "rows.xompt";
  std::ostringstream rows;
  rows.precision(17);
  std::vector<Directions> pairs;
  for (int i = 0; i < 40; ++i) {
    pairs.push_back({1.4 * std::fmod(0.618 * i, 1), 1.4 * std::fmod(0.755 * i, 1), 6.2 * std::fmod(0.57 * i, 1), 0});
  }
  for (const double wavelength : {905, 550}) {
    for (const Directions& pair : pairs) {
      rows << (rows.tellp() > 0 ? ",\n" : "") << "[" << wavelength << "e-9," << pair.theta_in << "," << pair.theta_out
           << "," << pair.delta_phi << "," << wavelength / 1000 * glossy_at(pair) << "]";
    }
  }
  // Neither counts: no value, and directions of one wavelength alone.
  rows << ",[5.5e-7,0.2,0.3,0.4,null],[5.5e-7,1,1,1,2]";
  std::ofstream(path) << openmaterial_text(rows.str());
  const auto brdf = load_measured(path);
  EXPECT_THAT(brdf.channels, ElementsAre("550 nm", "905 nm"));
  EXPECT_EQ(brdf.wavelengths, (std::vector<double>{550, 905}));
  EXPECT_TRUE(brdf.is_bilateral);
  EXPECT_THAT(brdf.remarks, Contains("1 rows have no value"));
  EXPECT_THAT(brdf.remarks, Contains("1 pairs of directions lack some of the 2 wavelengths, and are left out"));
  for (const Directions& pair : pairs) {
    const auto values = brdf.at(std::vector<Directions>{pair}).value;
    EXPECT_NEAR(values(0, 0), 0.55 * glossy_at(pair), 1e-9) << pair.theta_in;  // asinh and back
    EXPECT_NEAR(values(0, 1), 0.905 * glossy_at(pair), 1e-9) << pair.theta_in;
  }
}

TEST(OpenMaterialFiles, MayLackAWavelength) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "rows.xompt";
  std::string rows;
  for (int i = 0; i < 9; ++i) {
    rows += (i == 0 ? "" : ",") + std::string("[null,0.") + std::to_string(i + 1) + ",0.5,3.1,0.25]";
  }
  std::ofstream(path) << openmaterial_text(rows);
  const auto brdf = load_measured(path);
  EXPECT_THAT(brdf.channels, ElementsAre("value"));
  EXPECT_NEAR(brdf.at(std::vector<Directions>{{0.4, 0.5, 3.1, 0}}).value(0, 0), 0.25, 1e-9);
}

TEST(OpenMaterialFiles, ThatAreDamagedAreRefused) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text, const std::string& complaint) {
    const fs::path path = directory.path() / "damaged.xompt";
    std::ofstream(path) << text;
    try {
      (void)load_measured(path);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  };
  refused(openmaterial_text("[5.5e-7,0,0,0,1],\n[5.5e-7,0,0,1]"), "line 5: a row of 4 numbers; expected 5");
  refused(openmaterial_text("[5.5e-7,0,0,0,1,2]"), "line 4: a row of more than 5 numbers");
  refused(openmaterial_text("[5.5e-7,null,0,0,1]"), "line 4: incident zenith angle of a row is no number");
  refused(openmaterial_text("[5.5e-7,0,\"x\",0,1]"), "line 4: exit zenith angle of a row is no number");
  refused(openmaterial_text("[5.5e-7,0,30,0,1]"), "line 4: exit zenith angle 30; expected 0 to pi/2, radians");
  refused(openmaterial_text("[550,0,0,0,1]"), "line 4: wavelength 550; expected one above 0, metres");
  refused(openmaterial_text("[550e-9,0,0,0,1],[null,0,0,0,1]"), "only some rows have a wavelength");
  refused(openmaterial_text("[5.5e-7,0,0,0,1e999]"), "line 4: '1e999' is no JSON here");
  refused(openmaterial_text("[5.5e-7,0,0,0,1]"), "1 samples; expected at least 8");
  refused(openmaterial_text(""), "no values");
  refused("{\"metadata\": {\"openMaterial3dVersion\": \"1.1.0\"}}\n", "there is no array 'lookupTable' of 'brdf'");
  refused("{\"reflectionCoefficient\": {\"lookupTable\": [[1]]}}", "it holds coefficients of reflection");
  refused("{\"brdf\": {\"lookupTable\": [[5.5e-7,", "line 1: the file ends within its JSON");
  refused("{\"lookupTable\": " + std::string(100, '['), "arrays and objects within more than 32 others");
}

TEST(OpenMaterialFiles, AreWrittenSortedWithinTheRangesOfTheSchema) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "written.xompt";
  BrdfFunction brdf = glossy_function({"905 nm", "550 nm"});
  brdf.wavelengths = {905, 550};
  save_measured(device(), brdf, "openmaterial", path, {.command_line = "lobe export\nglossy"});
  const auto json = nlohmann::json::parse(std::ifstream(path));
  const auto& metadata = json["metadata"];
  EXPECT_EQ(metadata["openMaterial3dVersion"], "1.1.0");
  EXPECT_EQ(metadata["sources"], "simulation");
  EXPECT_THAT(metadata["uuid"].get<std::string>(),
              MatchesRegex("[0-9a-f]{8}-[0-9a-f]{4}-8[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}"));
  for (const char* required : {"name", "materialVersion", "copyrights", "license", "authors"}) {
    EXPECT_TRUE(metadata.contains(required)) << required;
  }
  EXPECT_EQ(json["brdf"]["wavelengths"], (std::vector<double>{5.5e-7, 9.05e-7}));
  const auto rows = json["brdf"]["lookupTable"].get<std::vector<std::vector<double>>>();
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  std::size_t both_sides = 0;
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 5U) << ::testing::PrintToString(row);
    EXPECT_TRUE(row[1] >= 0 && row[1] <= 1.570796 && row[2] >= 0 && row[2] <= 1.570796 && row[3] >= 0 &&
                row[3] <= 6.283185)
        << ::testing::PrintToString(row);
    const double expected = (row[0] < 7e-7 ? 2 : 1) * glossy_at({row[1], row[2], row[3], 0});
    EXPECT_NEAR(row[4], expected, 1e-12) << ::testing::PrintToString(row);  // rounding of cosines
    if (row[3] > 0.1 && row[3] < pi - 0.1) ++both_sides;
  }
  EXPECT_GT(both_sides, rows.size() / 5);
  // The same file again.
  save_measured(device(), brdf, "openmaterial", path, {.overwrite = true, .command_line = "another"});
  EXPECT_EQ(nlohmann::json::parse(std::ifstream(path))["metadata"]["uuid"], metadata["uuid"]);
}

TEST(OpenMaterialFiles, AreReadBack) {
  const TemporaryDirectory directory;
  const BrdfFunction brdf = glossy_function({"value"});
  save_measured(device(), brdf, "openmaterial", directory.path() / "written.xompt");
  const auto read = load_measured(directory.path() / "written.xompt");
  EXPECT_THAT(read.channels, ElementsAre("value"));
  const std::vector<Directions> pairs{{0.3, 0.3, pi, 0}, {0.7, 0.6, 2.9, 0}, {1.2, 0.5, 0.4, 0}, {0.1, 1, 1, 0}};
  // What interpolation between these samples is off by; the values are 0.1 to 1.1.
  EXPECT_LT((read.at(pairs).value - brdf.at(pairs).value).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(OpenMaterialFiles, HoldIsotropicReflectancesOfOneChannelOrWavelengths) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "not.xompt";
  const auto refused = [&](const BrdfFunction& brdf, const std::string& complaint) {
    try {
      save_measured(device(), brdf, "openmaterial", path);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const ArgumentError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  };
  refused(glossy_function({"red", "green", "blue"}), "3 channels that are no wavelengths");
  BrdfFunction brdf = glossy_function({"value"});
  brdf.is_isotropic = false;
  refused(brdf, "is anisotropic; OpenMATERIAL files hold isotropic reflectances");
  refused(function_of([](const Directions& pair) { return 0.1 - std::sin(pair.theta_out); }),
          "OpenMATERIAL files hold no values below 0");
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace lobe::test
