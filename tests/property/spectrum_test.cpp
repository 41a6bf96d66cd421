// What holds for spectra: those known in closed form, sum rules, the two forms of tables, error estimates.
#include "lobe/algebra/spectrum.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"
#include "support/device.hpp"
#include "support/names.hpp"
#include "support/tables.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ChannelSpectrum spectrum_of(const BrdfTable& table) {
  return spectrum(device(), table).channels.front();
}

/// Without a comparison, which takes longer: its errors do not matter.
ChannelSpectrum truth_of(const BrdfTable& table) {
  SpectrumOptions options;
  options.refine = false;
  return spectrum(device(), table, options).channels.front();
}

/// All values as often as they occur, falling.
std::vector<double> all_values(const ChannelSpectrum& spectrum) {
  std::vector<double> values;
  for (const auto& order : spectrum.orders) {
    for (const auto& value : order.values) values.insert(values.end(), order.multiplicity, value.value);
  }
  std::ranges::sort(values, std::greater());
  return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) worst = std::max(worst, std::abs(a[k] - b[k]));
  return worst;
}

TEST(Spectrum, OfLambertIsItsAlbedoOnceAndZero) {
  const auto lambert = spectrum_of(table_of("lambert:scale=0.7"));

  EXPECT_NEAR(lambert.norm.value, 0.7, 1e-14);
  auto values = all_values(lambert);
  EXPECT_NEAR(values.front(), 0.7, 1e-14);
  EXPECT_THAT(std::span(values).subspan(1), ::testing::Each(::testing::DoubleNear(0, 1e-15)));
  EXPECT_NEAR(lambert.effective_rank, 1, 1e-12);
  EXPECT_NEAR(lambert.participation_ratio, 1, 1e-12);
  EXPECT_EQ(lambert.numerical_rank, 1);
  EXPECT_EQ(lambert.decay.back().components, 1);
}

TEST(Spectrum, OfTheMirrorAlternatesWithTheOrder) {
  const auto mirror = spectrum_of(table_of("mirror:rho=0.8", "gauss:6x12"));

  for (const auto& order : mirror.orders) {
    for (const auto& value : order.values) EXPECT_EQ(value.value, order.order % 2 == 0 ? 0.8 : -0.8) << order.order;
  }
  EXPECT_LT(mirror.norm.error, 1e-14);
  EXPECT_EQ(mirror.effective_rank, kInfinity);
  EXPECT_EQ(mirror.numerical_rank, kInfinity);
}

TEST(Spectrum, OfTheRetroMirrorIsOne) {
  const auto rrim = spectrum_of(table_of("rrim", "gauss:6x12"));

  EXPECT_THAT(all_values(rrim), ::testing::Each(1.0));
  EXPECT_EQ(rrim.white_share, 1);
  EXPECT_EQ(rrim.decay.front().components, kInfinity);
}

TEST(Spectrum, IsShiftedByTheRetroMirror) {
  const auto plain = all_values(spectrum_of(table_of("phong:n=5")));
  auto shifted = all_values(spectrum_of(table_of("phong:n=5+rrim:rho=0.25")));
  for (double& value : shifted) value -= 0.25;

  EXPECT_LT(largest_difference(shifted, plain), 1e-14);
}

TEST(Spectrum, WithTheRetroMirrorHasErrorsOfItsSmoothPart) {
  const auto shifted = spectrum_of(table_of("phong:n=5+rrim:rho=0.25+mirror:rho=0.1"));

  EXPECT_LT(shifted.norm.error, 1e-4);
  EXPECT_LT(shifted.smallest.error, 1e-4);
  const auto whole = spectrum_of(table_of("phong:n=5+rrim"));  // a factor of 1 is not none
  EXPECT_LT(whole.norm.error, 1e-4);
}

// A mirror that depends on the angle has a continuous spectrum, of which a grid has a value here and there: errors were
// those of rounding.
TEST(Spectrum, OfAMirrorByAngleHasErrorsThatReachWhatNoRingHas) {
  const auto found = spectrum_of(table_of("mirror*fresnel:ior=1.5,k=0", "gauss:24x48"));
  const auto& falling = found.orders.at(1).values;  // -R, from -1 at the horizon to -0.04 along the normal

  EXPECT_NEAR(found.norm.value, 1, found.norm.error);
  EXPECT_LT(found.norm.error, 0.05);
  EXPECT_NEAR(falling.front().value, -1, falling.front().error);
  EXPECT_NEAR(falling.back().value, -0.04, falling.back().error);
  EXPECT_LT(falling.back().error, 1e-3);
  for (std::size_t k = 0; k + 1 < falling.size(); ++k) {
    EXPECT_LE(falling[k + 1].value - falling[k].value, (falling[k].error + falling[k + 1].error) * (1 + 1e-9)) << k;
  }
}

