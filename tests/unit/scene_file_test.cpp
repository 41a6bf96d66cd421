// Scene files: what is read of them, and the place of every mistake.
#include "lobe/study/scene_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <ostream>
#include <string>

#include "lobe/core/error.hpp"
#include "support/names.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kHead = R"(
[camera]
position = [0, -5, 2]
target = [0, 0, 1]
[materials]
grey = "lambert:scale=0.5"
)";
constexpr const char* kBall = "[[sphere]]\nmaterial = \"grey\"\ncentre = [0, 0, 1]\nradius = 1\n";

SceneFile read_scene(const std::string& text) {
  const TemporaryDirectory directory;
  std::ofstream(directory.path() / "a.toml") << text;
  std::ofstream(directory.path() / "t.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\n";
  std::ofstream(directory.path() / "m.toml") << "model = \"phong\"\nn = 7\nname = \"seven\"\n";
  return load_scene(directory.path() / "a.toml");
}

TEST(SceneFile, HasDefaults) {
  const SceneFile file = read_scene(std::string(kHead) + kBall);

  EXPECT_EQ(file.samples, 64U);
  EXPECT_EQ(file.strategy, SamplingStrategy::tailored);
  EXPECT_FALSE(file.exposure.has_value());
  EXPECT_FALSE(file.comparison.has_value());
  EXPECT_EQ(file.scene.bounces, 4U);
  EXPECT_EQ(file.scene.camera.up, (SpaceVector{0, 0, 1}));
  EXPECT_EQ(file.scene.sky.radiance, (LinearColour{0, 0, 0}));
  ASSERT_EQ(file.scene.shapes.size(), 1U);
  EXPECT_EQ(std::get<SphereShape>(file.scene.shapes[0].geometry).centre, (SpaceVector{0, 0, 1}));
}

TEST(SceneFile, ReadsEveryKey) {
  const SceneFile file = read_scene(R"(
[scene]
title = "all"
bounces = 0
samples = 8
strategy = "cosine"
exposure = 2
[camera]
position = [0, -5, 2]
target = [0, 0, 1]
up = [0, 1, 0]
field_of_view = 90
size = [30, 20]
[materials]
grey = "lambert:scale=0.5"
red = "lambert:scale=0.5/0.1/0.1"
seven = "m.toml"
[sky]
kind = "overcast"
radiance = [1, 2, 3]
[[light]]
position = [1, 2, 3]
intensity = 4
[[mesh]]
file = "t.obj"
material = "grey"
position = [1, 0, 0]
scale = 2
turn = 90
[[plane]]
material = "red"
centre = [0, 0, 0]
normal = [0, 1, 0]
size = [3, 4]
[[cylinder]]
material = "grey"
base = [0, 0, 0]
axis = [0, 0, 2]
radius = 0.5
[[box]]
material = "seven"
centre = [0, 0, 0]
size = [1, 2, 3]
turn = 180
[comparison]
material = "red"
with = ["phong:n=20", "m.toml"]
)");

  const Scene& scene = file.scene;
  EXPECT_EQ(scene.title, "all");
  EXPECT_EQ(scene.bounces, 0U);
  EXPECT_EQ(file.samples, 8U);
  EXPECT_EQ(file.strategy, SamplingStrategy::cosine);
  EXPECT_EQ(file.exposure, 2);
  EXPECT_EQ(scene.camera.up, (SpaceVector{0, 1, 0}));
  EXPECT_DOUBLE_EQ(scene.camera.field_of_view, std::numbers::pi / 2);
  EXPECT_EQ(scene.camera.size, (std::array<std::size_t, 2>{30, 20}));
  EXPECT_EQ(scene.sky.kind, SkyKind::overcast);
  EXPECT_EQ(scene.sky.radiance, (LinearColour{1, 2, 3}));
  EXPECT_EQ(scene.lights.at(0).intensity, (LinearColour{4, 4, 4}));
  ASSERT_EQ(scene.shapes.size(), 4U);  // by kind, in the order of the documentation
  EXPECT_DOUBLE_EQ(std::get<BoxShape>(scene.shapes[0].geometry).turn, std::numbers::pi);
  EXPECT_EQ(scene.materials.at(scene.shapes[0].material).name, "seven");
  EXPECT_EQ(scene.materials.at(scene.shapes[0].material).reflectance.formula()->terms.at(0).values.at(0), 7);
  EXPECT_EQ(std::get<CylinderShape>(scene.shapes[1].geometry).radius, 0.5);
  EXPECT_EQ(std::get<PlaneShape>(scene.shapes[2].geometry).size.value(), (std::array<double, 2>{3, 4}));
  const auto& mesh = std::get<MeshShape>(scene.shapes[3].geometry);
  EXPECT_NEAR(mesh.vertices[1][0], 1, 1e-15);  // (1, 0, 0) turned to (0, 1, 0), twice as far, and moved
  EXPECT_NEAR(mesh.vertices[1][1], 2, 1e-15);
  EXPECT_NEAR(mesh.normals[0][1], 1, 1e-15);
  ASSERT_TRUE(file.comparison);
  EXPECT_EQ(scene.materials.at(file.comparison->material).name, "red");
  EXPECT_EQ(file.comparison->with.at(0).name, "phong:n=20");
}

/// A mistake: what stands in the file, and what is said.
struct SceneMistake {
  std::string name, text, complaint;
};
std::ostream& operator<<(std::ostream& out, const SceneMistake& mistake) {
  return out << mistake.name;
}

std::string with_ball(const std::string& more) {
  return std::string(kHead) + kBall + more;
}

class SceneMistakes : public ::testing::TestWithParam<SceneMistake> {};

TEST_P(SceneMistakes, AreRefusedWithTheirPlace) {
  try {
    (void)read_scene(GetParam().text);
    FAIL() << "was read";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.toml:"));
    EXPECT_THAT(error.what(), HasSubstr(GetParam().complaint));
    EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("\n")));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, SceneMistakes,
    ::testing::Values(
        SceneMistake{"no_toml", "[camera\n", ":1:"}, SceneMistake{"nothing", "", "has no 'camera'"},
        SceneMistake{"no_materials", "[camera]\nposition=[0,0,0]\ntarget=[1,0,0]\n", "has no 'materials'"},
        SceneMistake{"no_shapes", kHead, "the scene has no shapes; expected a [[sphere]]"},
        SceneMistake{"unknown_table", with_ball("[[spheres]]\n"), "unknown key 'spheres' in a scene file"},
        SceneMistake{"unknown_key", with_ball("colour = 1\n"), ":11:1: unknown key 'colour' in [[sphere]]"},
        SceneMistake{"unknown_material",
                     std::string(kHead) + "[[sphere]]\nmaterial = \"gray\"\ncentre = [0, 0, 1]\nradius = 1\n",
                     ":8:12: there is no material 'gray'; did you mean 'grey'?"},
        SceneMistake{"no_radius", std::string(kHead) + "[[sphere]]\nmaterial = \"grey\"\ncentre = [0, 0, 1]\n",
                     "[[sphere]] has no 'radius'"},
        SceneMistake{"radius_0",
                     std::string(kHead) + "[[sphere]]\nmaterial = \"grey\"\ncentre = [0, 0, 1]\nradius = 0\n",
                     ":10:10: radius is 0; expected a value above 0"},
        SceneMistake{"two_numbers",
                     std::string(kHead) + "[[sphere]]\nmaterial = \"grey\"\ncentre = [0, 0]\nradius = 1\n",
                     "centre has 2 values; expected three numbers"},
        SceneMistake{"flat_box",
                     std::string(kHead) + "[[box]]\nmaterial = \"grey\"\ncentre = [0, 0, 0]\nsize = [1, 1, 0]\n",
                     ":7:1: shape 1 of the scene has no centre or size; expected three lengths above 0"},
        SceneMistake{
            "no_axis",
            std::string(kHead) + "[[cylinder]]\nmaterial = \"grey\"\nbase = [0, 0, 0]\naxis = [0, 0, 0]\nradius = 1\n",
            "has no base, axis or radius"},
        SceneMistake{"text_for_a_number", with_ball("[sky]\nradiance = \"bright\"\n"), "radiance is a text"},
        SceneMistake{"dark_light", with_ball("[[light]]\nposition = [0, 0, 0]\nintensity = -1\n"),
                     "intensity has a value below 0"},
        SceneMistake{"one_light", with_ball("[light]\nposition = [0, 0, 0]\nintensity = 1\n"),
                     "'light' is a table; expected tables headed [[light]]"},
        SceneMistake{"unknown_sky", with_ball("[sky]\nradiance = 1\nkind = \"blue\"\n"),
                     "kind is 'blue'; expected \"uniform\" or \"overcast\""},
        SceneMistake{"many_bounces", with_ball("[scene]\nbounces = 63\n"),
                     "bounces is 63; expected a whole number from 0 to 62"},
        SceneMistake{"one_sample", with_ball("[scene]\nsamples = 1\n"), "samples is 1; expected a whole number from 2"},
        SceneMistake{"half_a_sample", with_ball("[scene]\nsamples = 2.5\n"), "samples is 2.5; expected a whole number"},
        SceneMistake{"unknown_strategy", with_ball("[scene]\nstrategy = \"best\"\n"), "strategy is 'best'"},
        SceneMistake{"wide_angle",
                     "[camera]\nposition = [0, 0, 0]\ntarget = [1, 0, 0]\nfield_of_view = 180\n[materials]\n",
                     ":4:17: field_of_view is 180 degrees; expected a value between 0 and 180"},
        SceneMistake{"no_view",
                     "[camera]\nposition = [1, 0, 0]\ntarget = [1, 0, 0]\n[materials]\ngrey = \"lambert\"\n" +
                         std::string(kBall),
                     "the camera stands where it looks at"},
        SceneMistake{"up_along_view",
                     "[camera]\nposition = [0, 0, 9]\ntarget = [0, 0, 0]\n[materials]\ngrey = \"lambert\"\n" +
                         std::string(kBall),
                     "the camera's up is no direction across its view"},
        SceneMistake{"picture_of_one_edge",
                     "[camera]\nposition = [0, 0, 0]\ntarget = [1, 0, 0]\nsize = [10]\n[materials]\n",
                     "size has 1 values; expected two"},
        SceneMistake{"no_model", "[camera]\nposition = [0, 0, 0]\ntarget = [1, 0, 0]\n[materials]\nred = \"lambart\"\n",
                     ":5:7: "},
        SceneMistake{"two_channels",
                     "[camera]\nposition = [0, 0, 0]\ntarget = [1, 0, 0]\n[materials]\nred = \"lambert:scale=1/0\"\n",
                     "material 'red' has 2 channels without a colour; expected 1, a grey, 3"},
        SceneMistake{"empty_comparison", with_ball("[comparison]\nmaterial = \"grey\"\nwith = []\n"),
                     "with is empty; expected at least one reflectance"}),
    ByName());

TEST(SceneFile, SaysWhichMeshIsMissing) {
  EXPECT_THROW((void)read_scene(std::string(kHead) + "[[mesh]]\nmaterial = \"grey\"\nfile = \"no.obj\"\n"), IoError);
  EXPECT_THROW((void)load_scene("nowhere.toml"), IoError);
}

}  // namespace
}  // namespace lobe::test
