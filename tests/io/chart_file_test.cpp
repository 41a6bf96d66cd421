#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
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

TEST(LoadCharts, ReadsCurvesOverAnAngle) {
  const Study study = load_text(R"([[chart]]
name = "2.6"
title = "Radiance"
quantity = "radiance"
x = [-30, 0, 60]
unit = {model = "phong", n = 2}
tolerance = 1e-4
log_y = true
y_range = [0.1, 2]
curves = [
  {label = "a", model = "ward", m = 0.1, theta_in = 40, adjustments = ["pump:times=2"]},
  {label = "b", theta_in = 0, terms = [{model = "lambert"}, {model = "ward", m = 0.2}]},
]
)");

  EXPECT_TRUE(study.materials.empty());
  EXPECT_TRUE(study.lightings.empty());
  ASSERT_EQ(study.charts.size(), 1U);
  const Chart& chart = study.charts[0];
  EXPECT_EQ(chart.name, "2.6");
  EXPECT_EQ(chart.title, "Radiance");
  EXPECT_EQ(chart.quantity, ChartQuantity::radiance);
  ASSERT_EQ(chart.x.size(), 3U);
  EXPECT_DOUBLE_EQ(chart.x[0], -30 * kDegree);
  EXPECT_EQ(chart.unit->terms.at(0).model, "phong");
  EXPECT_EQ(chart.tolerance, 1e-4);
  EXPECT_FALSE(chart.log_x);
  EXPECT_TRUE(chart.log_y);
  EXPECT_EQ(chart.y_range, std::pair(0.1, 2.0));
  ASSERT_EQ(chart.curves.size(), 2U);
  EXPECT_EQ(chart.curves[0].label, "a");
  EXPECT_DOUBLE_EQ(chart.curves[0].theta_in, 40 * kDegree);
  EXPECT_EQ(chart.curves[0].materials.at(0).adjustments, std::vector{parse_adjustment("pump:times=2")});
  EXPECT_EQ(chart.curves[1].materials.at(0).terms.size(), 2U);
}

TEST(LoadCharts, ReadsASweptParameter) {
  const Study study = load_text(R"([[chart]]
name = "means"
quantity = "mean-albedo"
parameter = "R"
x = {linspace = [0.5, 2], count = 4}
log_x = true
curves = [{label = "patch", model = "basic_patch", scale = 0.5}]
)");

  const Chart& chart = study.charts.at(0);
  EXPECT_EQ(chart.title, "means");
  EXPECT_EQ(chart.x, (std::vector{0.5, 1.0, 1.5, 2.0}));
  ASSERT_EQ(chart.curves.at(0).materials.size(), 4U);
  EXPECT_EQ(chart.curves[0].materials[2].terms.at(0).values, std::vector{1.5});
  EXPECT_EQ(chart.curves[0].materials[2].terms.at(0).weight, std::vector{0.5});
}

TEST(LoadCharts, HasAnglesOfItsOwnUpToGrazing) {
  const Study study =
      load_text("[[chart]]\nname = \"a\"\nquantity = \"albedo\"\ncurves = [{label = \"a\", model = \"lambert\"}]\n");

  const std::vector<double>& x = study.charts.at(0).x;
  EXPECT_EQ(x.front(), 0);
  EXPECT_NEAR(x.back(), 89.9 * kDegree, 1e-14);
  EXPECT_LT(x.back() - x[x.size() - 2], 0.02 * kDegree);
}

TEST(LoadCharts, ReadsTheStudyOfFigures) {
  const Study study = load_study(std::filesystem::path(LOBE_STUDIES_DIRECTORY) / "albedo-figures.toml");

  EXPECT_EQ(study.charts.size(), 19U);
  EXPECT_EQ(std::ranges::count(study.charts, ChartQuantity::albedo, &Chart::quantity), 11);
}

struct ChartMistake {
  std::string name;
  std::string text;
  std::string message;
};

class LoadChartRefuses : public ::testing::TestWithParam<ChartMistake> {};

TEST_P(LoadChartRefuses, WithThePlace) {
  try {
    (void)load_text("[[chart]]\nname = \"a\"\n" + GetParam().text);
    FAIL() << "nothing was thrown";
  } catch (const ArgumentError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
  }
}

