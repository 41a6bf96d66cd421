#include "lobe/study/material_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "core/files.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Numbers whose decimal forms are awkward: no point, exponents of both signs, every digit, beyond 64-bit integers.
Material awkward() {
  Material material{"a \"quoted\" \\ name √", "approximation", {}};
  material.terms = {{"phong", {0.1 + 0.2}, {1, -0.0, 1e-7}},
                    {"phong", {40}, {1.0 / 3, std::numeric_limits<double>::denorm_min(), 12345678901234567890.0}},
                    {"lafortune",
                     make_material("lafortune", {{"c_xy", -1.25}, {"c_z", 0.9}, {"n", 1e5}}).terms[0].values,
                     {std::numeric_limits<double>::max()}},
                    {"lambert", {}, {-1e22}}};
  return material;
}

Material read_back(const Material& material, const std::string& comment = {}) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "material.toml";
  save_material(material, path, false, comment);
  return load_material_file(path);
}

TEST(MaterialFile, ReadsBackToTheLastBit) {
  const Material written = awkward();

  const Material read = read_back(written);

  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.family, written.family);
  ASSERT_EQ(read.terms.size(), written.terms.size());
  for (std::size_t i = 0; i < read.terms.size(); ++i) {
    EXPECT_EQ(read.terms[i].model, written.terms[i].model) << i;
    EXPECT_EQ(read.terms[i].values, written.terms[i].values) << i;
    EXPECT_EQ(read.terms[i].weight, written.terms[i].weight) << i;
  }
}

TEST(MaterialFile, IsNotWrittenWithNamesThatCannotBeRead) {
  Material material = awkward();
  material.name = "two\nlines";
  EXPECT_THROW((void)material_toml(material, ""), ArgumentError);
  material.name = "one";
  material.family = "\x1b[2J";
  EXPECT_THROW((void)material_toml(material, ""), ArgumentError);
}

TEST(MaterialFile, IsNotReadFromAFileWithControlCharactersInItsName) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "a\x1b[2J.toml";
  write_text(path, false, "model = \"lambert\"\n");
  EXPECT_THROW((void)load_material_file(path), ArgumentError);
}

TEST(MaterialFile, ReadsBackEveryExponentOfTwo) {
  Material written{"powers", "mixture", {{"lambert", {}, {}}}};
  for (double value = 1e-300; value < 1e300; value *= 1.7) written.terms[0].weight.push_back(value);

  EXPECT_EQ(read_back(written).terms[0].weight, written.terms[0].weight);
}

TEST(MaterialFile, KeepsCommentsInFront) {
  const std::string comment = "where it is from\n\nand\thow";

  EXPECT_THAT(material_toml(parse_material("lambert"), comment),
              StartsWith("# where it is from\n#\n# and how\n\nname"));
  EXPECT_EQ(read_back(parse_material("lambert"), comment).name, "lambert");
}

TEST(MaterialFile, TakesTheNameOfTheFileWhereThereIsNone) {
  EXPECT_EQ(read_back(Material{"", "", parse_material("lambert").terms}).name, "material");
}

TEST(MaterialFile, IsReplacedOnlyWhenAsked) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "material.toml";
  save_material(parse_material("lambert"), path);

  EXPECT_THROW(save_material(parse_material("phong:n=1"), path), IoError);
  EXPECT_THAT(read_text(path), HasSubstr("lambert"));
  save_material(parse_material("phong:n=1"), path, true);
  EXPECT_THAT(read_text(path), HasSubstr("phong"));
}

TEST(MaterialFile, RefusesTermsThatFitNoModel) {
  EXPECT_THROW((void)material_toml({"x", "", {{"phong", {}, {1}}}}), ArgumentError);
  EXPECT_THROW((void)material_toml({"x", "", {{"nonsuch", {}, {1}}}}), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
