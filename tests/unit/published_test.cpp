#include "lobe/study/published.hpp"

#include <gtest/gtest.h>

#include "lobe/core/error.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

PublishedFigure lambert(std::string printed, std::string corrected = {}) {
  PublishedFigure figure;
  figure.table = "table";
  figure.label = "figure";
  figure.material = make_material("lambert");
  figure.at = {{}};
  figure.coefficients = {1};
  figure.printed = std::move(printed);
  figure.corrected = std::move(corrected);
  return figure;
}

PublishedCheck check(const PublishedFigure& figure) {
  return check_published(device(), {&figure, 1}).front();
}

TEST(UnitOfLastDigit, FollowsTheDecimals) {
  EXPECT_DOUBLE_EQ(unit_of_last_digit("0.350"), 1e-3);
  EXPECT_DOUBLE_EQ(unit_of_last_digit("10430."), 1);
  EXPECT_DOUBLE_EQ(unit_of_last_digit("91"), 1);
  EXPECT_DOUBLE_EQ(unit_of_last_digit("7.8e-3"), 1e-4);
  EXPECT_DOUBLE_EQ(unit_of_last_digit("-2E2"), 100);
}

TEST(UnitOfLastDigit, RefusesWhatIsNoNumber) {
  for (const char* text : {"", ".", "1/pi", "0.3x", "e3"}) {
    EXPECT_THROW((void)unit_of_last_digit(text), ArgumentError) << text;
  }
}

TEST(PublishedQuantity, HasNamesThatReadBack) {
  for (const auto quantity :
       {PublishedQuantity::reflectance, PublishedQuantity::albedo, PublishedQuantity::mean_albedo,
        PublishedQuantity::largest_albedo, PublishedQuantity::largest_albedo_angle, PublishedQuantity::constant}) {
    EXPECT_EQ(parse_published_quantity(to_string(quantity)), quantity);
  }
  EXPECT_THROW((void)parse_published_quantity("albdo"), ArgumentError);
}

// 1/pi = 0.31830988618...
TEST(CheckPublished, RoundsToTheLastDigit) {
  EXPECT_TRUE(check(lambert("0.318")).is_as_expected);
  EXPECT_TRUE(check(lambert("0.3183099")).is_as_expected);
  EXPECT_FALSE(check(lambert("0.317")).is_as_expected);
  EXPECT_FALSE(check(lambert("0.3184")).is_as_expected);
  EXPECT_NEAR(check(lambert("0.317")).deviation, 1.3098862, 1e-7);
}

TEST(CheckPublished, WantsTheCorrectedFigureAndNotThePrintedOne) {
  EXPECT_TRUE(check(lambert("0.317", "0.318")).is_as_expected);
  EXPECT_FALSE(check(lambert("0.317", "0.319")).is_as_expected);
  EXPECT_FALSE(check(lambert("0.318", "0.318")).is_as_expected);
  EXPECT_FALSE(check(lambert("0.317", "0.318")).agrees);
}

TEST(CheckPublished, IsUndecidedBelowTheErrorOfTheValue) {
  PublishedFigure figure = lambert("0.6666667");
  figure.quantity = PublishedQuantity::mean_albedo;
  figure.material = make_material("phong", {{"n", 1e6}});
  figure.tolerance = 1e-3;

  EXPECT_FALSE(check(figure).is_as_expected);
}

TEST(CheckPublished, ComputesEveryQuantity) {
  PublishedFigure figure = lambert("0.5");
  figure.material = make_material("metal_phong", {{"n", 1}});
  figure.unit = make_material("lambert");
  figure.coefficients = {1.0 / 3};
  EXPECT_TRUE(check(figure).is_as_expected);  // 3/(2 pi) over 1/pi

  figure.unit.reset();
  figure.quantity = PublishedQuantity::largest_albedo;
  figure.offset = -1;
  figure.printed = "0.000289";
  EXPECT_TRUE(check(figure).is_as_expected);

  figure.quantity = PublishedQuantity::largest_albedo_angle;
  figure.offset = 0;
  figure.printed = "12.9";
  figure.corrected = "";
  EXPECT_NEAR(check(figure).value.value, 12.905761556562647, check(figure).value.error);
  EXPECT_LE(check(figure).value.error, 0.25);
}

TEST(CheckPublished, RefusesIncompleteFigures) {
  PublishedFigure figure = lambert("0.318");
  figure.coefficients.clear();
  EXPECT_THROW((void)check(figure), ArgumentError);
  figure.quantity = PublishedQuantity::albedo;
  figure.at.clear();
  EXPECT_THROW((void)check(figure), ArgumentError);
}

TEST(CheckPublished, CanBeCancelled) {
  const PublishedFigure figure = lambert("0.318");
  EXPECT_THROW((void)check_published(device(), {&figure, 1}, 1e-6, [](auto, double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace lobe::test
