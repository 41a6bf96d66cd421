// Families as they are written.
#include "lobe/fit/fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "fit/fit_space.hpp"
#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> labels(const std::string& text) {
  std::vector<std::string> list;
  for (const auto& parameter : parse_family(text).parameters) list.push_back(parameter.label);
  return list;
}

std::string complaint(const std::string& text) {
  try {
    (void)parse_family(text);
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "none";
}

TEST(Family, LeavesOpenWhatHasNoValueAndNoDefault) {
  const Family family = parse_family("lambert+cook_torrance");

  EXPECT_THAT(labels("lambert+cook_torrance"), ElementsAre("m"));
  EXPECT_EQ(family.parameters.front().term, 1U);
  EXPECT_THAT(family.has_free_scale, ElementsAre(true, true));
  EXPECT_EQ(family.terms[1].values[1], 1) << "f0 by default";
}

TEST(Family, KeepsWhatIsGiven) {
  const Family family = parse_family("lambert:scale=0.1/0.2+ward:m=0.2");

  EXPECT_TRUE(family.parameters.empty());
  EXPECT_THAT(family.has_free_scale, ElementsAre(false, true));
  EXPECT_THAT(family.terms[0].weight, ElementsAre(0.1, 0.2));
  EXPECT_EQ(family.terms[1].values.front(), 0.2);
}

TEST(Family, FreesAParameterWithADefault) {
  EXPECT_THAT(labels("cook_torrance:f0=free"), ElementsAre("m", "f0"));
}

TEST(Family, NumbersTermsWhereNamesAreNotUnique) {
  EXPECT_THAT(labels("lambert+ward+ward+phong"), ElementsAre("2.m", "3.m", "n"));
}

TEST(Family, TakesParametersOfFactors) {
  const Family family = parse_family("phong*fresnel:k=3");

  EXPECT_THAT(labels("phong*fresnel:k=3"), ElementsAre("n", "ior"));
  EXPECT_EQ(family.parameters[1].factor, 0U);
}

TEST(Family, RefusesWhatItCannotRead) {
  EXPECT_THAT(complaint("wart"), HasSubstr("did you mean 'ward'"));
  EXPECT_THAT(complaint("ward:q=1"), HasSubstr("has no parameter 'q'"));
  EXPECT_THAT(complaint("ward:q=free"), HasSubstr("has no parameter 'q'"));
  EXPECT_THAT(complaint("ward:m=0.1/0.2"), HasSubstr("expected one value"));
  EXPECT_THAT(complaint("ward@normalise"), HasSubstr("adjustment"));
  EXPECT_THAT(complaint("ward:m=0.1,scale=1"), HasSubstr("leaves nothing to find"));
  EXPECT_THAT(complaint("mirror"), HasSubstr("delta part"));
  EXPECT_THAT(complaint("custom"), HasSubstr("'custom'"));
  EXPECT_THAT(complaint(""), HasSubstr("empty family"));
}

TEST(SearchScale, ComesBackToTheValue) {
  for (const SearchScale& scale :
       {SearchScale::of(1e-5, 100), SearchScale::of(0, 100), SearchScale::of(-2, 2), SearchScale::of(-1, 100)}) {
    SCOPED_TRACE(scale.value(0));
    EXPECT_NEAR(scale.value(scale.coordinate(1.5)), 1.5, 1e-14);
  }
}

TEST(SearchScale, TakesLogarithmsOfWhatSpansDecades) {
  EXPECT_TRUE(SearchScale::of(1e-5, 100).is_logarithmic);
  EXPECT_TRUE(SearchScale::of(0, 100).is_logarithmic);
  EXPECT_FALSE(SearchScale::of(0, 1).is_logarithmic);
}

TEST(FitSpace, RefusesARangeBeyondTheCatalogue) {
  const std::vector<FitRange> ranges{{"m", 0, 1}};
  EXPECT_THROW(FitSpace(parse_family("ward"), 1, ranges), ArgumentError);
}

TEST(FitSpace, RefusesARangeOfAnotherParameter) {
  const std::vector<FitRange> ranges{{"n", 1, 10}};
  EXPECT_THROW(FitSpace(parse_family("ward"), 1, ranges), ArgumentError);
}

TEST(FitObjective, HasNamesThatAreReadBack) {
  for (const FitObjective objective : {FitObjective::l2, FitObjective::log, FitObjective::perceptual}) {
    EXPECT_EQ(parse_fit_objective(to_string(objective)), objective);
  }
  EXPECT_THROW((void)parse_fit_objective("l1"), ArgumentError);
}

TEST(Correlation, IsZeroBesideWhatIsNotKnown) {
  Eigen::MatrixXd covariance(2, 2);
  covariance << 4, 0, 0, std::numeric_limits<double>::infinity();

  const Eigen::MatrixXd result = correlation(covariance);

  EXPECT_EQ(result(0, 0), 1);
  EXPECT_EQ(result(1, 1), 0);
  EXPECT_EQ(result(0, 1), 0);
}

}  // namespace
}  // namespace lobe::test
