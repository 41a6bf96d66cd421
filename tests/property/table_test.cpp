// Tables: what they hold, what they refuse, and what they give between their nodes.
#include "lobe/table/table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "energy/albedo.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "lobe/table/brdf_function.hpp"
#include "metric/table_metric.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"
#include "support/materials.hpp"
#include "support/names.hpp"
#include "support/tables.hpp"
#include "table/evaluate.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

class TableOf : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(model, TableOf, ::testing::ValuesIn(sample_specifications()),
                         [](const auto& test) { return test_name(test.param); });

TEST_P(TableOf, HoldsTheValuesOfTheModelAtItsNodes) {
  const auto table = table_of(GetParam(), "gauss:9x18");
  std::vector<Directions> directions;
  for (const Ring& in : table.grid.rings()) {
    for (const Ring& out : table.grid.rings()) {
      for (std::size_t k = 0; k < table.grid.half_azimuths(); ++k) {
        directions.push_back({in.theta, out.theta, 2 * pi * static_cast<double>(k) / 18});
      }
    }
  }
  const Eigen::MatrixXd expected = evaluate(device(), parse_material(GetParam()), directions);
  for (std::size_t at = 0; at < directions.size(); ++at) {
    const double value = expected(static_cast<Eigen::Index>(at), 0);
    // Four times the stated rounding error: the other kernel rounds, too.
    ASSERT_NEAR(table.values[at], value, 4 * table.error[at / table.grid.half_azimuths()]) << at;
  }
}

