// Averages over pairs of cells: against plain product rules over all four coordinates, and by the light that they
// carry.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "energy/albedo.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"
#include "reference/cell_averages.hpp"
#include "reference/models.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/tables.hpp"
#include "table/cell_overlap.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

using reference::Vector;
using std::numbers::pi;

struct AveragedModel {
  const char* material;
  reference::Reflectance f;
};

const AveragedModel kGgx{"ggx:alpha=0.1",
                         [](const Vector& l, const Vector& v) { return reference::ggx(l, v, 0.1L, 1); }};
const AveragedModel kWard{"ward:m=0.2", [](const Vector& l, const Vector& v) { return reference::ward(l, v, 0.2L); }};
const AveragedModel kBrushed{"ward_anisotropic:m_x=0.2,m_y=0.5", [](const Vector& l, const Vector& v) {
                               return reference::ward_anisotropic(l, v, 0.2L, 0.5L, 0);
                             }};

struct AveragedPair {
  AveragedModel model;
  const char* grid;
  std::size_t in;
  std::size_t out;
  int order;         ///< of the reference; a higher one changes it by less than `tolerance`
  double tolerance;  ///< of the reference, relative
};

class CellPair : public ::testing::TestWithParam<AveragedPair> {};

// Patch 50 of klems:145 lies at 40 degrees, 62 opposite to it; 25 at 30 degrees, 32 nearly opposite.
INSTANTIATE_TEST_SUITE_P(all, CellPair,
                         ::testing::Values(AveragedPair{kGgx, "klems:145", 50, 62, 16, 1e-8},
                                           AveragedPair{kGgx, "klems:145", 50, 63, 16, 1e-8},
                                           AveragedPair{kGgx, "klems:145", 30, 62, 12, 1e-7},
                                           AveragedPair{kGgx, "klems:145", 0, 3, 24, 1e-6},
                                           AveragedPair{kWard, "klems:73", 40, 50, 20, 1e-6},
                                           AveragedPair{kWard, "shirley-chiu:4", 4, 6, 12, 1e-6},
                                           AveragedPair{kWard, "shirley-chiu:4", 1, 10, 12, 1e-6},
                                           AveragedPair{kWard, "shirley-chiu:4", 0, 2, 12, 1e-6},
                                           AveragedPair{kBrushed, "klems:41", 12, 16, 12, 1e-6},
                                           AveragedPair{kBrushed, "shirley-chiu:4", 5, 13, 12, 1e-6}),
                         [](const auto& test) {
                           const AveragedPair& pair = test.param;
                           return test_name(std::string(pair.model.material) + " " + pair.grid + " " +
                                            std::to_string(pair.in) + " " + std::to_string(pair.out));
                         });

reference::PolarCell polar_cell(const HemisphereGrid& grid, std::size_t node) {
  const Ring& ring = grid.rings()[grid.ring_of(node)];
  const double half = pi / static_cast<double>(ring.count);
  const double phi = grid.directions()[node].phi;
  return {ring.theta_low, ring.theta_high, phi - half, phi + half};
}

/// The square that a node of a shirley-chiu grid is the middle of, by the sectors of the map.
reference::SquareCell square_cell(const HemisphereGrid& grid, std::size_t node) {
  const Direction at = grid.directions()[node];
  const double side = 2 / std::sqrt(static_cast<double>(grid.nodes()));
  const double r = std::sin(at.theta);
  const double phi = std::fmod(at.phi + 2 * pi + pi / 4, 2 * pi) - pi / 4;
  double a = r;
  double b = r;
  if (phi < pi / 4 + 1e-9) {
    b = 4 / pi * phi * r;
  } else if (phi < 3 * pi / 4 + 1e-9) {
    a = -4 / pi * (phi - pi / 2) * r;
  } else if (phi < 5 * pi / 4 + 1e-9) {
    a = -r;
    b = -4 / pi * (phi - pi) * r;
  } else {
    a = 4 / pi * (phi - 3 * pi / 2) * r;
    b = -r;
  }
  return {a - side / 2, b - side / 2, side};
}

