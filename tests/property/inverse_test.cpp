// What holds for regularised inverses: what F lets through comes back, noise does not grow without bound.
#include "lobe/algebra/inverse.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "support/device.hpp"
#include "support/tables.hpp"

namespace lobe::test {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

const std::string kGrid = "gauss:12x24";

BrdfTable product_of(const BrdfTable& f, const BrdfTable& g) {
  ComposeOptions options;
  options.estimate_error = false;
  BrdfTable c = compose(device(), f, g, options);
  std::ranges::fill(c.error, 0);  // exact as a product of discrete operators
  return c;
}

/// Largest difference relative to the largest value.
double largest_difference(const BrdfTable& a, const BrdfTable& b) {
  double worst = 0;
  double size = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    worst = std::max(worst, std::abs(a.values[i] - b.values[i]));
    size = std::max(size, std::abs(b.values[i]));
  }
  return worst / size;
}

class WellConditioned : public ::testing::TestWithParam<TableForm> {};
INSTANTIATE_TEST_SUITE_P(form, WellConditioned, ::testing::Values(TableForm::isotropic, TableForm::general));

TEST_P(WellConditioned, FactorIsUndoneToRounding) {
  const auto f = table_of("phong:n=5,scale=0.5+rrim:rho=0.9+mirror:rho=0.1", "gauss:6x12", GetParam());
  const auto x = table_of("ward:m=0.4", "gauss:6x12", GetParam());

  const auto solution = solve(f, product_of(f, x));

  EXPECT_EQ(solution.channels.front().regularisation, Regularisation::none);
  EXPECT_LT(largest_difference(solution.table, x), 1e-13);
  EXPECT_LT(solution.channels.front().relative_discrepancy, 1e-14);
  EXPECT_LT(solution.channels.front().condition, 10);
}

TEST_P(WellConditioned, FactorIsUndoneOnDeltaParts) {
  const auto f = table_of("phong:n=5,scale=0.5+rrim:rho=0.9+mirror:rho=0.1", "gauss:6x12", GetParam());
  const auto x = table_of("ward:m=0.4+rrim:rho=0.2+mirror:rho=0.7", "gauss:6x12", GetParam());

  const auto solution = solve(f, product_of(f, x)).table;

  EXPECT_THAT(solution.retro, Each(::testing::DoubleNear(0.2, 1e-14)));
  EXPECT_THAT(solution.mirror, Each(::testing::DoubleNear(0.7, 1e-14)));
  EXPECT_LT(largest_difference(solution, x), 1e-12);
}

TEST(Solve, WithTheMirrorReflects) {
  const auto mirror = table_of("mirror", kGrid);
  const auto g = table_of("phong:n=5", kGrid);

  EXPECT_LT(largest_difference(solve(mirror, g).table, product_of(mirror, g)), 1e-13);
}

TEST(Solve, RecoversWhatTheFactorLetsThrough) {
  const auto f = table_of("phong:n=8", kGrid);
  const auto x = table_of("blinn:n=4", kGrid);
  SolveOptions options;
  options.lambda = 1e-7;
  const auto solution = solve(f, product_of(f, x), options);

  // Another composition with F takes off what cannot be known.
  EXPECT_LT(largest_difference(product_of(f, solution.table), product_of(f, x)), 1e-6);
  EXPECT_LT(solution.channels.front().relative_discrepancy, 1e-6);
}

TEST(Solve, OfLambertRecoversTheAlbedoOnly) {
  const auto lambert = table_of("lambert", kGrid);
  const auto x = table_of("metal_phong:n=4", kGrid);
  const auto solution = solve(lambert, product_of(lambert, x));

  EXPECT_EQ(solution.channels.front().kept, 1U);
  EXPECT_LT(largest_difference(product_of(lambert, solution.table), product_of(lambert, x)), 1e-12);
  // It is the X of least norm: the same for all L, a(V)/pi.
  EXPECT_LT(largest_difference(solution.table, product_of(lambert, x)), 1e-12);
}

/// A table with independent errors of a known size.
BrdfTable with_noise(BrdfTable table, double size, bool is_stated) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, size);
  for (double& value : table.values) value += normal(random);
  std::ranges::fill(table.error, is_stated ? size : std::numeric_limits<double>::quiet_NaN());
  return table;
}

TEST(Solve, LeavesAsMuchDiscrepancyAsTheErrorsAllow) {
  const auto f = table_of("phong:n=8", kGrid);
  const auto x = table_of("blinn:n=4", kGrid);
  const auto solution = solve(f, with_noise(product_of(f, x), 1e-4, true));
  const auto& found = solution.channels.front();

  EXPECT_EQ(found.regularisation, Regularisation::discrepancy);
  EXPECT_NEAR(found.discrepancy, found.expected_discrepancy, 1e-6 * found.expected_discrepancy);
  EXPECT_GT(found.lambda, 0);
  EXPECT_LE(found.amplification, 1 / (2 * found.lambda) * (1 + 1e-12));
}

