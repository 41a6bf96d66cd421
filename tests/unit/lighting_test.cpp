#include "lobe/metric/lighting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

class LightingName : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(unit, LightingName,
                         ::testing::Values("point", "daylight", "mean-albedo", "patch:0.5", "mixture:0.25=0.3,1=0.7",
                                           "density:0=1,0.5=2,2=0", "material:phong:n=20",
                                           "material:lambert:scale=0.5+ward:m=0.2*fresnel:ior=1.5,k=0"));

TEST_P(LightingName, ReadsBack) {
  const Lighting lighting = parse_lighting(GetParam());

  EXPECT_EQ(lighting.name(), GetParam());
  EXPECT_EQ(parse_lighting(lighting.name()), lighting);
  EXPECT_EQ(lighting.stem().find_first_of(":=,/ *+"), std::string::npos);
}

struct Wrong {
  const char* text;
  const char* complaint;
};

class WrongLighting : public ::testing::TestWithParam<Wrong> {};
INSTANTIATE_TEST_SUITE_P(
    unit, WrongLighting,
    ::testing::Values(Wrong{"dayligt", "did you mean 'daylight'?"}, Wrong{"point:1", "'point' takes no value"},
                      Wrong{"patch", "expected patch:R"}, Wrong{"patch:0", "radius 0 of a patch light is out of range"},
                      Wrong{"patch:2.5", "expected a value in (0, 2]"},
                      Wrong{"patch:x", "'x' in lighting 'patch:x' is not a number"}, Wrong{"patch:nan", "not a number"},
                      Wrong{"mixture:0.5", "expected RADIUS=VALUE"},
                      Wrong{"mixture:0=1", "radius 0 of a patch light is out of range"},
                      Wrong{"mixture:0.5=-1", "is negative"}, Wrong{"mixture:0.5=0", "no positive weight"},
                      Wrong{"density:0.5=1", "at least two points"}, Wrong{"density:1=1,0.5=1", "do not rise at 0.5"},
                      Wrong{"density:0=0,1=0", "zero everywhere"}, Wrong{"material", "expected material:MATERIAL"},
                      Wrong{"material:phongg:n=2", "did you mean 'phong'?"},
                      Wrong{"material:phong:n=2/3", "has 2 channels; expected one"}));

TEST_P(WrongLighting, IsAnArgumentErrorThatSaysWhy) {
  try {
    (void)parse_lighting(GetParam().text);
    FAIL() << "expected ArgumentError";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(GetParam().complaint));
  }
}

TEST(LightingDensity, IsIntegratedExactlyWhereItIsLinear) {
  // The triangle 0, 2 at R = 0.5, 0 at R = 1.5: integrals of w and of R w are 1.5 and 1.
  const Lighting lighting = Lighting::density({{0, 0}, {0.5, 2}, {1.5, 0}});

  for (const int nodes : {2, 6}) {
    SCOPED_TRACE(nodes);
    double weight = 0;
    double moment = 0;
    for (const PatchShare& share : lighting.shares(nodes)) {
      weight += share.weight;
      moment += share.radius * share.weight;
    }
    EXPECT_NEAR(weight, 1.5, 1e-14);
    EXPECT_NEAR(moment, 1, 1e-14);
  }
}

}  // namespace
}  // namespace lobe::test