TEST_P(CellPair, IsWhatAPlainProductRuleGives) {
  const AveragedPair& pair = GetParam();
  const auto table = table_of(pair.model.material, pair.grid);
  const HemisphereGrid& grid = table.grid;
  const double expected =
      grid.kind() == GridKind::shirley_chiu
          ? reference::cell_average(pair.model.f, square_cell(grid, pair.in), square_cell(grid, pair.out), pair.order)
          : reference::cell_average(pair.model.f, polar_cell(grid, pair.in), polar_cell(grid, pair.out), pair.order);
  const double error = table.error[grid.ring_of(pair.in) * grid.rings().size() + grid.ring_of(pair.out)];

  EXPECT_NEAR(table.values[pair.in * grid.nodes() + pair.out], expected, error + pair.tolerance * expected);
  // Large enough, and worth something: the error is that of the largest value between the rings.
  // Over four coordinates, as on squares, the budget ends before the tolerance.
  const double tight = grid.kind() == GridKind::shirley_chiu ? 0.1 : 1e-2;
  EXPECT_LT(error, tight * *std::ranges::max_element(table.values));
}

struct LightCase {
  const char* material;
  const char* grid;
  double largest_error;  ///< that is stated, relative
};

class LightOfCells : public ::testing::TestWithParam<LightCase> {};

INSTANTIATE_TEST_SUITE_P(
    all, LightOfCells,
    ::testing::Values(LightCase{"lambert:scale=0.5", "klems:145", 1e-13}, LightCase{"ggx:alpha=0.1", "klems:145", 2e-4},
                      LightCase{"ggx:alpha=0.02", "klems:145", 1e-3}, LightCase{"phong:n=1000", "klems:73", 1e-3},
                      LightCase{"ward:m=0.1", "cells:8x24", 1e-3}, LightCase{"phong:n=20", "shirley-chiu:4", 0.1},
                      LightCase{"lafortune:c_xy=0.5,c_z=0.7,n=40", "klems:77", 1e-3},
                      LightCase{"ward_anisotropic:m_x=0.3,m_y=0.6", "klems:41", 5e-3},
                      // A jump at the patch's edge.
                      LightCase{"basic_patch:R=0.3", "klems:41", 2e-2}),
    [](const auto& test) { return test_name(std::string(test.param.material) + " " + test.param.grid); });

TEST_P(LightOfCells, IsThatOfTheFormula) {
  const auto found = row_albedos(table_of(GetParam().material, GetParam().grid)).mean.front();
  const auto expected = mean_albedo(device(), parse_material(GetParam().material), {.tolerance = 1e-7}).front();

  EXPECT_NEAR(found.value, expected.value, found.error + expected.error);
  EXPECT_LT(found.error, GetParam().largest_error * expected.value);
}

TEST_P(LightOfCells, OfTheSameAsAFunctionIsTheSame) {
  const auto grid = HemisphereGrid::parse(GetParam().grid);
  const auto function = as_function(device(), parse_material(GetParam().material));
  const auto found = row_albedos(tabulate(function, grid, {.allow_unresolved = true})).mean.front();
  const auto expected = row_albedos(table_of(GetParam().material, grid)).mean.front();

  EXPECT_NEAR(found.value, expected.value, found.error + expected.error);
}

TEST(AveragesOfOneSide, AreMeantWithThoseOfTheOther) {
  // f = 1 + sin(delta_phi) sin(theta_in) sin(theta_out) has the mean 1 of both sides, on product grids alone.
  BrdfFunction twisted;
  twisted.name = "twisted";
  twisted.channels = {"value"};
  twisted.at = [](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      values.value(static_cast<Eigen::Index>(i), 0) =
          1 + std::sin(pairs[i].delta_phi) * std::sin(pairs[i].theta_in) * std::sin(pairs[i].theta_out);
    }
    return values;
  };
  const auto product = tabulate(twisted, HemisphereGrid::cells(4, 8));
  for (const double value : product.values) EXPECT_NEAR(value, 1, 1e-12);
  // At 90 degrees the sides differ by nearly twice the product of sines; the largest in the last ring.
  EXPECT_GT(product.error.back(), 0.7);

  const auto klems = tabulate(twisted, HemisphereGrid::klems(41));
  // The last ring, from 66 to 90 degrees: its first patch and the one 90 degrees further on.
  EXPECT_GT(klems.values[33 * 41 + 35], 1.7);
  EXPECT_LT(klems.values[35 * 41 + 33], 0.3);
}

class OverlapOf : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

INSTANTIATE_TEST_SUITE_P(
    all, OverlapOf,
    ::testing::Values(std::pair{"klems:145", "klems:145"}, std::pair{"klems:145", "klems:73"},
                      std::pair{"klems:145", "shirley-chiu:16"}, std::pair{"shirley-chiu:16", "klems:145"},
                      std::pair{"shirley-chiu:4", "shirley-chiu:16"}, std::pair{"cells:7x18", "shirley-chiu:8"},
                      std::pair{"klems:41", "cells:5x12"}),
    [](const auto& test) { return test_name(std::string(test.param.first) + " " + test.param.second); });