TEST(Solve, ChoosesLambdaByCrossValidationWhereErrorsAreUnknown) {
  const auto f = table_of("phong:n=8", kGrid);
  const auto x = table_of("blinn:n=4", kGrid);
  const auto exact = product_of(f, x);
  const auto solution = solve(f, with_noise(exact, 1e-4, false));
  const auto& found = solution.channels.front();

  EXPECT_EQ(found.regularisation, Regularisation::cross_validation);
  // The noise has the norm 1e-4 pi; a fit that followed it would leave much less.
  EXPECT_GT(found.discrepancy, 0.3e-4 * std::acos(-1.0));
  EXPECT_LT(found.discrepancy, 3e-4 * std::acos(-1.0));
}

class StatedErrorOfX : public ::testing::TestWithParam<TableForm> {};
INSTANTIATE_TEST_SUITE_P(form, StatedErrorOfX, ::testing::Values(TableForm::isotropic, TableForm::general));

/// F and G within their errors, for the same lambda.
TEST_P(StatedErrorOfX, IsWhatErrorsOfFAndGMakeOfIt) {
  const auto f = table_of("phong:n=3+rrim:rho=0.3", "gauss:8x16", GetParam());
  const auto g = product_of(f, table_of("blinn:n=4", "gauss:8x16", GetParam()));
  constexpr double kNoise = 1e-6;
  const auto stated = [](BrdfTable table) {
    std::ranges::fill(table.error, 5 * kNoise);  // few values of a normal distribution are farther off
    table.even_error.clear();
    table.odd_part.clear();
    return table;
  };
  SolveOptions options;
  options.lambda = 0.01;
  const BrdfTable x = solve(stated(f), stated(g), options).table;
  const BrdfTable other = solve(with_noise(f, kNoise, true), with_noise(g, kNoise, true), options).table;

  const HemisphereGrid& grid = x.grid;
  const std::size_t rings = grid.n_theta();
  const bool is_isotropic = x.form == TableForm::isotropic;
  double nearest = 0;
  for (std::size_t at = 0; at < x.values.size(); ++at) {
    const std::size_t pair = is_isotropic ? at / grid.half_azimuths()
                                          : grid.ring_of(at / grid.nodes()) * rings + grid.ring_of(at % grid.nodes());
    const double off = std::abs(x.values[at] - other.values[at]);
    EXPECT_LE(off, x.error[pair]) << at;
    nearest = std::max(nearest, off / x.error[pair]);
  }
  // A bound for the worst of all errors, of which random ones make a share.
  EXPECT_GT(nearest, 1e-4);
}

TEST(Solve, StatesThatXIsUnsureWhereFIsNearlySingular) {
  const auto f = table_of("phong:n=8", kGrid);
  const auto g = with_noise(product_of(f, table_of("blinn:n=4", kGrid)), 1e-4, true);
  SolveOptions options;
  options.lambda = 1e-9;

  EXPECT_GT(relative_error(solve(f, g, options).table), 1);
}

TEST(Solve, RegularisesMoreWithMoreNoise) {
  const auto f = table_of("phong:n=8", kGrid);
  const auto g = product_of(f, table_of("blinn:n=4", kGrid));
  double last = 0;
  for (const double noise : {1e-6, 1e-5, 1e-4, 1e-3}) {
    SCOPED_TRACE(noise);
    const double lambda = solve(f, with_noise(g, noise, true)).channels.front().lambda;
    EXPECT_GT(lambda, last);
    last = lambda;
  }
}

TEST(Solve, RefusesDeltaPartsThatNothingMakes) {
  const auto g = table_of("lambert+mirror:rho=0.5", kGrid);
  try {
    (void)solve(table_of("phong:n=5", kGrid), g);
    FAIL() << "was solved";
  } catch (const NumericError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no X makes them"));
  }
  EXPECT_THROW((void)solve(table_of("rrim:rho=0.5+mirror:rho=0.5", kGrid), g), NumericError);
}

TEST(Solve, RefusesNegativeLambdaAndZeros) {
  SolveOptions options;
  options.lambda = -1;
  EXPECT_THROW((void)solve(table_of("lambert", kGrid), table_of("lambert", kGrid), options), ArgumentError);
  EXPECT_THROW((void)solve(table_of("lambert:scale=0", kGrid), table_of("lambert", kGrid)), NumericError);
  EXPECT_THROW((void)solve(table_of("lambert", kGrid), table_of("lambert:scale=0", kGrid)), NumericError);
}

}  // namespace
}  // namespace lobe::test
