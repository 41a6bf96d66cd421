#include "hemisphere/disc_nodes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hemisphere/disc_polynomials.hpp"

namespace lobe::test {
namespace {

class DiscNodesOf : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(unit, DiscNodesOf, ::testing::Values(1, 2, 7, 40, 81, 270));

TEST_P(DiscNodesOf, DetermineAllPolynomialsUpToTheDegree) {
  const DiscPolynomials polynomials(GetParam());
  const DiscNodes nodes(GetParam());
  const Eigen::ArrayXd distances = Eigen::ArrayXd::LinSpaced(57, 0.003, 1);
  // Polynomials of degree n are sqrt(2 (n + 1) / pi) at the rim and rise there n (n + 2) times as fast: half an ulp of
  // r^2 moves a value by that. Sums of few terms round to less than 1e-13.
  const double degree = GetParam();
  const double bound = 1e-13 + 1.1e-16 * degree * (degree + 2) * std::sqrt(2 * (degree + 1) / std::numbers::pi);

  for (int order = 0; order < polynomials.orders(); ++order) {
    const Eigen::ArrayXd radii = nodes.radii().head(nodes.count(order));
    const Eigen::MatrixXd at_nodes = polynomials.radial(order, radii, radii.pow(order));
    const Eigen::MatrixXd expected = polynomials.radial(order, distances, distances.pow(order));

    const Eigen::MatrixXd found = nodes.interpolation(distances, order % 2 == 1).leftCols(radii.size()) * at_nodes;

    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), bound) << order;
  }
}

TEST_P(DiscNodesOf, LeaveOutOrdersThatAreZeroToRounding) {
  const DiscPolynomials polynomials(GetParam());

  for (const double radius : {1e-3, 0.01, 0.1, 0.3, 0.6, 0.9}) {
    const Eigen::ArrayXd at = Eigen::ArrayXd::Constant(1, radius);
    for (int order = orders_at(GetParam(), radius); order < polynomials.orders(); ++order) {
      EXPECT_LT(polynomials.radial(order, at, at.pow(order)).cwiseAbs().maxCoeff(), 1e-13) << radius << " " << order;
    }
  }
}

TEST(DiscNodes, KeepNoMoreOrdersThanMatter) {
  // At half the radius orders above half the degree have not begun; 270 of them are cut to about 185.
  EXPECT_LT(orders_at(270, 0.5), 200);
  EXPECT_GT(orders_at(270, 0.5), 135);
  EXPECT_EQ(orders_at(270, 1), 271);
}

}  // namespace
}  // namespace lobe::test