TEST_P(OverlapOf, CoversEveryCellOnce) {
  const auto from = HemisphereGrid::parse(GetParam().first);
  const auto to = HemisphereGrid::parse(GetParam().second);
  const Eigen::MatrixXd shares(cell_overlaps(from, to));
  const Eigen::MatrixXd back(cell_overlaps(to, from));
  for (Eigen::Index i = 0; i < shares.rows(); ++i) {
    EXPECT_NEAR(shares.row(i).sum(), 1, 1e-12) << i;
    for (Eigen::Index k = 0; k < shares.cols(); ++k) {
      // What both share is the same from either side.
      EXPECT_NEAR(to.weights()[static_cast<std::size_t>(i)] * shares(i, k),
                  from.weights()[static_cast<std::size_t>(k)] * back(k, i), 1e-13)
          << i << ' ' << k;
    }
  }
}

TEST(Overlaps, AreWhatDirectionsOfACellFind) {
  // 200 x 200 directions of each cell, by the cells that they lie in: right to a row of them.
  const auto from = HemisphereGrid::shirley_chiu(8);
  const auto to = HemisphereGrid::klems(73);
  const Eigen::MatrixXd shares(cell_overlaps(from, to));
  for (const std::size_t node : {0U, 4U, 30U, 70U}) {
    Eigen::VectorXd found = Eigen::VectorXd::Zero(shares.cols());
    const auto directions = to.cell_points(node, 200);
    for (const Direction& at : directions) found(static_cast<Eigen::Index>(from.node_at(at))) += 1;
    found /= static_cast<double>(directions.size());
    EXPECT_LT((shares.row(static_cast<Eigen::Index>(node)).transpose() - found).cwiseAbs().maxCoeff(), 5e-3) << node;
  }
}

TEST(ResamplingOfCells, KeepsAllLight) {
  const auto table = table_of("ward:m=0.2", "shirley-chiu:8");
  const double before = row_albedos(table).mean.front().value;
  const auto klems = resample(table, HemisphereGrid::klems(145));
  const auto back = resample(klems, HemisphereGrid::cells(6, 12));

  EXPECT_NEAR(row_albedos(klems).mean.front().value, before, 1e-12);
  EXPECT_NEAR(row_albedos(back).mean.front().value, before, 1e-12);
}

TEST(ResamplingOfCells, ToFinerOnesAndBackChangesNothing) {
  const auto table = table_of("ward:m=0.3", "shirley-chiu:4");
  const auto back = resample(resample(table, HemisphereGrid::shirley_chiu(16)), table.grid);
  EXPECT_THAT(back.values, ::testing::Pointwise(::testing::DoubleNear(1e-12), table.values));
}

TEST(ResamplingOfCells, AveragesDeltaPartsWithTheirLight) {
  const auto table = table_of("mirror*fresnel:ior=1.5", "shirley-chiu:8");
  const auto klems = resample(table, HemisphereGrid::klems(145));

  EXPECT_NEAR(row_albedos(klems).mean.front().value, row_albedos(table).mean.front().value, 1e-12);
}

TEST(DeltaPartsOnCells, HaveTheLightOfTheFormula) {
  const auto material = parse_material("mirror*fresnel:ior=1.5");
  const double expected = mean_albedo(device(), material).front().value;
  for (const auto* grid : {"klems:145", "shirley-chiu:4", "cells:3x4"}) {
    // Sixteen Gauss nodes in the angle, in which Fresnel's factor is smooth.
    EXPECT_NEAR(row_albedos(table_of("mirror*fresnel:ior=1.5", grid)).mean.front().value, expected, 1e-9) << grid;
  }
}

TEST(ResamplingToCells, KeepsTheLightOfAnInterpolatedTable) {
  const auto table = table_of("phong:n=20", "gauss:24x48");
  const auto before = row_albedos(table).mean.front();
  const auto klems = row_albedos(resample(table, HemisphereGrid::klems(41))).mean.front();

  EXPECT_NEAR(klems.value, before.value, klems.error + before.error);
  // Nearly all of it is the interpolation's own.
  EXPECT_LT(klems.error, 6e-2 * before.value);
}

}  // namespace
}  // namespace lobe::test
