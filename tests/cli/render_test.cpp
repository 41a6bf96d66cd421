// `lobe render`: the files it leaves, what it says of them, what it refuses.
#include <cmath>
#include <fstream>
#include <iterator>

#include "cli/command_test.hpp"
#include "support/png.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class Render : public CommandTest {
 protected:
  void SetUp() override { write("s.toml", ""); }
  /// A scene of a ball on the ground.
  void write(const std::string& name, const std::string& more) const {
    std::ofstream(file(name)) << R"([camera]
position = [0, -5, 2]
target = [0, 0, 1]
size = [24, 16]
[materials]
red = "ggx:alpha=0.4,scale=0.9/0.2/0.1"
ground = "lambert:scale=0.5"
[sky]
radiance = 0.5
[[light]]
position = [-2, -3, 5]
intensity = 20
[[sphere]]
material = "red"
centre = [0, 0, 1]
radius = 1
[[plane]]
material = "ground"
centre = [0, 0, 0]
)" << more;
  }
  [[nodiscard]] std::string bytes(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
};

TEST_F(Render, LeavesAPictureAndItsRadiances) {
  const Json answer = json({"render", "s.toml", "-o", "a.png", "--samples", "16"});

  EXPECT_EQ(answer["schema"], "lobe.render/1");
  EXPECT_EQ(answer["samples"], 16);
  EXPECT_EQ(answer["strategy"], "importance");
  EXPECT_EQ(answer["picture"], "a.png");
  EXPECT_EQ(answer["radiances"], "a.exr");
  EXPECT_GT(answer["seconds"], 0);
  ASSERT_EQ(answer["mean_radiance"].size(), 3U);
  ASSERT_EQ(answer["mean_variance"].size(), 3U);
  for (std::size_t c = 0; c < 3; ++c) {
    SCOPED_TRACE(c);
    EXPECT_GT(answer["mean_radiance"][c]["value"], 0.1);
    // The error of the mean is that of its pixels.
    EXPECT_NEAR(answer["mean_radiance"][c]["error"], std::sqrt(double(answer["mean_variance"][c]) / (24 * 16)), 1e-12);
  }
  EXPECT_THAT(files(), UnorderedElementsAre("s.toml", "a.png", "a.exr"));
  const Png png = read_png(file("a.png"));
  EXPECT_EQ(png.width, 24U);
  EXPECT_EQ(png.height, 16U);
  const auto [red, green, blue] = png.at(12, 8);  // the ball
  EXPECT_GT(red, green + 20);
  EXPECT_THAT(bytes("a.exr"), HasSubstr("variance.R"));
}

TEST_F(Render, GivesTheSameBytesForTheSameSeed) {
  make({"render", "s.toml", "-o", "a.png", "--samples", "8", "--seed", "5"});
  make({"render", "s.toml", "-o", "b.png", "--samples", "8", "--seed", "5", "--live"});
  make({"render", "s.toml", "-o", "c.png", "--samples", "8", "--seed", "6"});

  EXPECT_EQ(bytes("a.png"), bytes("b.png"));
  EXPECT_EQ(bytes("a.exr"), bytes("b.exr"));
  EXPECT_NE(bytes("a.exr"), bytes("c.exr"));
}

TEST_F(Render, ObeysItsOptions) {
  const Json answer = json({"render", "s.toml", "-o", "a.png", "--samples", "4", "--width", "12", "--strategy",
                            "cosine", "--exposure", "3", "--patches", "roulette"});
  EXPECT_EQ(answer["width"], 12);
  EXPECT_EQ(answer["height"], 8);
  EXPECT_EQ(answer["strategy"], "cosine");
  EXPECT_EQ(answer["exposure"], 3.0);
  const Json calm = json({"render", "s.toml", "-o", "b.png", "--samples", "100000", "--noise", "0.05"});
  EXPECT_LE(calm["relative_noise"], 0.05);
  EXPECT_LT(calm["samples"], 100000);
  const Json brief = json({"render", "s.toml", "-o", "c.png", "--samples", "1000000", "--time", "0.1"});
  EXPECT_LT(brief["samples"], 1000000);
  EXPECT_GE(brief["seconds"], 0.1);
}

TEST_F(Render, DrawsAnotherMaterialInPlaceOfOneOfTheScene) {
  write("blue.toml", "");
  std::ifstream stream(file("blue.toml"));
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::string red = "ggx:alpha=0.4,scale=0.9/0.2/0.1";
  text.replace(text.find(red), red.size(), "phong:n=20,scale=0.1/0.2/0.9");
  std::ofstream(file("blue.toml")) << text;
  make({"render", "blue.toml", "-o", "a.png", "--samples", "4"});
  make({"render", "s.toml", "-o", "b.png", "--samples", "4", "--replace", "red=lambert", "--replace",
        "red=phong:n=20,scale=0.1/0.2/0.9"});
  EXPECT_EQ(bytes("a.exr"), bytes("b.exr"));
  // Files, too.
  make({"export", "ggx:alpha=0.4", "--format", "csv", "-o", "ggx.csv"});
  make({"render", "s.toml", "-o", "c.png", "--samples", "2", "--width", "6", "--replace", "red=ggx.csv"});
}

