// `lobe preview`: the sheet it leaves, what it says of it, what it refuses.
#include <cmath>
#include <fstream>
#include <iterator>

#include "cli/command_test.hpp"
#include "support/png.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::Contains;
using ::testing::HasSubstr;

class Preview : public CommandTest {};

TEST_F(Preview, LeavesASheetWithTheReferenceAndEveryMaterialUnderBothLights) {
  const Json answer = json({"preview", "lambert:scale=0.9/0.2/0.1", "phong:n=20", "-o", "s.png", "--size", "24"});

  EXPECT_EQ(answer["schema"], "lobe.preview/1");
  ASSERT_EQ(answer["materials"].size(), 3U);
  EXPECT_EQ(answer["materials"][0]["name"], "grey reference sphere");
  EXPECT_EQ(answer["materials"][1]["colours"], "linear sRGB");
  EXPECT_EQ(answer["materials"][2]["colours"], "grey");
  for (const auto& material : answer["materials"]) {
    SCOPED_TRACE(material["name"]);
    ASSERT_EQ(material["spheres"].size(), 2U);
    for (const auto& sphere : material["spheres"]) {
      SCOPED_TRACE(sphere["light"]);
      EXPECT_LT(sphere["largest_error"], 1.0 / 512);
      EXPECT_EQ(sphere["negative_pixels"], 0);
    }
  }
  const Png png = read_png(file("s.png"));
  EXPECT_EQ(answer["width"], png.width);
  EXPECT_EQ(answer["height"], png.height);
  EXPECT_THAT(files(), ::testing::ElementsAre("s.png"));
}

TEST_F(Preview, ShowsTheReferenceUnderDaylightAtHalfOfTheRange) {
  make({"preview", "lambert", "-o", "s.png", "--size", "40", "--light", "daylight", "--columns", "2"});

  const Png png = read_png(file("s.png"));
  int greys = 0;  // half of 255 levels is between two of them
  for (std::size_t y = 0; y < png.height; ++y) {
    for (std::size_t x = 0; x < png.width; ++x) {
      const auto [red, green, blue] = png.at(x, y);
      greys += (red == 127 || red == 128) && green == red && blue == red ? 1 : 0;
    }
  }
  // All pixels within the outline: the area of the disc but for its rim.
  EXPECT_NEAR(greys, 3.1416 * 20 * 20, 120);
}

TEST_F(Preview, PrintsATableOfErrors) {
  const auto outcome = make({"preview", "mirror", "-o", "s.png", "--size", "16", "--light", "both"});
  EXPECT_THAT(outcome.output, HasSubstr("largest error"));
  EXPECT_THAT(outcome.output, HasSubstr("mirror"));
  EXPECT_THAT(outcome.output, HasSubstr("s.png: "));
}

TEST_F(Preview, TakesTablesByTheNamesOfTheirFiles) {
  make({"tabulate", "phong:n=4", "--grid", "gauss:12x24", "-o", "t.h5"});
  const Json answer = json({"preview", "t.h5", "-o", "s.png", "--size", "12"});
  EXPECT_EQ(answer["materials"][1]["name"], "t");
}

TEST_F(Preview, RefusesWhatItCannotDraw) {
  expect_refusal({"preview", "lambert", "-o", "s.gif"}, ExitCode::usage, ".png or .svg");
  expect_refusal({"preview", "lambert", "-o", "s.png", "--light", "moon"}, ExitCode::usage, "unknown light 'moon'");
  expect_refusal({"preview", "lambert", "-o", "s.png", "--size", "0"}, ExitCode::usage, "--size 0");
  expect_refusal({"preview", "phong:n=1e10", "-o", "s.png", "--size", "16"}, ExitCode::numeric, "too narrow");
  std::ofstream(file("s.png")) << "old";
  expect_refusal({"preview", "lambert", "-o", "s.png"}, ExitCode::file, "--force");
}

}  // namespace
}  // namespace lobe::test
