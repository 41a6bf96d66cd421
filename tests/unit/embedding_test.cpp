#include "lobe/cluster/embedding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

Eigen::MatrixXd distances_of(const Eigen::MatrixXd& points) {
  Eigen::MatrixXd distance(points.rows(), points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    for (Eigen::Index j = 0; j < points.rows(); ++j) distance(i, j) = (points.row(i) - points.row(j)).norm();
  }
  return distance;
}

TEST(ClassicalScaling, RecoversAPlaneFigureUpToAMotion) {
  Eigen::MatrixXd rectangle(4, 2);
  rectangle << 0, 0, 4, 0, 4, 1, 0, 1;
  const auto distance = distances_of(rectangle);

  const auto embedding = classical_scaling(distance);

  ASSERT_EQ(embedding.coordinates.rows(), 4);
  ASSERT_EQ(embedding.coordinates.cols(), 2);
  EXPECT_LE((distances_of(embedding.coordinates) - distance).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(embedding.explained_share, 1, 1e-12);
}

TEST(ClassicalScaling, OrdersAxesByTheirExtent) {
  Eigen::MatrixXd rectangle(4, 2);
  rectangle << 0, 0, 4, 0, 4, 1, 0, 1;

  const auto embedding = classical_scaling(distances_of(rectangle));

  // Half sides 2 and 1/2 on either side of the centre, four points each.
  EXPECT_NEAR(embedding.eigenvalues(0), 16, 1e-12);
  EXPECT_NEAR(embedding.eigenvalues(1), 1, 1e-12);
  EXPECT_NEAR(embedding.eigenvalues(2), 0, 1e-12);
  EXPECT_NEAR(embedding.coordinates.col(0).cwiseAbs().maxCoeff(), 2, 1e-12);
}

TEST(ClassicalScaling, StatesTheShareOfWhatItDrops) {
  Eigen::MatrixXd box(8, 3);
  box << 0, 0, 0, 4, 0, 0, 0, 2, 0, 4, 2, 0, 0, 0, 1, 4, 0, 1, 0, 2, 1, 4, 2, 1;

  const auto embedding = classical_scaling(distances_of(box), 2);

  // Eigenvalues 8 * (2^2, 1^2, 0.5^2).
  EXPECT_NEAR(embedding.explained_share, (32.0 + 8) / (32 + 8 + 2), 1e-12);
}

TEST(ClassicalScaling, PutsTheLargestCoordinateOfEachAxisOnThePositiveSide) {
  Eigen::MatrixXd line(3, 1);
  line << 0, 1, 10;

  const auto embedding = classical_scaling(distances_of(line), 1);

  Eigen::Index at = 0;
  embedding.coordinates.col(0).cwiseAbs().maxCoeff(&at);
  EXPECT_EQ(at, 2);
  EXPECT_GT(embedding.coordinates(at, 0), 0);
}

TEST(ClassicalScaling, KeepsCoincidingPointsTogether) {
  Eigen::MatrixXd points(3, 2);
  points << 1, 2, 1, 2, 4, 6;

  const auto embedding = classical_scaling(distances_of(points));

  EXPECT_LE((embedding.coordinates.row(0) - embedding.coordinates.row(1)).norm(), 1e-7);
}

TEST(ClassicalScaling, CopesWithAllPointsInOnePlace) {
  const auto embedding = classical_scaling(Eigen::MatrixXd::Zero(3, 3));

  EXPECT_TRUE(embedding.coordinates.allFinite());
  EXPECT_TRUE(std::isfinite(embedding.explained_share));
}

TEST(ClassicalScaling, RejectsAMatrixThatIsNotSquare) {
  EXPECT_THROW((void)classical_scaling(Eigen::MatrixXd::Zero(3, 4)), ArgumentError);
}

TEST(ClassicalScaling, RejectsFewerPointsThanDimensions) {
  EXPECT_THROW((void)classical_scaling(Eigen::MatrixXd::Zero(1, 1), 2), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