TEST_F(Render, SaysInTextWhatItDid) {
  const auto outcome = make({"render", "s.toml", "-o", "a.png", "--samples", "2"});
  EXPECT_THAT(outcome.output, HasSubstr("a.png and a.exr: 24 x 16 pixels, 2 samples each, by importance"));
  EXPECT_THAT(outcome.output, HasSubstr("mean radiance"));
  EXPECT_THAT(outcome.error, ::testing::IsEmpty());
}

TEST_F(Render, ComparesStrategies) {
  write("c.toml", "[comparison]\nmaterial = \"red\"\nwith = [\"lambert\", \"ggx:alpha=0.2\"]\n");

  const Json answer = json({"render", "c.toml", "--compare-sampling", "--samples", "32"});
  ASSERT_EQ(answer["comparison"].size(), 2U);
  EXPECT_EQ(answer["comparison"][1]["material"], "ggx:alpha=0.2");
  EXPECT_EQ(answer["comparison"][0]["equal_samples"]["value"], 1.0);
  EXPECT_GT(answer["comparison"][1]["equal_samples"]["value"], 1.0);
  const auto outcome = make({"render", "c.toml", "--compare-sampling", "--samples", "16"});
  EXPECT_THAT(outcome.output, HasSubstr("ratio at equal time"));
  EXPECT_THAT(outcome.output, HasSubstr("ggx:alpha=0.2"));
  EXPECT_THAT(files(), UnorderedElementsAre("s.toml", "c.toml"));
}

TEST_F(Render, RefusesWhatItCannotDo) {
  expect_refusal({"render", "s.toml"}, ExitCode::usage, "nothing to write");
  expect_refusal({"render", "s.toml", "-o", "a.gif"}, ExitCode::usage, "ends with .png");
  expect_refusal({"render", "s.toml", "-o", "a.png", "--samples", "1"}, ExitCode::usage, "1 samples per pixel");
  expect_refusal({"render", "s.toml", "-o", "a.png", "--noise", "0"}, ExitCode::usage, "--noise 0");
  expect_refusal({"render", "s.toml", "--compare-sampling"}, ExitCode::usage, "has no [comparison]");
  const auto replacing = [](const std::string& text) {
    return std::vector<std::string>{"render", "s.toml", "-o", "a.png", "--replace", text};
  };
  expect_refusal(replacing("lambert"), ExitCode::usage, "--replace 'lambert' names no material of the scene");
  expect_refusal(replacing("rad=lambert"), ExitCode::usage, "no material 'rad'; did you mean 'red'?");
  expect_refusal(replacing("sky=lambert"), ExitCode::usage, "no material 'sky'; known: ground, red");
  expect_refusal(replacing("red=lambart"), ExitCode::usage, "did you mean 'lambert'?");
  expect_refusal(replacing("red=no.csv"), ExitCode::file, "no.csv");
  expect_refusal(replacing("red=lambert:scale=1/0"), ExitCode::usage, "has 2 channels without a colour");
  expect_refusal({"render", "no.toml", "-o", "a.png"}, ExitCode::file, "no.toml");
  std::ofstream(file("f.toml"))
      << "[materials]\nred = \"no.csv\"\n[camera]\nposition = [0, -5, 2]\ntarget = [0, 0, 1]\n";
  expect_refusal({"render", "f.toml", "-o", "a.png"}, ExitCode::file, "f.toml:2:7: cannot read");
  write("m.toml", "[[mesh]]\nmaterial = \"red\"\nfile = \"no.obj\"\n");
  expect_refusal({"render", "m.toml", "-o", "a.png"}, ExitCode::file, "m.toml:22:8: cannot read no.obj");
  write("w.toml", "[[sphere]]\n");
  expect_refusal({"render", "w.toml", "-o", "a.png"}, ExitCode::usage, "w.toml:20:1: ");
  write("c.toml", "[comparison]\nmaterial = \"red\"\nwith = [\"lambert\"]\n");
  expect_refusal({"render", "c.toml", "--compare-sampling", "--samples", "20"}, ExitCode::usage, "a multiple of 8");
  expect_refusal({"render", "c.toml", "--compare-sampling", "-o", "a.png"}, ExitCode::usage, "leave out --output");
  std::ofstream(file("b.exr")) << "old";
  expect_refusal({"render", "s.toml", "-o", "b.png"}, ExitCode::file, "b.exr exists; use --force");
  EXPECT_EQ(bytes("b.exr"), "old");
  EXPECT_THAT(files(), UnorderedElementsAre("s.toml", "w.toml", "c.toml", "b.exr", "f.toml", "m.toml"));
}

}  // namespace
}  // namespace lobe::test
