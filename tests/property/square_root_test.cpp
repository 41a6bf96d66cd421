// What holds for square roots: they are those of squares, nearest ones, exact on delta parts.
#include "lobe/algebra/square_root.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/algebra/spectrum.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "metric/table_metric.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/scale.hpp"
#include "support/tables.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

BrdfTable square_of(const BrdfTable& f) {
  ComposeOptions options;
  options.estimate_error = false;
  return compose(device(), f, f, options);
}

/// |f - g| / |g| in the Hilbert-Schmidt norm.
double relative_difference(const BrdfTable& f, const BrdfTable& g) {
  const std::vector<double> weights{1, -1};
  const std::vector<BrdfTable> pair{f, g};
  const auto norm = [](const BrdfTable& table) {
    return std::sqrt(scalar_product(table, table, Lighting::point()).value);
  };
  BrdfTable difference = mix(weights, pair);
  difference.mirror.clear();
  difference.retro.clear();
  BrdfTable smooth = g;
  smooth.mirror.clear();
  smooth.retro.clear();
  return norm(difference) / norm(smooth);
}

/// Self-compositions are positive semi-definite, so they are their own squares' roots.
class RootOfSquare : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(model, RootOfSquare,
                         ::testing::Values("lambert", "phong:n=20", "metal_phong:n=30", "ward:m=0.25", "blinn:n=40",
                                           "exponential_patch:s=12", "oren_nayar:sigma=0.5"),
                         [](const auto& test) { return test_name(test.param); });

TEST_P(RootOfSquare, IsThePositiveFactorAsFarAsRoundingLets) {
  const auto f = square_of(table_of(GetParam()));

  // Values of f below 1.5e-8 |f| have squares below the last place of |f|^2.
  EXPECT_LT(relative_difference(square_root(device(), square_of(f)).table, f), 2e-8);
}

TEST_P(RootOfSquare, IsThePositiveFactorWhereNoneOfItsValuesIsLost) {
  const auto smooth = square_of(table_of(GetParam()));
  const auto f = mix(std::vector<double>{1, 1e-5}, std::vector<BrdfTable>{smooth, table_of("rrim")});

  EXPECT_LT(relative_difference(square_root(device(), square_of(f)).table, f), 1e-8);
}

TEST_P(RootOfSquare, ComposesBackToTheSquare) {
  const auto square = square_of(table_of(GetParam()));
  const auto root = square_root(device(), square);

  EXPECT_LT(relative_difference(square_of(root.table), square), 1e-13);
  EXPECT_NE(root.channels.front().definiteness, Definiteness::indefinite);
  EXPECT_LT(root.channels.front().relative_distance.value, 1e-14);
}

TEST_P(RootOfSquare, IsReciprocalToRounding) {
  const auto root = square_root(device(), square_of(table_of(GetParam()))).table;

  EXPECT_LT(relative_difference(transpose(root), root), 1e-15);
}

TEST(SquareRoot, OfADenseTableIsThatOfTheIsotropicOne) {
  const auto square = square_of(table_of("phong:n=5", "gauss:6x12"));
  const auto dense = square_root(device(), to_general(square)).table;

  EXPECT_EQ(dense.form, TableForm::general);
  EXPECT_LT(relative_difference(dense, to_general(square_root(device(), square).table)), 1e-7);
}

TEST(SquareRoot, OfTheNearestSelfCompositionIsAsFarAsTheNegativeEigenvaluesAre) {
  const auto f = table_of("phong:n=5");
  const auto root = square_root(device(), f);
  double sum = 0;
  const auto values = spectrum(device(), f).channels.front();
  for (const auto& order : values.orders) {
    for (const auto& value : order.values) {
      sum += static_cast<double>(order.multiplicity) * std::pow(std::min(value.value, 0.0), 2);
    }
  }
  const double distance = root.channels.front().distance.value;

  EXPECT_EQ(root.channels.front().definiteness, Definiteness::indefinite);
  EXPECT_NEAR(distance, std::sqrt(sum), 1e-14);
  EXPECT_NEAR(relative_difference(square_of(root.table), f), root.channels.front().relative_distance.value, 1e-12);
}

