// Tables of reflectance factors: against an independent reading, by what is known of Spectralon, and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

using std::numbers::pi;
using ::testing::Contains;
using ::testing::HasSubstr;

class Brf : public MeasuredData {
 protected:
  Brf() : MeasuredData("spectralon_blacklab") {}
};

TEST_F(Brf, FactorsAreReflectancesTimesPi) {
  for (const char* name : {"20250210_S7_sample_final.txt", "20250409_S7_swir_sample.txt"}) {
    SCOPED_TRACE(name);
    const auto brdf = load_measured(data_ / name);
    EXPECT_TRUE(brdf.is_isotropic);
    EXPECT_EQ(brdf.wavelengths.size(), brdf.channels.size());
    int compared = 0;
    for (const auto& row : number_rows(data_ / name)) {
      // 0 to 45 degrees is there several times, also as 45 to 0.
      if (row.size() != 4 + brdf.channels.size() || (row[0] == 0 || row[0] == 45)) continue;
      const std::vector<Directions> pair{{row[0] * kDegree, row[2] * kDegree, (row[3] - row[1]) * kDegree, 0}};
      for (std::size_t c = 0; c < brdf.channels.size(); ++c) {
        ASSERT_NEAR(brdf.at(pair).value(0, static_cast<Eigen::Index>(c)), row[4 + c] / pi, 1e-9) << name;
      }
      ++compared;
    }
    EXPECT_GE(compared, 13) << name;
  }
  EXPECT_EQ(load_measured(data_ / "20250210_S7_sample_final.txt").channels.front(), "385.65 nm");
}

TEST(BrfFiles, HaveTheMirrorSideAtAHalfTurn) {
  const TemporaryDirectory directory;
  std::string text = "BRF Values\nsomewhere\nsrc_z src_a view_z view_a band\n";
  for (int in = 0; in <= 80; in += 20) {
    for (int out = 10; out <= 70; out += 20) {
      for (int turn = 0; turn <= 180; turn += 60) {
        text += std::to_string(in) + " 30 " + std::to_string(out) + " " + std::to_string(30 + turn) + " " +
                std::to_string(1 + turn / 360.0) + "\n";
      }
    }
  }
  write_file(directory.path() / "table.txt", text);
  const auto brdf = load_measured(directory.path() / "table.txt");
  EXPECT_THAT(brdf.channels, ::testing::ElementsAre("band"));
  EXPECT_TRUE(brdf.wavelengths.empty());
  EXPECT_NEAR(brdf.at(std::vector<Directions>{{0.3491, 0.8727, pi, 0}}).value(0, 0) * pi, 1.5, 1e-3);
  EXPECT_NEAR(brdf.at(std::vector<Directions>{{0.3491, 0.8727, 0, 0}}).value(0, 0) * pi, 1, 1e-3);
}

TEST(BrfFiles, WhatIsNotReadIsSaidWithItsLine) {
  const TemporaryDirectory directory;
  const auto refused = [&](const std::string& text, const std::string& complaint) {
    expect_unreadable(directory.path() / "bad.txt", text, complaint);
  };
  const std::string start = "BRF Values\nsrc_z src_a view_z view_a 400nm\n";
  refused("src_z src_a view_a view_z 400nm\n", "line 1: other columns than src_z, src_a, view_z, view_a");
  refused("src_z src_a view_z view_a\n", "line 1: there is no column of a band");
  refused(start + "0 0 45 180\n", "line 3: 4 numbers; expected 4 angles and 1 factors");
  refused(start + "0 0 45 180 1 1\n", "line 3: more than 5 numbers");
  refused(start + "0 0 95 180 1\n", "line 3: view_z of 95; expected 0 to 90 degrees");
  refused(start + "0 0 45 180 nan\n", "line 3: 'nan' is no finite number");
  refused(start + "0 0 45 180 1\n", "1 samples; expected at least 8");
}

}  // namespace
}  // namespace lobe::test
