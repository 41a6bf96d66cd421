#include "lobe/study/chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "energy/prepare.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/estimates.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

Chart chart_of(ChartQuantity quantity, Material material, double theta_in = 0) {
  Chart chart;
  chart.name = "chart";
  chart.quantity = quantity;
  chart.x = {0.1, 0.7, 1.5};
  chart.curves = {{"curve", {std::move(material)}, theta_in}};
  return chart;
}

TEST(ChartQuantity, HasNamesThatReadBack) {
  for (const auto quantity : {ChartQuantity::albedo, ChartQuantity::mirror_radiance, ChartQuantity::reflectance,
                              ChartQuantity::radiance, ChartQuantity::mean_albedo}) {
    EXPECT_EQ(parse_chart_quantity(to_string(quantity)), quantity);
  }
  EXPECT_THROW((void)parse_chart_quantity("albdo"), ArgumentError);
}

TEST(ComputeChart, GivesAlbedos) {
  const Material ward = make_material("ward", {{"m", 0.2}});
  const Chart chart = chart_of(ChartQuantity::albedo, ward);
  const auto values = compute_chart(device(), chart, 1e-7);
  const auto albedos = albedo(device(), ward, chart.x, {.tolerance = 1e-7}).front();

  ASSERT_EQ(values.size(), 1U);
  ASSERT_EQ(values[0].size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    EXPECT_EQ(values[0][k].value, albedos[k].value);
    EXPECT_EQ(values[0][k].error, albedos[k].error);
  }
}

// The lobe of (2.6) has c_n = (n+2)/(2 pi) in the mirror direction, and so has the unit.
TEST(ComputeChart, RelatesTheRadianceOfAPhongMirrorToNormalIncidence) {
  Chart chart = chart_of(ChartQuantity::mirror_radiance, make_material("phong", {{"n", 20}}));
  chart.unit = make_material("phong", {{"n", 20}});
  const auto values = compute_chart(device(), chart).front();

  for (std::size_t k = 0; k < 3; ++k) {
    SCOPED_TRACE(k);
    EXPECT_NEAR(values[k].value, std::cos(chart.x[k]), 1e-12);  // of the kernel, with room
    EXPECT_LT(values[k].error, 1e-11);
  }
}

TEST(ComputeChart, PutsTheMirrorDirectionAtPositiveAngles) {
  const Material phong = make_material("phong", {{"n", 50}});
  Chart chart = chart_of(ChartQuantity::reflectance, phong, 40 * kDegree);
  chart.x = {-40 * kDegree, 10 * kDegree, 40 * kDegree};
  const auto values = compute_chart(device(), chart).front();
  const std::array at{Directions{40 * kDegree, 40 * kDegree, 0}, Directions{40 * kDegree, 10 * kDegree, pi},
                      Directions{40 * kDegree, 40 * kDegree, pi}};
  const auto expected = evaluate(device(), phong, at);

  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_EQ(values[static_cast<std::size_t>(k)].value, expected(k, 0)) << k;
  EXPECT_NEAR(values[2].value, 52 / (2 * pi), 1e-10);
  EXPECT_LT(values[0].value, values[1].value);
}

TEST(ComputeChart, MultipliesRadiancesByTheCosineOfIncidence) {
  const auto values = compute_chart(device(), chart_of(ChartQuantity::radiance, make_material("lambert"), pi / 3));
  EXPECT_THAT(values.front(), ::testing::Each(EstimateNear(0.5 / pi, 1e-14)));
}

// 1 - 3 sqrt(3) / (4 pi) at R = 1, and 1 at R = 2 (Neumann 2001, 4.11).
TEST(ComputeChart, SweepsMeanAlbedos) {
  Chart chart = chart_of(ChartQuantity::mean_albedo, make_material("basic_patch", {{"R", 1}}));
  chart.parameter = "R";
  chart.x = {1, 2};
  EXPECT_THROW((void)compute_chart(device(), chart), ArgumentError);
  chart.curves.front().materials.push_back(make_material("basic_patch", {{"R", 2}}));
  const auto values = compute_chart(device(), chart).front();

  ASSERT_EQ(values.size(), 2U);
  EXPECT_NEAR(values[0].value, 1 - 3 * std::sqrt(3) / (4 * pi), values[0].error);
  EXPECT_NEAR(values[1].value, 1, values[1].error);
  EXPECT_LT(values[0].error, 3e-6);
}

TEST(ComputeChart, CountsWhatAdjustmentsMayBeOffBy) {
  Material pumped = make_material("phong", {{"n", 2}});
  pumped.adjustments = {parse_adjustment("pump:correction=controlled,times=2")};
  const Chart chart = chart_of(ChartQuantity::mirror_radiance, pumped);
  const auto values = compute_chart(device(), chart).front();
  const auto expected = evaluate(device(), prepare(device(), pumped), std::array{Directions{0.7, 0.7, pi}});

  EXPECT_NEAR(values[1].value, expected(0, 0) * std::cos(0.7), 1e-14);
  EXPECT_NEAR(values[1].error, 2 * kAdjustmentError * values[1].value, 1e-11);
}

TEST(ComputeChart, StopsWhenAskedTo) {
  const Chart chart = chart_of(ChartQuantity::radiance, make_material("lambert"));
  EXPECT_THROW((void)compute_chart(device(), chart, 1e-6, [](std::string_view, double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace lobe::test
