// Files with options in brackets behind their names.
#include "lobe/formats/chosen_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/measured_files.hpp"
#include "lobe/core/directions.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;

void expect_no_choice(const std::string& text, const std::string& complaint) {
  expect_complaint([&] { static_cast<void>(parse_file(text)); }, complaint);
  expect_complaint([&] { static_cast<void>(parse_file(text)); }, "'" + text + "', character ");
}

TEST(ChosenFile, HasItsOptionsInBrackets) {
  const ChosenFile file = parse_file("dir/a.bsdf[theta_max=80, channels = red, 2 ,component=reflection back,srgb]");
  EXPECT_EQ(file.path, "dir/a.bsdf");
  EXPECT_TRUE(file.has_brackets);
  EXPECT_DOUBLE_EQ(file.options.theta_max, 80 * kDegree);
  EXPECT_THAT(file.options.channels, ElementsAre("red", "2"));
  EXPECT_EQ(file.options.component, "reflection back");
  EXPECT_TRUE(file.options.decode_srgb);
  EXPECT_THAT(parse_file("a.csv[wavelengths=450,532.5]").options.wavelengths, ElementsAre(450, 532.5));
  EXPECT_EQ(parse_file("a.csv[luminance=photopic]").options.luminance, "photopic");
  EXPECT_DOUBLE_EQ(parse_file("a.csv[theta-max=60]").options.theta_max, 60 * kDegree);
  const ChosenFile shader =
      parse_file("a.glsl[entry=f,uniform=a=1,uniform=b=1/2]", {.entry = "g", .uniforms = {{"a", {3}}, {"c", {4}}}});
  EXPECT_EQ(shader.options.entry, "f");
  EXPECT_THAT(shader.options.uniforms,
              ElementsAre(UniformValue{"c", {4}}, UniformValue{"a", {1}}, UniformValue{"b", {1, 2}}));
  EXPECT_FALSE(parse_file("a.csv[srgb=false]", {.decode_srgb = true}).options.decode_srgb);
}

TEST(ChosenFile, WithoutBracketsAtItsEndIsAPath) {
  for (const auto* text : {"a.csv", "a[1].csv", "[x]/a.csv", "phong:n=20", ""}) {
    SCOPED_TRACE(text);
    const ChosenFile file = parse_file(text, {.luminance = "rec709"});
    EXPECT_EQ(file.path, text);
    EXPECT_FALSE(file.has_brackets);
    EXPECT_EQ(file.options.luminance, "rec709");
  }
}

TEST(ChosenFile, ThatExistsByTheWholeNameIsThatFile) {
  const TemporaryDirectory directory;
  const std::string name = (directory.path() / "a.csv[theta_max=80]").string();
  EXPECT_TRUE(parse_file(name).has_brackets);
  write_file(name, "x");
  EXPECT_EQ(parse_file(name).path, name);
  EXPECT_FALSE(has_choices(parse_file(name).options));
  const ChosenFile both = parse_file(name + "[theta_max=70]");
  EXPECT_EQ(both.path, name);
  EXPECT_DOUBLE_EQ(both.options.theta_max, 70 * kDegree);
}

TEST(ChosenFile, HasAdjustmentsBehindIt) {
  const TemporaryDirectory directory;
  const std::string table = (directory.path() / "a@b" / "t.h5").string();
  const ChosenFile file = parse_file("dir/paint.toml@pump:times=2 @ normalise");
  EXPECT_EQ(file.path, "dir/paint.toml");
  ASSERT_EQ(file.adjustments.size(), 2U);
  EXPECT_EQ(to_string(file.adjustments[0]), "pump:correction=g1,times=2");
  EXPECT_EQ(file.adjustments[1].kind, Adjustment::Kind::normalise);
  EXPECT_EQ(parse_file(table + "@mirror").path, table);
  const ChosenFile chosen = parse_file("a.h5[channels=red]@normalise");
  EXPECT_EQ(chosen.path, "a.h5");
  EXPECT_THAT(chosen.options.channels, ElementsAre("red"));
  EXPECT_EQ(chosen.adjustments.size(), 1U);
  // A path may have the sign, and a specification has its own adjustments.
  for (const auto* text : {"a@b/c.csv", "./me@normal.csv", "phong:n=2.5@normalise", "lambert@pump"}) {
    EXPECT_EQ(parse_file(text).path, text);
    EXPECT_TRUE(parse_file(text).adjustments.empty()) << text;
  }
  expect_complaint([] { static_cast<void>(parse_file("a.toml@normalize")); }, "did you mean 'normalise'?");
  EXPECT_NO_THROW(refuse_adjustments(parse_file("a.h5")));
  expect_complaint([&] { refuse_adjustments(chosen); }, "'@normalise' behind a.h5 adjusts a formula; expected");
}

TEST(ChosenFile, HasOptionsOfItsOwnBeforeThoseOfAll) {
  const ReadOptions all{.luminance = "rec709", .theta_max = 1, .component = "reflection front"};
  const ReadOptions own = parse_file("a.xml[channels=red,component=reflection back]", all).options;
  EXPECT_THAT(own.channels, ElementsAre("red"));
  EXPECT_EQ(own.luminance, "");
  EXPECT_EQ(own.theta_max, 1);
  EXPECT_EQ(own.component, "reflection back");
}

TEST(ChosenFile, IsRefusedAtThePlaceOfTheMistake) {
  expect_no_choice("a.csv[thta_max=80]", "character 7: unknown option 'thta_max' of a file; did you mean 'theta_max'?");
  expect_no_choice("a.csv[srgb,theta_max=x]", "character 22: theta_max has 'x'; expected degrees above 0, at most 90");
  expect_no_choice("a.csv[theta_max=100]", "character 17: theta_max is 100; expected degrees above 0, at most 90");
  expect_no_choice("a.csv[luminance=rec70]", "unknown weights of luminance 'rec70'; did you mean 'rec709'?");
  expect_no_choice("a.csv[wavelengths=450,red]", "character 23: wavelengths has 'red'");
  expect_no_choice("a.csv[channels=]", "'channels' has no value; expected channels=NAME,...");
  expect_no_choice("a.csv[red]", "character 7: 'red' is no KEY=VALUE");
  expect_no_choice("a.csv[theta_max=80,red]", "character 20: 'red' is no KEY=VALUE");
  expect_no_choice("a.csv[theta_max=80,theta_max=70]", "character 20: 'theta_max' is given twice");
  expect_no_choice("a.csv[channels=1,luminance=rec709]", "character 18: 'luminance' stands beside 'channels'");
  expect_no_choice("a.glsl[uniform=a]", "character 16: 'a' sets no uniform; expected NAME=VALUE");
  expect_no_choice("a.csv[srgb=maybe]", "srgb is 'maybe'; expected true or false");
  expect_no_choice("a.csv[]", "character 7: nothing stands in the brackets");
  expect_no_choice("[theta_max=80]", "no file stands before the bracket");
  const TemporaryDirectory directory;
  const std::string name = (directory.path() / "a.csv").string();
  write_file(name, "x");
  expect_no_choice(name + "[theta_max=80", "no ']' closes this bracket");
}

}  // namespace
}  // namespace lobe::test
