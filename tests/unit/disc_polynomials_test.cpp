#include "hemisphere/disc_polynomials.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hemisphere/gauss.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;

class Orders : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(unit, Orders, ::testing::Values(0, 1, 2, 7, 39, 40));

TEST_P(Orders, AreOrthonormalInTheAreaOfTheDisc) {
  const int order = GetParam();
  const DiscPolynomials polynomials(40);
  const GaussRule gauss = gauss_rule(50);
  const auto radii = Eigen::Map<const Eigen::ArrayXd>(gauss.nodes.data(), 50);
  const auto weights = Eigen::Map<const Eigen::ArrayXd>(gauss.weights.data(), 50);
  // The integral of cos^2 over the azimuth.
  const Eigen::ArrayXd area = weights * radii * pi * (order == 0 ? 2 : 1);

  const Eigen::MatrixXd values = polynomials.radial(order, radii, radii.pow(order));

  const Eigen::MatrixXd products = values.transpose() * area.matrix().asDiagonal() * values;
  EXPECT_LT((products - Eigen::MatrixXd::Identity(products.rows(), products.cols())).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DiscPolynomials, AreCountedOrderByOrder) {
  const DiscPolynomials polynomials(5);  // degrees m, m + 2, .. up to 5: 3, 3, 2, 2, 1, 1

  EXPECT_EQ(polynomials.orders(), 6);
  EXPECT_EQ(polynomials.count(0), 3);
  EXPECT_EQ(polynomials.count(1), 3);
  EXPECT_EQ(polynomials.count(5), 1);
  EXPECT_EQ(polynomials.first(2), 6);
  EXPECT_EQ(polynomials.size(), 12);
}

TEST(DiscPolynomials, AreKnownInClosedForm) {
  const DiscPolynomials polynomials(4);
  const Eigen::ArrayXd r = Eigen::ArrayXd::LinSpaced(11, 0, 1);

  // Zernike's polynomials of degree 4: 6 r^4 - 6 r^2 + 1, (4 r^4 - 3 r^2) cos 2 psi, r^4 cos 4 psi.
  const Eigen::ArrayXd round = polynomials.radial(0, r, Eigen::ArrayXd::Ones(11)).col(2);
  const Eigen::ArrayXd second = polynomials.radial(2, r, r.square()).col(1);
  const Eigen::ArrayXd fourth = polynomials.radial(4, r, r.pow(4)).col(0);

  EXPECT_LT((round - std::sqrt(5 / pi) * (6 * r.pow(4) - 6 * r.square() + 1)).abs().maxCoeff(), 1e-14);
  EXPECT_LT((second - std::sqrt(10 / pi) * (4 * r.pow(4) - 3 * r.square())).abs().maxCoeff(), 1e-14);
  EXPECT_LT((fourth - std::sqrt(10 / pi) * r.pow(4)).abs().maxCoeff(), 1e-14);
}

TEST(DiscPolynomials, OfHighDegreeAreLargestAtTheRim) {
  const DiscPolynomials polynomials(300);
  const Eigen::ArrayXd r = Eigen::ArrayXd::LinSpaced(1001, 0, 1);

  for (const int order : {0, 1, 50, 299}) {
    SCOPED_TRACE(order);
    const Eigen::MatrixXd values = polynomials.radial(order, r, r.pow(order));
    for (int k = 0; k < values.cols(); ++k) {
      const double factor = disc_polynomial_factor(order, k);
      EXPECT_NEAR(values(1000, k), factor, 1e-12 * factor) << k;
      EXPECT_LE(values.col(k).cwiseAbs().maxCoeff(), factor * (1 + 1e-12)) << order << ", " << k;
    }
  }
}

}  // namespace
}  // namespace lobe::test