TEST(SquareRoot, OfAnIndefiniteTableIsNearerThanOtherSelfCompositions) {
  const auto f = table_of("phong:n=5");
  const auto root = square_root(device(), f).table;
  const double least = relative_difference(square_of(root), f);

  for (const std::string other : {"phong:n=4", "lambert", "blinn:n=3"}) {
    const auto near = mix(std::vector<double>{0.95, 0.05}, std::vector<BrdfTable>{root, table_of(other)});
    EXPECT_GT(relative_difference(square_of(near), f), least) << other;
  }
}

TEST(SquareRoot, OfDeltaPartsIsExact) {
  const auto root = square_root(device(), table_of("rrim:rho=0.5+mirror:rho=0.3", "gauss:6x12")).table;

  const double even = std::sqrt(0.5 + 0.3);
  const double odd = std::sqrt(0.5 - 0.3);
  EXPECT_THAT(root.retro, Each(::testing::DoubleNear((even + odd) / 2, 1e-15)));
  EXPECT_THAT(root.mirror, Each(::testing::DoubleNear((even - odd) / 2, 1e-15)));
  EXPECT_THAT(root.values, Each(::testing::DoubleNear(0, 1e-13)));
}

TEST(SquareRoot, OfTheRetroMirrorHasNoMirror) {
  const auto root = square_root(device(), table_of("rrim:rho=0.25", "gauss:6x12")).table;

  EXPECT_THAT(root.mirror, IsEmpty());
  EXPECT_THAT(root.retro, Each(0.5));
}

class RootWithDelta : public ::testing::TestWithParam<TableForm> {};
INSTANTIATE_TEST_SUITE_P(form, RootWithDelta, ::testing::Values(TableForm::isotropic, TableForm::general));

TEST_P(RootWithDelta, IsTheFactorOfASquare) {
  const auto f = table_of("phong:n=3+rrim:rho=0.9+mirror:rho=0.2", "gauss:6x12", GetParam());
  const auto root = square_root(device(), square_of(f)).table;

  EXPECT_LT(relative_difference(root, f), 1e-13);
  for (std::size_t k = 0; k < f.mirror.size(); ++k) {
    EXPECT_NEAR(root.mirror[k], 0.2, 1e-15) << k;
    EXPECT_NEAR(root.retro[k], 0.9, 1e-15) << k;
  }
}

/// The same operator with errors of its values that stay within the stated ones.
TEST(SquareRoot, OfAnOperatorOnCellsIsAsUnsureAsItsValues) {
  const auto grid = HemisphereGrid::klems(41);
  constexpr double kError = 1e-4;
  auto table = table_of("phong:n=5", grid, TableForm::general);
  table.source.clear();
  std::ranges::fill(table.error, kError);
  auto other = table;
  for (std::size_t in = 0; in < grid.nodes(); ++in) {
    for (std::size_t out = 0; out < grid.nodes(); ++out) {
      other.values[in * grid.nodes() + out] +=
          kError * std::cos(static_cast<double>(3 * in + 1) * 0.7) * std::cos(static_cast<double>(3 * out + 1) * 0.7);
    }
  }
  const BrdfTable root = square_root(device(), table).table;
  const BrdfTable changed = square_root(device(), other).table;

  double nearest = 0;
  for (std::size_t at = 0; at < root.values.size(); ++at) {
    const std::size_t pair = grid.ring_of(at / grid.nodes()) * grid.rings().size() + grid.ring_of(at % grid.nodes());
    const double off = std::abs(root.values[at] - changed.values[at]);
    EXPECT_LE(off, root.error[pair]) << at;
    nearest = std::max(nearest, off / root.error[pair]);
  }
  EXPECT_GT(nearest, 1e-3);
}

TEST(SquareRoot, OfAMirrorIsRefused) {
  try {
    (void)square_root(device(), table_of("lambert+mirror:rho=0.5+rrim:rho=0.1", "gauss:6x12"));
    FAIL() << "has a root";
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("mirror 0.5 with rrim 0.1"));
  }
}

TEST(SquareRoot, OfACompositionThatIsNotReciprocalIsThatOfItsReciprocalPart) {
  const auto product = compose(device(), table_of("phong:n=5"), table_of("ward:m=0.5"));
  const auto part = mix(std::vector<double>{0.5, 0.5}, std::vector<BrdfTable>{product, transpose(product)});

  const SquareRoot root = square_root(device(), product);

  const SquareRoot of_part = square_root(device(), part);
  EXPECT_LT(relative_difference(root.table, of_part.table), 1e-12);
  EXPECT_GT(root.channels.front().skew.value, 0);
  EXPECT_EQ(of_part.channels.front().skew.value, 0);
  // X o X is as far from the product as is said, and farther than from its reciprocal part.
  EXPECT_NEAR(relative_difference(square_of(root.table), product), root.channels.front().relative_distance.value, 1e-9);
  EXPECT_GT(root.channels.front().distance.value, of_part.channels.front().distance.value);
}

