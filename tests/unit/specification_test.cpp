#include "lobe/model/specification.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/shell.hpp"
#include "energy/prepare.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

/// What was read back has the same JSON but for the name.
void expect_same(const Material& material) {
  const auto text = specification(material);
  ASSERT_TRUE(text.has_value()) << to_json(material);
  Material read = parse_material(*text);
  read.name = material.name;
  read.family = material.family;
  EXPECT_EQ(to_json(read), to_json(material)) << *text;
}

TEST(Specification, IsReadAsTheSameMaterialToTheLastBit) {
  expect_same(parse_material("lambert"));
  expect_same(parse_material("lambert:scale=0.3+ward:m=0.1,scale=0.5"));
  expect_same(parse_material("phong:n=20*cos_max:p=0.5*fresnel:ior=0.2,k=3.9"));
  expect_same(parse_material("ward:m=1e-3/0.12/0.2,scale=0.9/0.6/0.3"));
  expect_same(parse_material("phong:n=1e+10,scale=1e-30"));
  expect_same(parse_material("phong:n=20@pump:correction=controlled,times=2@normalise@mirror:ior=1.5"));
}

TEST(Specification, KeepsFactorsThatHaveNoShortText) {
  Material material = parse_material("phong:n=20");
  material.terms.front().values.front() = 1.0 / 3;
  material.terms.front().weight = {0.1 + 0.2, 1.0 / 7};
  expect_same(material);
}

TEST(Specification, DoesNotExistOfFormulas) {
  Material material = parse_material("lambert");
  material.terms.front().model = kCustomModel;
  material.terms.front().formula = Formula{.text = "cos_i", .parameters = {}};
  EXPECT_FALSE(specification(material).has_value());
}

TEST(Specification, DoesNotExistOfWhatIsPumpedUp) {
  const Material pumped = prepare(device(), parse_material("phong:n=20@pump"));
  EXPECT_FALSE(specification(pumped).has_value());
}

TEST(Specification, DoesNotExistOfNothing) {
  EXPECT_FALSE(specification({}).has_value());
}

TEST(ShellWord, LeavesPlainWordsAlone) {
  EXPECT_EQ(shell_word("ward:m=0.1,scale=0.5+lambert"), "ward:m=0.1,scale=0.5+lambert");
}

TEST(ShellWord, QuotesWhatAShellWouldRead) {
  EXPECT_EQ(shell_word("phong:n=20*cos_max"), "'phong:n=20*cos_max'");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace lobe::test