const std::string kChartCurves = "curves = [{label = \"a\", model = \"lambert\"}]\n";
const std::string kAlbedo = "quantity = \"albedo\"\n";
const std::string kMeans = "quantity = \"mean-albedo\"\nparameter = \"R\"\nx = [1, 3]\n";

INSTANTIATE_TEST_SUITE_P(
    mistakes, LoadChartRefuses,
    ::testing::ValuesIn(std::vector<ChartMistake>{
        {"quantity", "quantity = \"albdo\"\n" + kChartCurves,
         ":3:12: unknown quantity 'albdo'; did you mean 'albedo'?"},
        {"no quantity", kChartCurves, ":1:1: [[chart]] has no 'quantity'; expected one"},
        {"no curves", kAlbedo, ":1:1: [[chart]] has no 'curves'; expected one"},
        {"empty curves", kAlbedo + "curves = []\n", ":4:10: curves is empty; expected at least one {label = ..."},
        {"no label", kAlbedo + "curves = [{model = \"lambert\"}]\n", ":4:11: a curve has no 'label'; expected one"},
        {"unknown key", kAlbedo + "y_rnge = [0, 1]\n" + kChartCurves, ":4:1: unknown key 'y_rnge' in [[chart]]"},
        {"unknown model", kAlbedo + "curves = [{label = \"a\", model = \"lambrt\"}]\n", "did you mean 'lambert'?"},
        {"horizon", kAlbedo + "x = [0, 90]\n" + kChartCurves, ":4:5: x has 90 degrees; expected values in [0, 90)"},
        {"below", kAlbedo + "x = [-1, 9]\n" + kChartCurves, ":4:5: x has -1 degrees; expected values in [0, 90)"},
        {"descending", kAlbedo + "x = [2, 1]\n" + kChartCurves, ":4:5: x does not ascend; expected two values or more"},
        {"range", kAlbedo + "y_range = [1, 0]\n" + kChartCurves,
         ":4:11: y_range is no range; expected [lowest, highest]"},
        {"range of logarithms", kAlbedo + "log_y = true\ny_range = [0, 1]\n" + kChartCurves,
         "[lowest, highest], above 0"},
        {"tolerance", kAlbedo + "tolerance = 1\n" + kChartCurves, ":4:13: tolerance is 1; expected a value in"},
        {"useless parameter", kAlbedo + "parameter = \"m\"\n" + kChartCurves,
         ":4:1: parameter has no meaning for albedo; expected it for mean-albedo only"},
        {"useless angle", kAlbedo + "curves = [{label = \"a\", model = \"lambert\", theta_in = 3}]\n",
         ":4:44: theta_in has no meaning for albedo; expected it for reflectance and radiance only"},
        {"no angle", "quantity = \"radiance\"\n" + kChartCurves, "a curve over the viewer's angle has no 'theta_in'"},
        {"angle", "quantity = \"radiance\"\ncurves = [{label = \"a\", model = \"lambert\", theta_in = 90}]\n",
         ":4:55: theta_in is 90 degrees; expected a value in [0, 90)"},
        {"logarithm of angles", "quantity = \"radiance\"\nlog_x = true\n" + kChartCurves,
         ":4:1: log_x has no meaning for"},
        {"no parameter", "quantity = \"mean-albedo\"\nx = [1, 2]\n" + kChartCurves,
         "of mean albedos has no 'parameter'"},
        {"no abscissae", "quantity = \"mean-albedo\"\nparameter = \"R\"\n" + kChartCurves,
         "over a parameter has no 'x'"},
        {"parameter of another model", kMeans + kChartCurves, ":6:33: model 'lambert' has no parameter 'R' to sweep"},
        {"given parameter", kMeans + "curves = [{label = \"a\", model = \"basic_patch\", R = 1}]\n",
         ":6:48: 'R' is given but swept by the chart"},
        {"swept too far", kMeans + "curves = [{label = \"a\", model = \"basic_patch\"}]\n",
         ":5:5: parameter 'R' of model 'basic_patch' is 3; expected a value in"},
        {"file name", kAlbedo + kChartCurves + "[[chart]]\nname = \"b/c\"\n" + kAlbedo + kChartCurves,
         ":6:8: name 'b/c' is no part of file names"},
        {"twice", kAlbedo + kChartCurves + "[[chart]]\nname = \"a\"\n" + kAlbedo + kChartCurves,
         ":6:8: chart 'a' exists already; expected distinct names"},
    }),
    ByName{});

}  // namespace
}  // namespace lobe::test