/// Tables whose formulas nobody knows: their roots' errors against those of much finer tables. The safety was chosen by
/// the first four.
TEST(SquareRoot, OfTablesWithoutFormulasHasErrorsThatHold) {
  const std::vector<std::string> texts{
      "phong:n=3", "ward:m=0.5",           "blinn:n=8", "lambert:scale=0.5+phong:n=10,scale=0.3", "ward:m=0.35",
      "phong:n=9", "oren_nayar:sigma=0.6", "blinn:n=3"};
  for (const std::string& text : swept_of(texts, 2)) {
    const BrdfTable finer = square_root(device(), table_of(text, "gauss:72x144")).table;
    for (const TableForm form : {TableForm::isotropic, TableForm::general}) {
      const std::string grid = form == TableForm::general ? "gauss:9x18" : "gauss:24x48";
      BrdfTable table = table_of(text, grid, form);
      table.source.clear();
      const BrdfTable root = square_root(device(), table).table;
      const BrdfTable exact = resample(finer, root.grid);
      const BrdfTable expected = form == TableForm::general ? to_general(exact) : exact;
      const std::size_t rings = root.grid.rings().size();
      double worst = 0;
      for (std::size_t at = 0; at < root.size(); ++at) {
        const std::size_t pair = form == TableForm::general
                                     ? root.grid.ring_of(at / root.rows()) * rings + root.grid.ring_of(at % root.rows())
                                     : at / root.grid.half_azimuths();
        const double bound = root.error[pair] + expected.error[pair];
        ASSERT_TRUE(std::isfinite(bound)) << text;
        worst = std::max(worst, std::abs(root.values[at] - expected.values[at]) / bound);
      }
      EXPECT_LE(worst, 1) << text << " on " << grid;
    }
  }
}

TEST(SquareRoot, OfLambertIsAReflectance) {
  const auto root = square_root(device(), table_of("lambert:scale=0.25"));

  constexpr double kRounding = 3e-8;  // of the zeros among the eigenvalues, in their roots
  EXPECT_NEAR(root.channels.front().least_value.value.value, 0.5 / std::acos(-1.0), kRounding);
  EXPECT_NEAR(root.channels.front().largest_albedo.value, 0.5, kRounding);
  EXPECT_EQ(root.channels.front().definiteness, Definiteness::semi_definite);
}

TEST(SquareRoot, KeepsChannelsApart) {
  Material material = parse_material("lambert");
  material.terms.front().weight = {0.25, 0.64, 0.04};
  const auto root = square_root(device(), tabulate(device(), material, HemisphereGrid::gauss(4, 8)));

  ASSERT_EQ(root.channels.size(), 3U);
  EXPECT_NEAR(root.channels[1].largest_albedo.value, 0.8, 1e-7);
  EXPECT_NEAR(root.channels[2].largest_albedo.value, 0.2, 1e-7);
}

/// Share of values whose deviation from the root on a grid four times as fine, interpolated, is above the bound.
double share_outside(const BrdfTable& coarse, const BrdfTable& fine) {
  const auto truth = resample(fine, coarse.grid);
  const std::size_t half = coarse.grid.half_azimuths();
  std::size_t outside = 0;
  for (std::size_t at = 0; at < coarse.values.size(); ++at) {
    const double deviation = std::abs(coarse.values[at] - truth.values[at]);
    if (deviation > coarse.error[at / half] + truth.error[at / half] + 1e-7) ++outside;
  }
  return static_cast<double>(outside) / static_cast<double>(coarse.values.size());
}

TEST(SquareRoot, HasErrorsThatHoldAgainstAFourTimesFinerGrid) {
  for (const std::string specification : {"phong:n=5", "metal_phong:n=4", "oren_nayar:sigma=0.5", "blinn:n=4"}) {
    const auto root = square_root(device(), table_of(specification, "gauss:8x16")).table;
    const auto fine = square_root(device(), table_of(specification, "gauss:32x64")).table;
    EXPECT_LT(share_outside(root, fine), 0.01) << specification;
  }
}

}  // namespace
}  // namespace lobe::test