TEST(Spectrum, OfASelfCompositionIsTheSquare) {
  const auto f = table_of("metal_phong:n=8");
  auto squares = all_values(spectrum_of(f));
  for (double& value : squares) value *= value;
  std::ranges::sort(squares, std::greater());

  EXPECT_LT(largest_difference(all_values(spectrum_of(self_compose(device(), f))), squares), 1e-14);
}

TEST(Spectrum, OfACompositionIsOneOfSingularValues) {
  const auto product = compose(device(), table_of("phong:n=5"), table_of("ward:m=0.5"));
  const auto values = spectrum_of(product);

  EXPECT_FALSE(values.is_self_adjoint);
  EXPECT_GT(values.reciprocity_defect, 0.01);
  EXPECT_LT(values.hilbert_schmidt.deviation, 1e-14);
  EXPECT_LT(largest_difference(all_values(spectrum_of(transpose(product))), all_values(values)), 1e-14);
}

class SpectrumOf : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(model, SpectrumOf,
                         ::testing::Values("phong:n=5", "metal_phong:n=8", "ward:m=0.5", "blinn:n=6",
                                           "cook_torrance:m=0.5", "oren_nayar:sigma=0.5", "minnaert:k=1",
                                           "exponential_patch:s=3", "lambert:scale=0.3+phong:n=3,scale=0.6"),
                         [](const auto& test) { return test_name(test.param); });

TEST_P(SpectrumOf, ObeysItsSumRules) {
  const auto values = spectrum_of(table_of(GetParam()));

  EXPECT_TRUE(values.is_self_adjoint);
  EXPECT_LT(values.trace.deviation, 1e-13 * std::abs(values.trace.integral.value));
  EXPECT_LT(values.hilbert_schmidt.deviation, 1e-13 * values.hilbert_schmidt.integral.value);
}

TEST_P(SpectrumOf, IsThatOfTheDenseMatrix) {
  const auto table = table_of(GetParam(), "gauss:6x12");
  const auto dense = all_values(spectrum_of(to_general(table)));

  EXPECT_LT(largest_difference(all_values(spectrum_of(table)), dense), 1e-13);
}

/// The values of a finer grid that belong to those of an order: positive ones by rank, negative ones from below.
double partner(const std::vector<double>& values, const std::vector<double>& finer, std::size_t k) {
  if (values[k] >= 0) return finer[k];
  return finer[finer.size() - (values.size() - k)];
}

/// Largest error over its estimate, against a grid four times as fine.
double worst_share(const ChannelSpectrum& coarse, const ChannelSpectrum& fine) {
  double worst = 0;
  for (std::size_t m = 0; m < coarse.orders.size(); ++m) {
    const auto falling = [](const OrderSpectrum& order) {
      auto estimates = order.values;
      std::ranges::sort(estimates, std::greater(), &Estimate::value);
      return estimates;
    };
    std::vector<double> values;
    std::vector<double> others;
    const auto estimates = falling(coarse.orders[m]);
    for (const auto& value : estimates) values.push_back(value.value);
    for (const auto& value : falling(fine.orders[m])) others.push_back(value.value);
    for (std::size_t k = 0; k < values.size(); ++k) {
      constexpr double kRounding = 1e-14;
      const double error = std::abs(values[k] - partner(values, others, k));
      if (error > kRounding) worst = std::max(worst, error / estimates[k].error);
    }
  }
  return worst;
}

TEST(Spectrum, HasAnInfiniteNegativePartWhereDeltaPartsHaveNegativeValues) {
  for (const char* text : {"mirror:rho=0.3+lambert:scale=0.5", "rrim:rho=0.1,scale=-1+phong:n=5",
                           "rrim:rho=0.2+mirror:rho=0.3,scale=-1"}) {
    for (const char* grid : {"gauss:8x16", "klems:145"}) {
      EXPECT_EQ(spectrum_of(table_of(text, grid)).negative_norm.value, kInfinity) << text;
    }
  }
  for (const char* text : {"rrim:rho=0.3+lambert:scale=0.5", "rrim:rho=0.3+mirror:rho=0.3+lambert:scale=0.5"}) {
    EXPECT_LT(spectrum_of(table_of(text, "gauss:8x16")).negative_norm.value, 1e-12) << text;
  }
}

