#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>

#include "core/files.hpp"
#include "io/load_text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/study/study.hpp"
#include "support/names.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

TEST(LoadPublished, ReadsATable) {
  const Study study = load_text(R"([[published]]
title = "Table 1"
quantity = "albedo"
model = "ward"
m = "$m"
theta = "$theta"
offset = -1
tolerance = 1e-4
unit = {model = "phong", n = 2}
columns = ["m", "theta", "printed", "corrected"]
rows = [[0.1, 30, "0.35", ""], [0.2, 60, "7.8e-3", "7.9e-3"]]
)");

  ASSERT_EQ(study.published.size(), 2U);
  EXPECT_TRUE(study.materials.empty());
  EXPECT_TRUE(study.lightings.empty());
  const PublishedFigure& figure = study.published[1];
  EXPECT_EQ(figure.table, "Table 1");
  EXPECT_EQ(figure.label, "m = 0.2, theta = 60");
  EXPECT_EQ(figure.quantity, PublishedQuantity::albedo);
  EXPECT_EQ(figure.material.terms.at(0).values, std::vector<double>{0.2});
  EXPECT_DOUBLE_EQ(figure.at.at(0).theta_in, 60 * kDegree);
  EXPECT_EQ(figure.offset, -1);
  EXPECT_EQ(figure.tolerance, 1e-4);
  EXPECT_EQ(figure.unit->terms.at(0).model, "phong");
  EXPECT_EQ(figure.printed, "7.8e-3");
  EXPECT_EQ(figure.corrected, "7.9e-3");
  EXPECT_EQ(study.published[0].corrected, "");
}

TEST(LoadPublished, ReadsASingleFigure) {
  const Study study = load_text(R"([[published]]
title = "Section 2"
label = "difference"
quantity = "reflectance"
at = [[0, 30, 0], [60, 60, 180]]
coefficients = [1, -1]
terms = [{model = "lambert", scale = 0.5}, {model = "ward", m = 0.2}]
printed = "0.2"
corrected = "0.3"

[[material]]
name = "a"
model = "lambert"
)");

  ASSERT_EQ(study.published.size(), 1U);
  EXPECT_EQ(study.materials.size(), 1U);
  EXPECT_EQ(study.lightings.size(), 2U);
  const PublishedFigure& figure = study.published[0];
  EXPECT_EQ(figure.label, "difference");
  EXPECT_EQ(figure.material.terms.size(), 2U);
  EXPECT_EQ(figure.coefficients, (std::vector<double>{1, -1}));
  EXPECT_DOUBLE_EQ(figure.at.at(1).delta_phi, std::numbers::pi);
  EXPECT_EQ(figure.corrected, "0.3");
  EXPECT_FALSE(figure.unit.has_value());
}

struct Mistake {
  std::string name;
  std::string text;
  std::string message;
};

class LoadPublishedRefuses : public ::testing::TestWithParam<Mistake> {};

TEST_P(LoadPublishedRefuses, WithThePlace) {
  try {
    (void)load_text("[[published]]\ntitle = \"T\"\nmodel = \"lambert\"\n" + GetParam().text);
    FAIL() << "nothing was thrown";
  } catch (const ArgumentError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    mistakes, LoadPublishedRefuses,
    ::testing::ValuesIn(std::vector<Mistake>{
        {"quantity", "quantity = \"albdo\"\nprinted = \"1\"\n",
         ":4:12: unknown quantity 'albdo'; did you mean 'albedo'?"},
        {"no quantity", "printed = \"1\"\n", "[[published]] has no 'quantity'; expected one"},
        {"not printed", "quantity = \"constant\"\n", "has no 'printed'; expected it as a key or as a column"},
        {"no number", "quantity = \"constant\"\nprinted = \"1/pi\"\n", ":5:11: '1/pi' is no decimal number"},
        {"number instead of text", "quantity = \"constant\"\nprinted = 1.5\n", ":5:11: printed is"},
        {"no angle", "quantity = \"albedo\"\nprinted = \"1\"\n", "[[published]] of albedos has no 'theta'"},
        {"angle", "quantity = \"albedo\"\ntheta = 90\nprinted = \"1\"\n",
         ":5:9: theta is 90 degrees; expected a value in [0, 90)"},
        {"useless angle", "quantity = \"constant\"\ntheta = 30\nprinted = \"1\"\n",
         ":5:1: theta has no meaning for constant; expected it for albedo only"},
        {"no directions", "quantity = \"reflectance\"\nprinted = \"1\"\n", "[[published]] of reflectances has no 'at'"},
        {"two angles", "quantity = \"reflectance\"\nat = [[0, 1]]\nprinted = \"1\"\n",
         "an entry of at has 2 numbers; expected theta_in, theta_out and delta_phi in degrees"},
        {"coefficients", "quantity = \"reflectance\"\nat = [[0, 1, 2]]\ncoefficients = [1, 2]\nprinted = \"1\"\n",
         "coefficients has 2 numbers; expected 1, one per entry of at"},
        {"tolerance", "quantity = \"constant\"\ntolerance = 1\nprinted = \"1\"\n",
         ":5:13: tolerance is 1; expected a value in [1e-12, 0.1]"},
        {"row", "quantity = \"constant\"\ncolumns = [\"printed\"]\nrows = [[\"1\", \"2\"]]\n",
         "row has 2 entries; expected 1, one per column"},
        {"unknown key", "quantity = \"constant\"\nprintd = \"1\"\n", "printd"},
        {"lightings", "quantity = \"constant\"\nprinted = \"1\"\n[study]\nlightings = [\"point\"]\n",
         "lightings is given but the study has no material"},
    }),
    ByName{});

}  // namespace
}  // namespace lobe::test
