// Contact sheets: how spheres are displayed, and the pictures read back.
#include "lobe/plot/preview_sheet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "command.hpp"
#include "core/files.hpp"
#include "lobe/core/colour.hpp"
#include "lobe/core/error.hpp"
#include "support/environment.hpp"
#include "support/png.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr double kExposure = 0.5;

/// Two by two pixels, the last one beside the sphere.
SphereImage small_image(const Eigen::MatrixXd& radiance, double error = 0) {
  SphereImage image;
  image.size = 2;
  image.coverage = Eigen::Vector4d(1, 1, 1, 0);
  image.radiance = radiance;
  image.error = Eigen::MatrixXd::Constant(radiance.rows(), 4, error);
  return image;
}

/// A sphere of one colour.
DisplayedSphere plain(std::size_t size, std::uint8_t level) {
  DisplayedSphere sphere;
  sphere.size = size;
  sphere.rgb.assign(3 * size * size, level);
  return sphere;
}

TEST(Display, EncodesExposedRadiances) {
  const DisplayedSphere shown = display(small_image(Eigen::RowVector4d(0, 1, 2, 0)), kExposure);
  EXPECT_EQ(shown.rgb[0], 0);
  EXPECT_EQ(shown.rgb[3], 188);  // sRGB of 0.5 is 0.735357
  EXPECT_EQ(shown.rgb[6], 255);
  EXPECT_EQ(shown.rgb[9], shown.rgb[10]);
  EXPECT_GT(shown.rgb[9], 0);  // the background
}

TEST(Display, KeepsTheThreeChannelsOfAColour) {
  Eigen::MatrixXd radiance = Eigen::MatrixXd::Zero(3, 4);
  radiance.col(0) = Eigen::Vector3d(2, 1, 0);
  const DisplayedSphere shown = display(small_image(radiance), kExposure);
  EXPECT_EQ((std::vector<int>{shown.rgb[0], shown.rgb[1], shown.rgb[2]}), (std::vector<int>{255, 188, 0}));
}

TEST(Display, CountsWhatIsBrighterThanWhiteAndWhatIsNegative) {
  const DisplayedSphere shown = display(small_image(Eigen::RowVector4d(2.1, -0.1, 1, 0)), kExposure);
  EXPECT_EQ(shown.pixels, 3U);
  EXPECT_EQ(shown.clipped, 1U);
  EXPECT_EQ(shown.negative, 1U);
}

TEST(Display, StatesErrorsOfWhatIsSeen) {
  // Of the error 0.2 of white all is seen at half of white, none at three times white.
  const DisplayedSphere shown = display(small_image(Eigen::RowVector4d(1, 6, 6, 0), 0.4), kExposure);
  EXPECT_NEAR(shown.largest_error, 0.2, 1e-12);
  EXPECT_NEAR(shown.mean_error, 0.2 / 3, 1e-12);
}

TEST(Display, RefusesOtherNumbersOfChannels) {
  EXPECT_THROW((void)display(small_image(Eigen::MatrixXd::Zero(2, 4)), kExposure), ArgumentError);
}

TEST(PreviewSheet, HoldsTheSpheresPixelByPixel) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "sheet.png";
  DisplayedSphere first = plain(32, 200);
  for (std::size_t k = 0; k < first.rgb.size(); ++k) first.rgb[k] = static_cast<std::uint8_t>(k * 7 % 256);
  const std::vector<SheetCell> cells{{"a", {first, plain(32, 90)}}, {"b", {plain(32, 10), plain(32, 250)}}};

  const auto [width, height] = write_preview_sheet(cells, "caption", path, {.columns = 1});

  const Png png = read_png(path);
  EXPECT_EQ(png.width, width);
  EXPECT_EQ(png.height, height);
  const std::array<int, 3> corner{first.rgb[0], first.rgb[1], first.rgb[2]};
  // Found by its first row, then compared whole.
  std::size_t left = 0;
  std::size_t top = 0;
  for (std::size_t y = 0; y + 32 <= height && top == 0; ++y) {
    for (std::size_t x = 0; x + 32 <= width; ++x) {
      bool is_row = png.at(x, y) == corner;
      for (std::size_t i = 0; i < 32 && is_row; ++i) {
        is_row = png.at(x + i, y) == std::array<int, 3>{first.rgb[3 * i], first.rgb[3 * i + 1], first.rgb[3 * i + 2]};
      }
      if (!is_row) continue;
      left = x;
      top = y;
      break;
    }
  }
  ASSERT_GT(top, 0U) << "no row of the first sphere in the picture";
  for (std::size_t y = 0; y < 32; ++y) {
    SCOPED_TRACE(y);
    for (std::size_t x = 0; x < 32; ++x) {
      SCOPED_TRACE(x);
      const std::size_t at = 3 * (32 * y + x);
      ASSERT_EQ(png.at(left + x, top + y), (std::array<int, 3>{first.rgb[at], first.rgb[at + 1], first.rgb[at + 2]}));
    }
  }
  EXPECT_EQ(png.at(left + 40 + 16, top + 16), (std::array<int, 3>{90, 90, 90}));
}

TEST(PreviewSheet, LeavesNothingBesideThePicture) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  const std::vector<SheetCell> cells{
      {"it's a name with 'quotes' that is far too long for two lines of a cell", {plain(48, 9)}}};
  (void)write_preview_sheet(cells, "caption", directory.path() / "sheet.svg");
  EXPECT_EQ(std::distance(fs::directory_iterator(directory.path()), fs::directory_iterator()), 1);
  EXPECT_THAT(read_text(directory.path() / "sheet.svg"), HasSubstr("it's a"));
}

TEST(PreviewSheet, FailsWithoutGnuplotAndLeavesNothing) {
  const TemporaryDirectory directory;
  const ScopedVariable path("PATH", "");
  const std::vector<SheetCell> cells{{"a", {plain(8, 9)}}};
  try {
    (void)write_preview_sheet(cells, "caption", directory.path() / "sheet.png");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gnuplot is not installed"));
  }
  EXPECT_TRUE(fs::is_empty(directory.path()));
}

TEST(PreviewSheet, ReplacesFilesOnlyWhereAllowed) {
  ASSERT_TRUE(has_program("gnuplot")) << "gnuplot is missing; install gnuplot-nox";
  const TemporaryDirectory directory;
  const fs::path path = directory.path() / "sheet.png";
  write_text(path, false, "old");
  const std::vector<SheetCell> cells{{"a", {plain(8, 9)}}};
  EXPECT_THROW((void)write_preview_sheet(cells, "caption", path), IoError);
  EXPECT_EQ(read_text(path), "old");
  (void)write_preview_sheet(cells, "caption", path, {.overwrite = true});
  EXPECT_GT(read_png(path).width, 8U);
}

TEST(PreviewSheet, RefusesWhatIsNoSheet) {
  const std::vector<SheetCell> none;
  EXPECT_THROW((void)write_preview_sheet(none, "", "sheet.png"), ArgumentError);
  const std::vector<SheetCell> uneven{{"a", {plain(8, 9)}}, {"b", {plain(9, 9)}}};
  EXPECT_THROW((void)write_preview_sheet(uneven, "", "sheet.png"), ArgumentError);
  const std::vector<SheetCell> good{{"a", {plain(8, 9)}}};
  EXPECT_THROW((void)write_preview_sheet(good, "", "sheet.gif"), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