TEST_P(SpectrumOf, HasErrorsThatHoldAgainstAFourTimesFinerGrid) {
  for (const std::string grid : {"gauss:8x16", "gauss:12x24", "uniform:12x24", "cells:12x24"}) {
    const auto coarse = table_of(GetParam(), grid);
    const std::size_t rings = 4 * coarse.grid.n_theta();
    const auto fine = tabulate(device(), coarse.source.front(), HemisphereGrid::gauss(rings, 2 * rings));
    const auto truth = truth_of(fine);

    EXPECT_LT(worst_share(spectrum_of(coarse), truth), 1.0) << grid;
    EXPECT_LE(std::abs(spectrum_of(coarse).negative_norm.value - truth.negative_norm.value),
              spectrum_of(coarse).negative_norm.error + 1e-13)
        << grid;
  }
}

TEST_P(SpectrumOf, HasErrorsThatHoldWithoutFormulas) {
  auto coarse = table_of(GetParam(), "gauss:12x24");
  const auto fine = tabulate(device(), coarse.source.front(), HemisphereGrid::gauss(48, 96));
  coarse.source.clear();

  EXPECT_LT(worst_share(spectrum_of(coarse), truth_of(fine)), 1.0);
}

TEST_P(SpectrumOf, OfACompositionHasErrorsThatHold) {
  const auto composed = [&](const std::string& grid) {
    return compose(device(), table_of(GetParam(), grid), table_of("blinn:n=4", grid));
  };

  EXPECT_LT(worst_share(spectrum_of(composed("gauss:12x24")), truth_of(composed("gauss:48x96"))), 1.0);
}

TEST(Spectrum, HasErrorsThatAreNotFarTooLarge) {
  const auto values = spectrum_of(table_of("phong:n=5", "gauss:24x48"));

  EXPECT_LT(values.norm.error, 1e-9);                                                   // smooth: spectral convergence
  EXPECT_LT(spectrum_of(table_of("metal_phong:n=8", "gauss:24x48")).norm.error, 5e-3);  // kinked: second order
}

reference::Lobe phong(double n) {
  return {[n](const reference::Vector& light, const reference::Vector& view) {
            return reference::phong(light, view, reference::Real(n));
          },
          1};
}

TEST(Spectrum, SumsToTheIntegralsOfAnIndependentQuadrature) {
  const auto values = spectrum_of(table_of("phong:n=5", "gauss:32x64"));
  const auto lobe = phong(5);
  const auto on_diagonal = [&](double theta) {
    const auto direction = reference::direction(theta, 0);
    return 2 * pi * std::sin(theta) * std::cos(theta) * static_cast<double>(lobe.f(direction, direction));
  };

  EXPECT_NEAR(values.trace.sum, reference::integrate(on_diagonal, 0, pi / 4, 1e-12), 1e-7);
  EXPECT_NEAR(values.hilbert_schmidt.sum, reference::point_product(lobe, lobe, 12), 1e-7);
}

TEST(Spectrum, OfANonProductGridIsThatOfTheModel) {
  const auto klems = spectrum_of(table_of("phong:n=3", "klems:145"));
  const auto truth = spectrum_of(table_of("phong:n=3", "gauss:32x64"));

  EXPECT_NEAR(klems.norm.value, truth.norm.value, klems.norm.error);
  EXPECT_NEAR(klems.smallest.value, truth.smallest.value, klems.smallest.error);
  EXPECT_LT(klems.norm.error, 0.1);
}

TEST(Spectrum, OfUnknownErrorsHasUnknownErrors) {
  auto table = table_of("phong:n=5", "gauss:8x16");
  table.source.clear();
  table.error.assign(table.error.size(), std::numeric_limits<double>::quiet_NaN());

  EXPECT_TRUE(std::isnan(spectrum_of(table).norm.error));
}

TEST(Spectrum, LosesMoreInformationTheWiderTheLobe) {
  const auto narrow = spectrum_of(table_of("phong:n=20", "gauss:24x48"));
  const auto wide = spectrum_of(table_of("phong:n=2", "gauss:24x48"));

  for (std::size_t k = 0; k < 3; ++k) {  // the tail is that of the kink where R.V = 0
    SCOPED_TRACE(k);
    EXPECT_GT(narrow.decay[k].bits, wide.decay[k].bits);
    EXPECT_GT(narrow.decay[k].components, wide.decay[k].components);
  }
}

TEST(Spectrum, RefusesThresholdsOutOfRange) {
  SpectrumOptions options;
  options.threshold = 1;
  EXPECT_THROW((void)spectrum(device(), table_of("lambert", "gauss:4x8"), options), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
