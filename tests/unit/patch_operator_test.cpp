#include "hemisphere/patch_operator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "hemisphere/gauss.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

/// The disc of radius R about (p, 0), cut by the unit disc: its area and the integral of x over it.
struct CutDisc {
  double area, moment;
};

/// By the two circular segments of the lens: (a - sin a cos a, 2/3 sin^3 a) for half angle a of the unit circle.
CutDisc cut_disc(double p, double radius) {
  if (p <= 1 - radius) return {pi * radius * radius, p * pi * radius * radius};
  if (p <= radius - 1) return {pi, 0};
  const double a = std::acos((p * p + 1 - radius * radius) / (2 * p));
  const double b = std::acos((p * p + radius * radius - 1) / (2 * p * radius));
  const double own = a - std::sin(a) * std::cos(a);
  const double other = radius * radius * (b - std::sin(b) * std::cos(b));
  return {own + other, 2.0 / 3 * std::pow(std::sin(a), 3) + p * other - 2.0 / 3 * std::pow(radius * std::sin(b), 3)};
}

/// Integral of g(p) p dp over [0, 1]; g begins like a power 3/2 where discs touch the rim.
double integral(double radius, const std::function<double(double)>& g) {
  const GaussRule gauss = gauss_rule(60);
  const double touching = std::abs(1 - radius);
  double sum = 0;
  for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
    const double x = gauss.nodes[k];
    const double inner = touching * x;
    const double outer = touching + (1 - touching) * x * x;
    sum += gauss.weights[k] * (touching * inner * g(inner) + (1 - touching) * 2 * x * outer * g(outer));
  }
  return sum;
}

class PatchOperator : public ::testing::TestWithParam<double> {
 protected:
  std::vector<Eigen::MatrixXd> matrices(int degree) const {
    const std::vector<LightDisc> discs{{GetParam(), 1}};
    return patch_light_matrices(DiscPolynomials(degree), discs);
  }
};
INSTANTIATE_TEST_SUITE_P(unit, PatchOperator, ::testing::Values(0.02, 0.25, 0.5, 0.999, 1, 1.3, 2));

TEST_P(PatchOperator, HasTheEntryOfConstants) {
  // (1/pi) times the integral of area^2 over the unit disc.
  const double expected = 2 * integral(GetParam(), [&](double p) { return std::pow(cut_disc(p, GetParam()).area, 2); });

  EXPECT_NEAR(matrices(6)[0](0, 0), expected, 1e-12 * expected);
}

TEST_P(PatchOperator, HasTheEntryOfTheFirstMoment) {
  // phi_10 = sqrt(4/pi) r cos psi; pi is the integral of cos^2 over the azimuth.
  const double expected =
      4 * integral(GetParam(), [&](double p) { return std::pow(cut_disc(p, GetParam()).moment, 2); });

  EXPECT_NEAR(matrices(6)[1](0, 0), expected, 1e-12 * std::max(expected, 1e-3));
}

TEST_P(PatchOperator, DoesNotDependOnTheDegreeItIsMadeFor) {
  const auto low = matrices(8);
  const auto high = matrices(60);

  for (std::size_t m = 0; m < low.size(); ++m) {
    const auto n = low[m].rows();
    const double size = high[0](0, 0);
    EXPECT_LT((low[m] - high[m].topLeftCorner(n, n)).cwiseAbs().maxCoeff(), 1e-13 * size) << m;
  }
}

TEST_P(PatchOperator, IsPositive) {
  const auto matrices_of_40 = matrices(40);
  const double size = matrices_of_40[0](0, 0);
  for (std::size_t m = 0; m < matrices_of_40.size(); ++m) {
    SCOPED_TRACE(m);
    const Eigen::MatrixXd& w = matrices_of_40[m];
    EXPECT_LT((w - w.transpose()).cwiseAbs().maxCoeff(), 1e-15 * size);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(w).eigenvalues().minCoeff(), -1e-14 * size);
  }
}

TEST(PatchOperators, OfTheWholeBasePlaneKeepOnlyConstants) {
  const std::vector<LightDisc> discs{{2, 1}};
  const auto matrices = patch_light_matrices(DiscPolynomials(20), discs);

  EXPECT_NEAR(matrices[0](0, 0), pi * pi, 1e-13);  // area^2 over the disc, over pi
  Eigen::MatrixXd rest = matrices[0];
  rest(0, 0) = 0;
  EXPECT_LT(rest.cwiseAbs().maxCoeff(), 1e-13);
  for (std::size_t m = 1; m < matrices.size(); ++m) EXPECT_LT(matrices[m].cwiseAbs().maxCoeff(), 1e-13) << m;
}

TEST(PatchOperators, AddDiscsWithTheirFactors) {
  const DiscPolynomials polynomials(10);
  const std::vector<LightDisc> both{{0.3, 2}, {1.2, 0.5}};
  const std::vector<LightDisc> first{{0.3, 1}};
  const std::vector<LightDisc> second{{1.2, 1}};

  const auto sum = patch_light_matrices(polynomials, both);
  const auto a = patch_light_matrices(polynomials, first);
  const auto b = patch_light_matrices(polynomials, second);

  for (std::size_t m = 0; m < sum.size(); ++m) {
    EXPECT_LT((sum[m] - 2 * a[m] - 0.5 * b[m]).cwiseAbs().maxCoeff(), 1e-14 * sum[0](0, 0)) << m;
  }
}

}  // namespace
}  // namespace lobe::test
