// Best approximations computed apart from this library (tests/golden/README.md).
#include "lobe/metric/approximation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "support/device.hpp"
#include "support/names.hpp"
#include "support/oracle.hpp"

namespace lobe::test {
namespace {

constexpr double kTolerance = 1e-6;
Approximation compute(const OracleFit& fit) {
  std::vector<Material> basis;
  for (const auto& text : fit.basis) basis.push_back(parse_material(text));
  ApproximationOptions options;
  options.form.non_negative = fit.non_negative;
  // Daylight coefficients have the errors of products times a condition of 1e5.
  if (fit.lighting == "daylight") options.metric.tolerance = 1e-10;
  options.metric.patch_tolerance = 1e-7;
  return approximate(device(), parse_material(fit.target), basis, parse_lighting(fit.lighting), options);
}

double allowed(const OracleFit& fit, std::size_t i) {
  // The record without uncertainties has products as good as the one beside it, and fewer coefficients.
  if (fit.uncertainties.empty()) return 1e-4;
  return std::max(kTolerance, fit.uncertainties[i]);
}

/// Several tests look at the same one.
const Approximation& approximation_of(const OracleFit& fit) {
  static std::map<std::string, Approximation> known;
  const auto found = known.find(fit.name);
  return found != known.end() ? found->second : known.emplace(fit.name, compute(fit)).first->second;
}

class OracleApproximation : public ::testing::TestWithParam<OracleFit> {};

TEST_P(OracleApproximation, HasTheCoefficients) {
  const auto& fit = approximation_of(GetParam()).fits.at(0);

  for (std::size_t i = 0; i < GetParam().coefficients.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(fit.coefficients(at), GetParam().coefficients[i], allowed(GetParam(), i)) << GetParam().basis[i];
    EXPECT_EQ(fit.at_zero[i], GetParam().non_negative && GetParam().coefficients[i] == 0) << GetParam().basis[i];
  }
}

TEST_P(OracleApproximation, HasTheResidual) {
  const auto& result = approximation_of(GetParam());
  // The remainder of products is smaller than the products.
  const double size = kTolerance / GetParam().relative_residual;

  EXPECT_NEAR(result.residual.value, GetParam().residual, size * GetParam().residual);
  EXPECT_NEAR(result.relative_residual.value, GetParam().relative_residual, size * GetParam().relative_residual);
}

TEST_P(OracleApproximation, CoversItsErrors) {
  const auto& fit = approximation_of(GetParam()).fits.at(0);

  for (std::size_t i = 0; i < GetParam().uncertainties.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double error = std::abs(fit.coefficients(at) - GetParam().coefficients[i]);
    EXPECT_LE(error, fit.coefficients_error(at) + GetParam().uncertainties[i]) << GetParam().basis[i];
  }
}

INSTANTIATE_TEST_SUITE_P(oracle, OracleApproximation, ::testing::ValuesIn(oracle_fits()), ByName{});

TEST(OracleApproximations, AreThere) {
  EXPECT_GE(oracle_fits().size(), 7U);
}

}  // namespace
}  // namespace lobe::test