TEST_P(TableOf, IsReciprocalToTheBit) {
  for (const auto* grid : {"gauss:9x18", "klems:41"}) {
    SCOPED_TRACE(grid);
    const auto table = table_of(GetParam(), grid);
    const std::size_t block = table.size() / (table.rows() * table.rows());
    for (std::size_t i = 0; i < table.rows(); ++i) {
      for (std::size_t j = 0; j < table.rows(); ++j) {
        for (std::size_t k = 0; k < block; ++k) {
          ASSERT_EQ(table.values[(i * table.rows() + j) * block + k], table.values[(j * table.rows() + i) * block + k])
              << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

struct TableAlbedoCase {
  const char* material;
  const char* grid;
  double tolerance;  ///< of the mean albedo: the convergence of the grid's rule
};

class TableAlbedoOn : public ::testing::TestWithParam<TableAlbedoCase> {};

INSTANTIATE_TEST_SUITE_P(all, TableAlbedoOn,
                         ::testing::Values(TableAlbedoCase{"phong:n=20", "gauss:32x64", 2e-10},
                                           TableAlbedoCase{"ward:m=0.3", "gauss:64x128", 1e-4},
                                           TableAlbedoCase{"phong:n=20", "uniform:64x128", 2e-4},
                                           TableAlbedoCase{"phong:n=20", "cells:32x64", 1e-4},
                                           TableAlbedoCase{"phong:n=20", "shirley-chiu:32", 1e-3},
                                           TableAlbedoCase{"phong:n=5", "klems:145", 3e-3},
                                           TableAlbedoCase{"phong:n=5", "klems:73", 1e-2}),
                         [](const auto& test) {
                           return test_name(std::string(test.param.material) + " " + test.param.grid);
                         });

TEST_P(TableAlbedoOn, MeanAgreesWithTheAdaptiveIntegral) {
  const double exact = mean_albedo(device(), parse_material(GetParam().material)).front().value;

  EXPECT_NEAR(row_albedos(table_of(GetParam().material, GetParam().grid)).mean.front().value, exact,
              GetParam().tolerance * exact);
}

TEST(TableAlbedo, IsWithinTheStatedError) {
  for (const auto* material : {"phong:n=20", "ward:m=0.2", "oren_nayar:sigma=0.5", "metal_phong:n=10", "blinn:n=20",
                               "cook_torrance:m=0.4", "exponential_patch:s=8", "basic_patch:R=0.5"}) {
    for (const auto* grid : {"gauss:32x64", "gauss:64x128", "uniform:64x128"}) {
      SCOPED_TRACE(std::string(material) + " " + grid);
      const auto table = table_of(material, grid);
      const std::vector<double> angles{0, 0.5, 1, 1.4};
      const auto exact = albedo(device(), parse_material(material), angles).front();
      const auto found = albedo(table, angles).front();
      const auto mean = row_albedos(table).mean.front();
      EXPECT_NEAR(mean.value, mean_albedo(device(), parse_material(material)).front().value, mean.error + 1e-9);
      for (std::size_t k = 0; k < angles.size(); ++k) {
        EXPECT_NEAR(found[k].value, exact[k].value, found[k].error + 1e-9) << angles[k];
      }
    }
  }
}

TEST(Table, BetweenItsNodesIsWithinTheStatedError) {
  for (const auto* material : {"phong:n=20", "ward:m=0.3", "oren_nayar:sigma=0.5", "blinn:n=50"}) {
    for (const auto* grid : {"gauss:32x64", "uniform:48x96"}) {
      const auto table = table_of(material, grid);
      std::vector<Directions> directions;
      for (double theta = 0; theta < 1.5; theta += 0.13) {
        for (double phi = 0; phi < 6.3; phi += 0.7) directions.push_back({theta, 0.4 + 0.6 * theta, phi});
      }
      const Eigen::MatrixXd exact = evaluate(device(), parse_material(material), directions);
      const auto found = evaluate(table, directions).front();
      for (std::size_t at = 0; at < directions.size(); ++at) {
        EXPECT_NEAR(found[at].value, exact(static_cast<Eigen::Index>(at), 0), 1.5 * found[at].error + 1e-13)
            << material << " " << grid << " " << directions[at].theta_in << " " << directions[at].delta_phi;
      }
    }
  }
}

TEST(Table, OfCellsStatesWhatAveragingHides) {
  const auto material = parse_material("phong:n=5");
  std::vector<Directions> directions;
  for (double theta = 0.03; theta < 1.5; theta += 0.17) {
    for (double phi = 0; phi < 6.3; phi += 0.9) directions.push_back({theta, 0.3 + 0.7 * theta, phi});
  }
  const Eigen::MatrixXd exact = evaluate(device(), material, directions);
  for (const auto* grid : {"cells:16x32", "klems:145", "shirley-chiu:16"}) {
    const auto found = evaluate(table_of("phong:n=5", grid), directions).front();
    for (std::size_t at = 0; at < directions.size(); ++at) {
      EXPECT_NEAR(found[at].value, exact(static_cast<Eigen::Index>(at), 0), found[at].error)
          << grid << " " << directions[at].theta_in << " " << directions[at].delta_phi;
    }
  }
}

TEST(Table, OfTwoRingsStillStatesItsError) {
  const Directions at{pi / 4, 1.4, pi};
  const double exact = evaluate(device(), parse_material("phong:n=1"), {&at, 1})(0, 0);
  for (const auto* grid : {"gauss:1x2", "gauss:2x4", "gauss:3x6"}) {
    const auto found = evaluate(table_of("phong:n=1", grid), {&at, 1}).front().front();
    EXPECT_NEAR(found.value, exact, found.error) << grid;
  }
}

TEST(Table, InGeneralFormGivesTheSameBetweenItsNodes) {
  const auto table = table_of("phong:n=10", "gauss:16x32");
  const std::vector<Directions> directions{{0.3, 0.7, 2.9}, {1.1, 0.05, 0.3}, {0.02, 1.3, 5}};
  const auto isotropic = evaluate(table, directions).front();
  const auto general = evaluate(to_general(table), directions).front();

  for (std::size_t at = 0; at < directions.size(); ++at) {
    EXPECT_NEAR(isotropic[at].value, general[at].value, 1e-13) << at;
  }
}

TEST(Resampling, KeepsValuesWithinTheStatedError) {
  const auto table = table_of("phong:n=10", "gauss:32x64");
  for (const auto* grid : {"gauss:24x48", "uniform:16x40"}) {
    SCOPED_TRACE(grid);
    const auto moved = resample(table, HemisphereGrid::parse(grid));
    const auto exact = table_of("phong:n=10", grid);
    const std::size_t half = moved.grid.half_azimuths();
    for (std::size_t at = 0; at < moved.values.size(); ++at) {
      ASSERT_NEAR(moved.values[at], exact.values[at], moved.error[at / half] + 1e-13) << grid << " " << at;
    }
    EXPECT_THAT(moved.expression, HasSubstr("resample"));
  }
}

TEST(Resampling, ToCellsAverages) {
  const auto moved = resample(table_of("phong:n=5", "gauss:32x64"), HemisphereGrid::klems(145));
  const auto exact = table_of("phong:n=5", "klems:145");

  EXPECT_NEAR(row_albedos(moved).mean.front().value, row_albedos(exact).mean.front().value, 2e-3);
}

TEST(Resampling, ToAGridThatIsTooCoarseIsMarked) {
  EXPECT_TRUE(resample(table_of("phong:n=200", "gauss:64x128"), HemisphereGrid::gauss(6, 12)).is_unresolved);
}

TEST(Resampling, ToItsOwnGridChangesNothing) {
  const auto table = table_of("phong:n=5", "gauss:8x16");

  EXPECT_EQ(resample(table, HemisphereGrid::gauss(8, 16)).values, table.values);
}

TEST(Resolution, OfASharpLobeIsRefusedByNameWithTheGridItNeeds) {
  try {
    (void)tabulate(device(), parse_material("lambert:scale=0.5+ward:m=0.05"), HemisphereGrid::gauss(16, 32));
    FAIL() << "no exception";
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ward(m=0.05)"));
    EXPECT_THAT(error.what(), HasSubstr("it needs gauss:64x128"));
  }
}

TEST(Resolution, OfAVerySharpLobeIsRefusedOnEveryKindOfGrid) {
  for (const auto* grid : {"gauss:32x64", "uniform:32x64", "cells:16x32", "klems:145", "shirley-chiu:8"}) {
    for (const auto* material : {"ward:m=0.005", "phong:n=1e6"}) {
      EXPECT_THROW((void)tabulate(device(), parse_material(material), HemisphereGrid::parse(grid)), NumericError)
          << material << " " << grid;
    }
  }
}

TEST(Resolution, IsToldUpTo512Rings) {
  try {
    (void)tabulate(device(), parse_material("phong:n=60000"), HemisphereGrid::gauss(16, 32));
    FAIL();
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("it needs gauss:512x1024"));
  }
}

TEST(Resolution, AllowedToBeMissingMarksTheTable) {
  EXPECT_TRUE(table_of("ward:m=0.05", "gauss:16x32").is_unresolved);
  EXPECT_FALSE(table_of("ward:m=0.3", "gauss:32x64").is_unresolved);
}

TEST(Resolution, ByToleranceChoosesAGridThatHasIt) {
  const std::vector<Material> materials{parse_material("ward:m=0.2"), parse_material("phong:n=50")};
  TabulateOptions options;
  options.tolerance = 1e-2;
  const auto grid = choose_grid(device(), materials, options);

  EXPECT_LE(grid.n_theta(), 64U);
  for (const auto& material : materials)
    EXPECT_NO_THROW((void)tabulate(device(), material, grid, options)) << material.name;
}

TEST(Channels, AreTabulatedApart) {
  Material rgb = parse_material("phong:n=5+lambert");
  rgb.terms[0].weight = {1, 0.5, 0};
  rgb.terms[1].weight = {0, 0.5, 1};
  const auto table = tabulate(device(), rgb, HemisphereGrid::gauss(8, 16));
  const auto phong = table_of("phong:n=5", "gauss:8x16");

  ASSERT_EQ(table.channels, 3U);
  for (std::size_t at = 0; at < table.size(); ++at) {
    EXPECT_EQ(table.channel(0)[at], phong.values[at]) << at;
    EXPECT_NEAR(table.channel(1)[at], 0.5 * (phong.values[at] + 1 / pi), 1e-15) << at;
    EXPECT_EQ(table.channel(2)[at], 1 / pi) << at;
  }
}

TEST(TableMetric, AgreesWithTheAdaptiveOne) {
  const auto f = parse_material("phong:n=10");
  const auto g = parse_material("oren_nayar:sigma=0.5");
  const auto grid = HemisphereGrid::gauss(48, 96);
  for (const auto& lighting : {Lighting::point(), Lighting::daylight()}) {
    SCOPED_TRACE(lighting.name());
    const auto product = scalar_product(tabulate(device(), f, grid), tabulate(device(), g, grid), lighting);
    const auto gap = distance(tabulate(device(), f, grid), tabulate(device(), g, grid), lighting);
    EXPECT_NEAR(product.value, scalar_product(device(), f, g, lighting).value, product.error);
    EXPECT_NEAR(gap.value, distance(device(), f, g, lighting).value, gap.error);
    EXPECT_LT(product.error, 1e-2 * product.value);
  }
}

TEST(TableMetric, OfOperatorsThatAreNotReciprocalIsConsistent) {
  ComposeOptions options;
  options.estimate_error = false;
  const auto f =
      compose(device(), table_of("phong:n=2", "gauss:16x32"), table_of("phong:n=20", "gauss:16x32"), options);
  const auto g = transpose(f);
  for (const auto& lighting : {Lighting::point(), Lighting::daylight()}) {
    SCOPED_TRACE(lighting.name());
    const double square = scalar_product(f, f, lighting).value + scalar_product(g, g, lighting).value -
                          2 * scalar_product(f, g, lighting).value;
    EXPECT_NEAR(std::pow(distance(f, g, lighting).value, 2), square, 1e-13);
  }
}

TEST(TableMetric, OfMirrorsIsFiniteWhereItIs) {
  const auto grid = HemisphereGrid::gauss(32, 64);
  const auto mirror = tabulate(device(), parse_material("mirror:rho=0.5"), grid);
  const auto phong = tabulate(device(), parse_material("phong:n=10"), grid);

  // Phong has the same value c in all mirror directions: rho c integral dmu = rho c pi.
  EXPECT_NEAR(scalar_product(mirror, phong, Lighting::point()).value, 0.5 * 12 / (2 * pi) * pi, 1e-12);
  EXPECT_NEAR(scalar_product(mirror, mirror, Lighting::daylight()).value, 0.25 * pi, 1e-12);
  EXPECT_THROW((void)scalar_product(mirror, mirror, Lighting::point()), NumericError);
  EXPECT_EQ(distance(mirror, mirror, Lighting::point()).value, 0);
}

TEST(Table, MadeByHandIsChecked) {
  auto table = table_of("lambert", "gauss:4x8");
  table.error.pop_back();

  EXPECT_THROW((void)row_albedos(table), ArgumentError);
}

/// The grid that a refusal names.
std::string grid_needed(const BrdfFunction& brdf, const HemisphereGrid& grid) {
  try {
    (void)tabulate(brdf, grid);
  } catch (const NumericError& error) {
    const std::string text = error.what();
    const std::string words = "it needs ";
    return text.substr(text.find(words) + words.size());
  }
  return "";
}

TEST(FunctionTable, RefusalNamesAGridThatWouldDo) {
  const auto brdf = as_function(device(), parse_material("ward:m=0.2"));

  const std::string needed = grid_needed(brdf, HemisphereGrid::gauss(4, 8));

  ASSERT_NE(needed, "");
  EXPECT_LE(tabulate(brdf, HemisphereGrid::parse(needed)).resolution_error, 0.1);
}

TEST(FunctionTable, RefusalSaysWhereNoGridOfThoseTriedWouldDo) {
  BrdfFunction brdf;
  brdf.name = "noise";
  brdf.channels = {"value"};
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      // A peak that no grid has a chance to meet twice.
      const double off = std::hypot(pairs[k].theta_out - 0.3, std::remainder(pairs[k].delta_phi, 2 * pi)) * 1e4;
      values.value(static_cast<Eigen::Index>(k), 0) = 1 / (1 + off * off);
    }
    return values;
  };

  EXPECT_EQ(grid_needed(brdf, HemisphereGrid::gauss(64, 128)), "more than gauss:256x512");
}

TEST(ResolvingGrid, IsTheUsualOneAsLongAsThatResolves) {
  EXPECT_EQ(resolving_grid(device(), {parse_material("phong:n=20")}), HemisphereGrid::gauss(64, 128));
  EXPECT_EQ(resolving_grid(device(), {parse_material("mirror")}), HemisphereGrid::gauss(64, 128));
}

TEST(ResolvingGrid, IsTheCoarsestThatResolvesAll) {
  const Material sharp = parse_material("ward:m=0.03");
  const auto grid = resolving_grid(device(), {parse_material("lambert"), sharp});
  EXPECT_EQ(grid, HemisphereGrid::gauss(96, 192));
  EXPECT_FALSE(tabulate(device(), Reflectance(sharp), grid).is_unresolved);
  EXPECT_THROW((void)tabulate(device(), Reflectance(sharp), HemisphereGrid::gauss(64, 128)), UnresolvedError);
  EXPECT_EQ(resolution_needed(device(), sharp, HemisphereGrid::gauss(24, 48)), "gauss:96x192");
}

TEST(ResolvingGrid, IsThatOfATable) {
  const Reflectance table = table_of("phong:n=3", "gauss:8x16");
  EXPECT_EQ(resolving_grid(device(), {parse_material("ward:m=0.03"), table}), HemisphereGrid::gauss(8, 16));
  EXPECT_EQ(resolution_needed(device(), table, HemisphereGrid::gauss(8, 16)), "");
}

TEST(ResolvingGrid, IsTheFinestAllowedWhereNoneResolves) {
  const Reflectance sharp = parse_material("ward:m=0.001");
  EXPECT_EQ(resolving_grid(device(), {sharp}, TableUse::decomposition), HemisphereGrid::gauss(256, 512));
  const Reflectance anisotropic = parse_material("ward_anisotropic:m_x=0.05,m_y=0.3");
  EXPECT_EQ(resolving_grid(device(), {anisotropic}, TableUse::decomposition), HemisphereGrid::gauss(24, 48));
}

}  // namespace
}  // namespace lobe::test
