// What holds for operators: compositions, delta parts, linear combinations, adjoints.
#include "lobe/algebra/algebra.hpp"
#include "table/tabulate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "support/device.hpp"
#include "support/estimates.hpp"
#include "support/names.hpp"
#include "support/tables.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

/// Compositions of tables that were not estimated for errors: these tests are about values.
BrdfTable product(const BrdfTable& f, const BrdfTable& g) {
  ComposeOptions options;
  options.estimate_error = false;
  return compose(device(), f, g, options);
}

double largest(const TableValues& values) {
  double size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

/// Largest difference relative to the largest value.
double difference(const BrdfTable& a, const BrdfTable& b) {
  EXPECT_EQ(a.values.size(), b.values.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) worst = std::max(worst, std::abs(a.values[i] - b.values[i]));
  return worst / largest(a.values);
}

class Operator : public ::testing::TestWithParam<std::string> {
 protected:
  BrdfTable f = table_of("ward:m=0.3", GetParam());
  BrdfTable g = table_of("metal_phong:n=10", GetParam());
  BrdfTable h = table_of("oren_nayar:sigma=0.5", GetParam());
};

INSTANTIATE_TEST_SUITE_P(on, Operator,
                         ::testing::Values("gauss:16x32", "gauss:13x26", "uniform:12x24", "cells:12x24",
                                           "shirley-chiu:8", "klems:145"),
                         [](const auto& test) { return test_name(test.param); });

TEST_P(Operator, ComposedWithTheRetroMirrorStaysTheSameToTheBit) {
  EXPECT_EQ(product(f, table_of("rrim", GetParam())).values, f.values);
  EXPECT_EQ(product(table_of("rrim", GetParam()), f).values, f.values);
}

TEST_P(Operator, ComposedWithTheMirrorIsReflectedToTheBit) {
  const auto mirror = table_of("mirror", GetParam());
  const auto reflected = product(f, mirror);

  EXPECT_EQ(product(reflected, mirror).values, f.values);
  for (std::size_t row = 0; row < f.rows(); ++row) {
    for (std::size_t j = 0; j < f.size() / f.rows(); ++j) {
      const std::size_t half = f.form == TableForm::isotropic ? f.grid.half_azimuths() : 0;
      const std::size_t back = half > 0 ? j / half * half + half - 1 - j % half : f.grid.opposite(j);
      ASSERT_EQ(reflected.values[row * (f.size() / f.rows()) + j], f.values[row * (f.size() / f.rows()) + back])
          << row << ' ' << j;
    }
  }
}

TEST_P(Operator, IsSemiSymmetricToTheBit) {
  EXPECT_EQ(product(f, g).values, transpose(product(g, f)).values);
}

TEST_P(Operator, IsSymmetricWhenComposedWithItself) {
  const auto square = product(f, f);

  EXPECT_EQ(square.values, transpose(square).values);
}

TEST_P(Operator, ComposesAssociatively) {
  EXPECT_LT(difference(product(product(f, g), h), product(f, product(g, h))), 1e-12);
}

TEST_P(Operator, ComposedWithTheDiffuseConstantGivesItsAlbedoOverPi) {
  const auto c = product(f, table_of("lambert", GetParam()));
  const auto albedos = row_albedos(f).in.front();

  for (std::size_t row = 0; row < c.rows(); ++row) {
    for (std::size_t j = 0; j < c.size() / c.rows(); ++j) {
      ASSERT_NEAR(c.values[row * (c.size() / c.rows()) + j], albedos[row].value / pi, 1e-12 * albedos[row].value)
          << row << ' ' << j;
    }
  }
}

TEST_P(Operator, DistributesOverMixtures) {
  const std::vector<BrdfTable> tables{g, h};
  const std::vector<double> weights{0.25, -2};
  const std::vector<BrdfTable> products{product(f, g), product(f, h)};

  EXPECT_LT(difference(product(f, mix(weights, tables)), mix(weights, products)), 1e-13);
}

TEST_P(Operator, HasInAndOutAlbedosThatSwapWithTheFactors) {
  const auto fg = row_albedos(product(f, g));
  const auto gf = row_albedos(product(g, f));

  for (std::size_t row = 0; row < f.rows(); ++row) {
    EXPECT_NEAR(fg.in[0][row].value, gf.out[0][row].value, 1e-13 * fg.in[0][row].value) << row;
  }
  EXPECT_NEAR(fg.mean[0].value, gf.mean[0].value, 1e-13);
}

TEST_P(Operator, KeepsTheAlbedoWithinTheBoundsOfItsFactors) {
  const auto c = row_albedos(product(f, g));
  const auto f_albedo = row_albedos(f).in.front();
  const auto g_albedo = row_albedos(g).in.front();
  const auto value = [](const Estimate& a, const Estimate& b) { return a.value < b.value; };
  const auto [low, high] = std::ranges::minmax(g_albedo, value);

  for (std::size_t row = 0; row < f.rows(); ++row) {
    EXPECT_GE(c.in[0][row].value, f_albedo[row].value * low.value * (1 - 1e-13)) << row;
    EXPECT_LE(c.in[0][row].value, f_albedo[row].value * high.value * (1 + 1e-13)) << row;
  }
}

class ProductGrid : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(on, ProductGrid, ::testing::Values("gauss:16x32", "gauss:7x14", "uniform:9x20", "cells:8x16"),
                         [](const auto& test) { return test_name(test.param); });

TEST_P(ProductGrid, IsotropicAndDenseCompositionsAgree) {
  const auto f = table_of("ward:m=0.3", GetParam());
  const auto g = table_of("metal_phong:n=10", GetParam());
  const auto mixed = table_of("phong:n=5,scale=0.7+mirror:rho=0.2+rrim:rho=0.1", GetParam());

  EXPECT_LT(difference(to_general(product(f, g)), product(to_general(f), to_general(g))), 1e-12);
  EXPECT_LT(difference(to_general(product(f, mixed)), product(to_general(f), mixed)), 1e-12);
  const auto isotropic = product(mixed, mixed);
  const auto dense = product(to_general(mixed), mixed);
  EXPECT_LT(difference(to_general(isotropic), dense), 1e-12);
  EXPECT_EQ(to_general(isotropic).mirror, dense.mirror);
  EXPECT_EQ(to_general(isotropic).retro, dense.retro);
}

TEST(Delta, MirrorsComposeLikeReflections) {
  const auto mirror = table_of("mirror:rho=0.5");
  const auto retro = table_of("rrim:rho=0.25");
  const auto both = product(mirror, mirror);

  EXPECT_TRUE(both.mirror.empty());
  EXPECT_THAT(both.retro, ::testing::Each(0.25));
  EXPECT_THAT(product(mirror, retro).mirror, ::testing::Each(0.125));
  EXPECT_THAT(product(retro, mirror).mirror, ::testing::Each(0.125));
  EXPECT_THAT(product(retro, retro).retro, ::testing::Each(0.0625));
  EXPECT_THAT(both.values, ::testing::Each(0.0));
}

TEST(Delta, PartsThatVaryWithDirectionComposeInOrder) {
  auto f = table_of("mirror", "gauss:3x4", TableForm::general);
  auto g = f;
  for (std::size_t node = 0; node < f.rows(); ++node) {
    f.mirror[node] = 1 + static_cast<double>(node);
    g.mirror[node] = 100 + static_cast<double>(node);
  }
  const auto c = product(f, g);

  for (std::size_t node = 0; node < c.rows(); ++node) {
    EXPECT_EQ(c.retro[node], f.mirror[node] * g.mirror[c.grid.opposite(node)]) << node;
  }
}

TEST(Delta, OfAMaterialCountsInItsAlbedo) {
  const auto table = table_of("lambert:scale=0.5+mirror:rho=0.25");

  const auto albedos = row_albedos(table);
  EXPECT_THAT(albedos.in.front(), ::testing::Each(EstimateNear(0.75, 1e-14)));
  EXPECT_NEAR(row_albedos(product(table, table)).mean.front().value, 0.75 * 0.75, 1e-14);
}

TEST(Bounds, HoldForCompositionsAndAreNotClaimedForNegativeValues) {
  const auto f = table_of("ward:m=0.3");
  const auto c = product(f, table_of("phong:n=5"));
  const auto checks = check_bounds(c, row_albedos(c));
  ASSERT_EQ(checks.size(), 3U);
  for (const auto& check : checks) EXPECT_FALSE(check.is_violated()) << check.name;

  auto broken = c;
  for (double& value : broken.values) value *= 3;
  broken.error.assign(broken.error.size(), 0);
  const auto violated = check_bounds(broken, row_albedos(broken));
  EXPECT_TRUE(std::ranges::any_of(violated, &BoundCheck::is_violated));

  const auto negative = product(f, scale(f, -1));
  EXPECT_TRUE(check_bounds(negative, row_albedos(negative)).empty());
  EXPECT_TRUE(check_bounds(scale(c, -1), row_albedos(c)).empty());
}

TEST(Transposition, TurnsACompositionAround) {
  const auto f = table_of("ward:m=0.3+mirror:rho=0.5", "gauss:6x12", TableForm::general);
  auto g = table_of("metal_phong:n=10+mirror:rho=0.25", "gauss:6x12", TableForm::general);
  for (std::size_t node = 0; node < g.rows(); ++node) g.mirror[node] += static_cast<double>(node);
  const auto left = transpose(product(f, g));
  const auto right = product(transpose(g), transpose(f));

  EXPECT_LT(difference(left, right), 1e-14);
  EXPECT_EQ(left.retro, right.retro);
}

TEST(SelfComposition, TwiceIsTheThirdPower) {
  const auto f = table_of("phong:n=10");

  EXPECT_EQ(self_compose(device(), f, 2).values, compose(device(), compose(device(), f, f), f).values);
}

TEST(Composition, RefusesGridsThatDifferWhenAskedTo) {
  ComposeOptions options;
  options.exact_grid = true;
  try {
    (void)compose(device(), table_of("lambert", "gauss:8x16"), table_of("lambert", "gauss:16x32"), options);
    FAIL() << "no exception";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gauss:16x32"));
  }
}

TEST(Composition, BringsTheSecondOperandToTheGridOfTheFirst) {
  const auto f = table_of("phong:n=5", "gauss:16x32");
  const auto c = compose(device(), f, table_of("blinn:n=5", "gauss:24x48"));

  EXPECT_EQ(c.grid, f.grid);
  EXPECT_EQ(c.values, compose(device(), f, table_of("blinn:n=5", "gauss:16x32")).values);
}

TEST(Composition, KeepsAveragesOverCellsWhereItInterpolatesThem) {
  const auto nodes = table_of("lambert", "gauss:8x16", TableForm::general);
  const auto cells = table_of("phong:n=5", "klems:73", TableForm::general);
  const auto c = compose(device(), nodes, cells);

  EXPECT_EQ(c.grid, nodes.grid);
  EXPECT_EQ(c.values, compose(device(), nodes, resample(cells, nodes.grid)).values);
}

TEST(Composition, InterpolatesWhatHasNoFormulaOrGoesToCells) {
  const auto product = table_of("blinn:n=5", "gauss:24x48");
  const auto composed = compose(device(), product, product);  // known by two formulas, by none of its own
  const auto nodes = table_of("phong:n=5", "gauss:16x32");
  const auto cells = table_of("phong:n=5", "klems:41", TableForm::general);

  EXPECT_EQ(compose(device(), nodes, composed).values, compose(device(), nodes, resample(composed, nodes.grid)).values);
  EXPECT_EQ(compose(device(), cells, product).values, compose(device(), cells, resample(product, cells.grid)).values);
}

TEST(Composition, OfOneChannelWithThreeHasThree) {
  Material rgb = parse_material("phong:n=5");
  rgb.terms.front().weight = {0.2, 0.5, 1};
  const auto grid = HemisphereGrid::gauss(8, 16);
  const auto f = tabulate(device(), rgb, grid);
  const auto g = tabulate(device(), parse_material("lambert"), grid);
  const auto c = compose(device(), g, f);

  ASSERT_EQ(c.channels, 3U);
  for (std::size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(c.channel(0)[i] * 5, c.channel(2)[i], 1e-15) << i;
}

TEST(Composition, StopsWhenAskedTo) {
  ComposeOptions options;
  options.progress = [](std::string_view, double) { return false; };

  EXPECT_THROW((void)compose(device(), table_of("lambert"), table_of("lambert"), options), Cancelled);
}

TEST(Composition, InSinglePrecisionIsCloseToDouble) {
  const auto f = table_of("ward:m=0.3");
  const auto g = table_of("metal_phong:n=10");
  ComposeOptions options;
  options.precision = Precision::single_precision;

  EXPECT_LT(difference(product(f, g), compose(device(), f, g, options)), 1e-5);
  EXPECT_LT(difference(product(to_general(f), to_general(g)), compose(device(), to_general(f), g, options)), 1e-5);
}

TEST(Mixture, OfFormulasIsAFormula) {
  const std::vector<BrdfTable> tables{table_of("phong:n=5"), table_of("lambert")};
  const std::vector<double> weights{0.5, 0.25};
  const auto mixed = mix(weights, tables);

  ASSERT_EQ(mixed.source.size(), 1U);
  EXPECT_LT(difference(mixed, tabulate(device(), mixed.source.front(), mixed.grid)), 1e-15);
}

TEST(Scale, ActsOnEverything) {
  const auto table = table_of("phong:n=5+mirror:rho=0.5");
  const auto doubled = scale(table, -2);

  EXPECT_EQ(doubled.values[17], -2 * table.values[17]);
  EXPECT_EQ(doubled.mirror[3], -1);
  EXPECT_EQ(doubled.error[5], 2 * table.error[5]);
  ASSERT_EQ(doubled.source.size(), 1U);
  EXPECT_EQ(doubled.source.front().terms.front().weight.front(), -2);
}

}  // namespace
}  // namespace lobe::test
