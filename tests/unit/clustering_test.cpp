#include "lobe/cluster/clustering.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "lobe/core/error.hpp"
#include "reference/clustering.hpp"
#include "support/estimates.hpp"

namespace lobe::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Sums of at most some hundred distances of order 1, in another order.
constexpr double kTreeRounding = 1e-13;

double uniform(std::mt19937& generator) {
  return static_cast<double>(generator()) / 4294967296.0;
}

/// Distances that are no metric: any symmetric matrix will do.
MatrixXd random_distances(Index n, std::uint32_t seed) {
  std::mt19937 generator(seed);
  MatrixXd distance = MatrixXd::Zero(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = j + 1; i < n; ++i) {
      distance(i, j) = 0.1 + uniform(generator);
      distance(j, i) = distance(i, j);
    }
  }
  return distance;
}

MatrixXd on_a_line(const std::vector<double>& places) {
  const auto n = static_cast<Index>(places.size());
  MatrixXd distance(n, n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      distance(i, j) = std::abs(places[static_cast<std::size_t>(i)] - places[static_cast<std::size_t>(j)]);
    }
  }
  return distance;
}

/// Three groups, far from each other, of four, three and two.
MatrixXd three_groups() {
  return on_a_line({0, 1, 2.1, 3.3, 100, 101, 102.2, 300, 301});
}

MatrixXd no_error(const MatrixXd& distance) {
  return MatrixXd::Zero(distance.rows(), distance.cols());
}

/// The same relative error for all.
MatrixXd relative_error(const MatrixXd& distance, double share) {
  return share * distance;
}

/// Distances moved by up to their errors, the signs at random.
MatrixXd moved(const MatrixXd& distance, const MatrixXd& error, std::uint32_t seed) {
  std::mt19937 generator(seed);
  MatrixXd result = distance;
  for (Index j = 0; j < distance.cols(); ++j) {
    for (Index i = j + 1; i < distance.rows(); ++i) {
      result(i, j) += (generator() % 2 == 0 ? 1 : -1) * error(i, j);
      result(j, i) = result(i, j);
    }
  }
  return result;
}

std::vector<Index> random_permutation(Index n, std::uint32_t seed) {
  std::vector<Index> permutation(static_cast<std::size_t>(n));
  std::iota(permutation.begin(), permutation.end(), Index{0});
  std::mt19937 generator(seed);
  for (std::size_t i = permutation.size(); i-- > 1;) std::swap(permutation[i], permutation[generator() % (i + 1)]);
  return permutation;
}

/// result(i, j) = matrix(p[i], p[j])
MatrixXd permuted(const MatrixXd& matrix, const std::vector<Index>& p) {
  MatrixXd result(matrix.rows(), matrix.cols());
  for (Index i = 0; i < matrix.rows(); ++i) {
    for (Index j = 0; j < matrix.cols(); ++j) {
      result(i, j) = matrix(p[static_cast<std::size_t>(i)], p[static_cast<std::size_t>(j)]);
    }
  }
  return result;
}

reference::Matrix rows_of(const MatrixXd& matrix) {
  reference::Matrix rows;
  for (Index i = 0; i < matrix.rows(); ++i) {
    rows.emplace_back();
    for (Index j = 0; j < matrix.cols(); ++j) rows.back().push_back(matrix(i, j));
  }
  return rows;
}

std::vector<std::pair<std::size_t, std::size_t>> pairs_of(const Dendrogram& tree) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& merge : tree.merges) pairs.emplace_back(merge.first, merge.second);
  return pairs;
}

Dendrogram tree_of(const MatrixXd& distance) {
  return average_linkage(distance, no_error(distance));
}

double length_of(const std::vector<std::size_t>& order, const MatrixXd& distance) {
  double length = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    length += distance(static_cast<Index>(order[i - 1]), static_cast<Index>(order[i]));
  }
  return length;
}

/// Materials of each cluster of the tree.
std::vector<std::set<std::size_t>> members_of(const Dendrogram& tree) {
  std::vector<std::set<std::size_t>> members;
  for (std::size_t i = 0; i < tree.leaves(); ++i) members.push_back({i});
  for (const auto& merge : tree.merges) {
    std::set<std::size_t> joined = members[merge.first];
    joined.insert(members[merge.second].begin(), members[merge.second].end());
    members.push_back(joined);
  }
  return members;
}

TEST(AverageLinkage, MergesFourMaterialsAsByHand) {
  const Dendrogram tree = tree_of(on_a_line({0, 10, 1, 13}));

  ASSERT_EQ(tree.merges.size(), 3U);
  EXPECT_EQ(pairs_of(tree), (std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {1, 3}, {4, 5}}));
  EXPECT_EQ(tree.merges[0].height.value, 1);
  EXPECT_EQ(tree.merges[1].height.value, 3);
  EXPECT_EQ(tree.merges[2].height.value, 11);  // mean of 10, 13, 9, 12
  EXPECT_EQ(tree.merges[2].size, 4U);
}

class RandomDistances : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(RandomDistances, HaveTheTreeOfTheNaiveAlgorithm) {
  const MatrixXd distance = random_distances(25, GetParam());

  const MatrixXd heights = cophenetic_distance(tree_of(distance));

  const auto expected = reference::average_linkage_heights(rows_of(distance));
  for (Index i = 0; i < 25; ++i) {
    SCOPED_TRACE(i);
    for (Index j = 0; j < 25; ++j) {
      SCOPED_TRACE(j);
      EXPECT_NEAR(heights(i, j), expected[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)], kTreeRounding);
    }
  }
}

TEST_P(RandomDistances, HaveTheSameTreeInAnotherOrder) {
  const MatrixXd distance = random_distances(40, GetParam());
  const auto p = random_permutation(40, GetParam() + 100);

  const MatrixXd heights = cophenetic_distance(tree_of(permuted(distance, p)));

  EXPECT_LE((heights - permuted(cophenetic_distance(tree_of(distance)), p)).cwiseAbs().maxCoeff(), kTreeRounding);
}

TEST_P(RandomDistances, HaveAnUltrametricTree) {
  const MatrixXd heights = cophenetic_distance(tree_of(random_distances(30, GetParam())));

  for (Index k = 0; k < 30; ++k) {
    SCOPED_TRACE(k);
    for (Index j = 0; j < 30; ++j) {
      SCOPED_TRACE(j);
      for (Index i = 0; i < 30; ++i) ASSERT_LE(heights(i, j), std::max(heights(i, k), heights(k, j)));
    }
  }
}

TEST_P(RandomDistances, HaveHeightsThatNeverFall) {
  const Dendrogram tree = tree_of(random_distances(60, GetParam()));

  EXPECT_TRUE(std::ranges::is_sorted(tree.merges, {}, [](const Merge& merge) { return merge.height.value; }));
  for (std::size_t i = 0; i < tree.merges.size(); ++i) {
    EXPECT_LT(tree.merges[i].first, tree.merges[i].second) << i;
    EXPECT_LT(tree.merges[i].second, 60 + i) << i;
  }
}

TEST_P(RandomDistances, HaveTheShortestOfAllLeafOrders) {
  for (Index n = 2; n <= 8; ++n) {
    SCOPED_TRACE(n);
    const MatrixXd distance = random_distances(n, GetParam());
    const Dendrogram tree = tree_of(distance);

    const auto order = optimal_leaf_order(tree, distance);

    EXPECT_NEAR(length_of(order, distance), reference::shortest_leaf_order(pairs_of(tree), rows_of(distance)),
                kTreeRounding);
  }
}

TEST_P(RandomDistances, HaveALeafOrderWithoutCrossings) {
  const MatrixXd distance = random_distances(50, GetParam());
  const Dendrogram tree = tree_of(distance);

  const auto order = optimal_leaf_order(tree, distance);

  std::vector<std::size_t> place(50);
  for (std::size_t i = 0; i < 50; ++i) place[order[i]] = i;
  for (const auto& members : members_of(tree)) {
    SCOPED_TRACE(::testing::PrintToString(members));
    const auto [low, high] = std::ranges::minmax(members, {}, [&](std::size_t i) { return place[i]; });
    EXPECT_EQ(place[high] - place[low] + 1, members.size());
  }
}

TEST_P(RandomDistances, HaveTheSameLeafOrderInAnotherOrder) {
  const MatrixXd distance = random_distances(40, GetParam());
  const auto p = random_permutation(40, GetParam() + 100);
  const MatrixXd other = permuted(distance, p);

  auto order = optimal_leaf_order(tree_of(distance), distance);
  std::vector<std::size_t> again;
  for (const auto i : optimal_leaf_order(tree_of(other), other)) again.push_back(static_cast<std::size_t>(p[i]));

  if (again.front() != order.front()) std::ranges::reverse(again);
  EXPECT_EQ(again, order);
}

TEST_P(RandomDistances, HaveHeightsWithinTheirErrors) {
  // Small enough to leave the tree as it is.
  const MatrixXd distance = random_distances(15, GetParam());
  const MatrixXd error = relative_error(distance, 1e-9);
  const Dendrogram tree = average_linkage(distance, error);

  const Dendrogram other = tree_of(moved(distance, error, GetParam()));

  ASSERT_EQ(pairs_of(other), pairs_of(tree));
  for (std::size_t i = 0; i < tree.merges.size(); ++i) {
    EXPECT_LE(std::abs(other.merges[i].height.value - tree.merges[i].height.value),
              tree.merges[i].height.error + kTreeRounding)
        << i;
  }
}

TEST_P(RandomDistances, HaveACopheneticCorrelationWithinItsError) {
  const MatrixXd distance = random_distances(15, GetParam());
  const MatrixXd error = relative_error(distance, 1e-9);
  const Estimate correlation = cophenetic_correlation(average_linkage(distance, error), distance, error);

  const MatrixXd other = moved(distance, error, GetParam());

  EXPECT_LE(std::abs(cophenetic_correlation(tree_of(other), other, no_error(other)).value - correlation.value),
            correlation.error + kTreeRounding);
  EXPECT_GT(correlation.error, 0);
  EXPECT_LT(correlation.error, 1e-7);
}

TEST_P(RandomDistances, InThreeFarGroupsHaveTheBestMedoidsOfAll) {
  MatrixXd distance = random_distances(9, GetParam());
  for (Index j = 0; j < 9; ++j) {
    for (Index i = 0; i < 9; ++i) distance(i, j) += i % 3 == j % 3 ? 0 : 20;
  }

  const Medoids medoids = k_medoids(distance, no_error(distance), 3);

  EXPECT_NEAR(medoids.cost.value, reference::smallest_medoid_cost(rows_of(distance), 3), kTreeRounding);
}

TEST_P(RandomDistances, HaveTheBestSingleMedoidOfAll) {
  const MatrixXd distance = random_distances(9, GetParam());

  const Medoids medoids = k_medoids(distance, no_error(distance), 1);

  EXPECT_NEAR(medoids.cost.value, reference::smallest_medoid_cost(rows_of(distance), 1), kTreeRounding);
}

TEST_P(RandomDistances, InThePlaneHaveMedoidsWithinTheBoundOfLocalOptima) {
  // Arya et al. 2004, Theorem 1: for a metric, what no single swap improves costs at most 5 times the least.
  std::mt19937 generator(GetParam());
  MatrixXd points(9, 2);
  for (Index i = 0; i < 9; ++i) points.row(i) << uniform(generator), uniform(generator);
  MatrixXd distance(9, 9);
  for (Index j = 0; j < 9; ++j) distance.col(j) = (points.rowwise() - points.row(j)).rowwise().norm();

  for (std::size_t k = 2; k <= 8; ++k) {
    const double best = reference::smallest_medoid_cost(rows_of(distance), k);
    const Medoids medoids = k_medoids(distance, no_error(distance), k);
    EXPECT_GE(medoids.cost.value, best - kTreeRounding) << k;
    EXPECT_LE(medoids.cost.value, 5 * best + kTreeRounding) << k;
  }
}

TEST_P(RandomDistances, HaveMedoidsThatNoSwapImproves) {
  const MatrixXd distance = random_distances(30, GetParam());
  const auto cost_of = [&](const std::vector<std::size_t>& medoids) {
    double cost = 0;
    for (Index i = 0; i < 30; ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto m : medoids) nearest = std::min(nearest, distance(static_cast<Index>(m), i));
      cost += nearest;
    }
    return cost;
  };

  const Medoids medoids = k_medoids(distance, no_error(distance), 4);

  EXPECT_NEAR(cost_of(medoids.medoid), medoids.cost.value, kTreeRounding);
  for (std::size_t k = 0; k < 4; ++k) {
    SCOPED_TRACE(k);
    for (std::size_t candidate = 0; candidate < 30; ++candidate) {
      SCOPED_TRACE(candidate);
      auto swapped = medoids.medoid;
      swapped[k] = candidate;
      EXPECT_GE(cost_of(swapped), medoids.cost.value * (1 - 1e-11));
    }
  }
}

TEST_P(RandomDistances, HaveACostWithinItsError) {
  const MatrixXd distance = random_distances(20, GetParam());
  const MatrixXd error = relative_error(distance, 1e-9);
  const Medoids medoids = k_medoids(distance, error, 3);
  const MatrixXd other = moved(distance, error, GetParam());

  const Medoids again = k_medoids(other, no_error(other), 3);

  ASSERT_EQ(again.medoid, medoids.medoid);
  EXPECT_LE(std::abs(again.cost.value - medoids.cost.value), medoids.cost.error + kTreeRounding);
}

TEST_P(RandomDistances, HaveTheSilhouettesOfTheirDefinition) {
  const MatrixXd distance = random_distances(20, GetParam());
  std::vector<std::size_t> cluster(20);
  for (std::size_t i = 0; i < 20; ++i) cluster[i] = i == 7 ? 3 : i % 3;

  const auto values = silhouettes(distance, no_error(distance), cluster);

  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(values[i].value, reference::silhouette(rows_of(distance), cluster, i), kTreeRounding) << i;
  }
  EXPECT_EQ(values[7].value, 0);
}

TEST_P(RandomDistances, HaveSilhouettesWithinTheirErrors) {
  const MatrixXd distance = random_distances(20, GetParam());
  const MatrixXd error = relative_error(distance, 1e-9);
  std::vector<std::size_t> cluster(20);
  for (std::size_t i = 0; i < 20; ++i) cluster[i] = i % 4;
  const MatrixXd other = moved(distance, error, GetParam());

  const auto values = silhouettes(distance, error, cluster);
  const auto again = silhouettes(other, no_error(other), cluster);

  for (std::size_t i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    EXPECT_LE(std::abs(again[i].value - values[i].value), values[i].error + kTreeRounding);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomDistances, ::testing::Range(std::uint32_t{1}, std::uint32_t{7}));

TEST(AverageLinkage, GivesAMergeTheMeanOfItsErrors) {
  const MatrixXd distance = on_a_line({0, 1, 10, 12});
  MatrixXd error = MatrixXd::Zero(4, 4);
  error(2, 0) = error(0, 2) = 0.1;
  error(3, 1) = error(1, 3) = 0.3;

  const Dendrogram tree = average_linkage(distance, error);

  EXPECT_EQ(tree.merges[0].height.error, 0);
  EXPECT_NEAR(tree.merges[2].height.error, 0.1, kTreeRounding);  // (0.1 + 0.3 + 0 + 0) / 4
}

TEST(AverageLinkage, MergesCoincidingMaterialsAtZero) {
  const Dendrogram tree = tree_of(on_a_line({5, 1, 5, 1, 5}));

  EXPECT_EQ(tree.merges[2].height.value, 0);
  EXPECT_EQ(tree.merges[3].height.value, 4);
}

TEST(AverageLinkage, MergesMaterialsThatAreAllAsFarAtOneHeight) {
  const MatrixXd distance = MatrixXd::Constant(6, 6, 2.0) - 2.0 * MatrixXd::Identity(6, 6);

  const Dendrogram tree = tree_of(distance);

  EXPECT_THAT(tree.merges, ::testing::Each(::testing::Field(&Merge::height, EstimateNear(2, 0))));
  EXPECT_EQ(members_of(tree).back().size(), 6U);
}

TEST(AverageLinkage, LeavesASingleMaterialAlone) {
  EXPECT_TRUE(tree_of(MatrixXd::Zero(1, 1)).merges.empty());
}

TEST(OptimalLeafOrder, IsThatOfTheLine) {
  const MatrixXd distance = on_a_line({7, 0, 3, 1.1, 9.5, 20, 15});

  EXPECT_EQ(optimal_leaf_order(tree_of(distance), distance), (std::vector<std::size_t>{1, 3, 2, 0, 4, 6, 5}));
}

TEST(OptimalLeafOrder, HoldsASingleMaterial) {
  const MatrixXd distance = MatrixXd::Zero(1, 1);

  EXPECT_EQ(optimal_leaf_order(tree_of(distance), distance), std::vector<std::size_t>{0});
}

TEST(OptimalLeafOrder, RefusesATreeOfOtherMaterials) {
  EXPECT_THROW((void)optimal_leaf_order(tree_of(MatrixXd::Zero(3, 3)), MatrixXd::Zero(4, 4)), ArgumentError);
}

TEST(Cut, NumbersClustersByTheirFirstMaterial) {
  const Dendrogram tree = tree_of(on_a_line({50, 0, 51, 1, 100}));

  EXPECT_EQ(cut(tree, 3), (std::vector<std::size_t>{0, 1, 0, 1, 2}));
}

TEST(Cut, GivesOneClusterOrOnePerMaterialAtItsEnds) {
  const Dendrogram tree = tree_of(random_distances(4, 1));

  EXPECT_EQ(cut(tree, 1), (std::vector<std::size_t>{0, 0, 0, 0}));
  EXPECT_EQ(cut(tree, 4), (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(Cut, RefusesNoClustersAndTooMany) {
  const Dendrogram tree = tree_of(random_distances(4, 1));

  EXPECT_THROW((void)cut(tree, 0), ArgumentError);
  EXPECT_THROW((void)cut(tree, 5), ArgumentError);
}

TEST(CopheneticCorrelation, IsOneForAnUltrametric) {
  const MatrixXd distance = cophenetic_distance(tree_of(random_distances(12, 3)));

  EXPECT_NEAR(cophenetic_correlation(tree_of(distance), distance, no_error(distance)).value, 1, kTreeRounding);
}

TEST(CopheneticCorrelation, IsThatOfTheNumbersByHand) {
  // Distances 1, 3, 2 and heights 1, 2.5, 2.5: covariance 0.75, sums of squares 2 and 1.5.
  const MatrixXd distance = on_a_line({0, 1, 3});

  EXPECT_NEAR(cophenetic_correlation(tree_of(distance), distance, no_error(distance)).value, 1.5 / std::sqrt(2 * 1.5),
              kTreeRounding);
}

TEST(CopheneticCorrelation, IsUndefinedForDistancesThatAreAllTheSame) {
  const MatrixXd distance = MatrixXd::Ones(3, 3) - MatrixXd::Identity(3, 3);

  EXPECT_TRUE(std::isnan(cophenetic_correlation(tree_of(distance), distance, no_error(distance)).value));
}

TEST(KMedoids, FindTheGroups) {
  const MatrixXd distance = three_groups();

  const Medoids medoids = k_medoids(distance, no_error(distance), 3);

  EXPECT_EQ(medoids.cluster, (std::vector<std::size_t>{0, 0, 0, 0, 1, 1, 1, 2, 2}));
  EXPECT_EQ(medoids.medoid[1], 5U);
  EXPECT_NEAR(medoids.cost.value, reference::smallest_medoid_cost(rows_of(distance), 3), 1e-12);  // distances of 300
}

TEST(KMedoids, LeaveAStartThatIsNotTheBest) {
  // BUILD takes 2, the median, and then 0 or 4; the best two are 1 and 3.
  const MatrixXd distance = on_a_line({0, 1, 10, 19, 20});

  const Medoids medoids = k_medoids(distance, no_error(distance), 2);

  EXPECT_NEAR(medoids.cost.value, reference::smallest_medoid_cost(rows_of(distance), 2), kTreeRounding);
}

TEST(KMedoids, AreTheMaterialsThemselvesWhereThereAreAsMany) {
  const MatrixXd distance = random_distances(5, 1);

  const Medoids medoids = k_medoids(distance, no_error(distance), 5);

  EXPECT_EQ(medoids.cluster, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(medoids.cost.value, 0);
}

TEST(KMedoids, StayInTheirOwnClustersWhereTheyCoincide) {
  const MatrixXd distance = MatrixXd::Zero(4, 4);

  const Medoids medoids = k_medoids(distance, no_error(distance), 2);

  EXPECT_EQ(medoids.cluster[medoids.medoid[0]], 0U);
  EXPECT_EQ(medoids.cluster[medoids.medoid[1]], 1U);
}

TEST(KMedoids, RefuseNoneAndTooMany) {
  const MatrixXd distance = random_distances(4, 1);

  EXPECT_THROW((void)k_medoids(distance, no_error(distance), 0), ArgumentError);
  EXPECT_THROW((void)k_medoids(distance, no_error(distance), 5), ArgumentError);
}

TEST(Silhouettes, AreZeroForOneCluster) {
  const MatrixXd distance = random_distances(3, 1);

  EXPECT_THAT(silhouettes(distance, no_error(distance), {0, 0, 0}), ::testing::Each(EstimateNear(0, 0)));
}

TEST(Silhouettes, AreZeroWhereAllCoincide) {
  const MatrixXd distance = MatrixXd::Zero(4, 4);

  EXPECT_THAT(silhouettes(distance, no_error(distance), {0, 0, 1, 1}), ::testing::Each(EstimateNear(0, 0)));
}

TEST(Silhouettes, RefuseClustersWithGapsOrOfAnotherNumber) {
  const MatrixXd distance = random_distances(3, 1);

  EXPECT_THROW((void)silhouettes(distance, no_error(distance), {0, 2, 2}), ArgumentError);
  EXPECT_THROW((void)silhouettes(distance, no_error(distance), {0, 1, 9}), ArgumentError);
  EXPECT_THROW((void)silhouettes(distance, no_error(distance), {0, 1}), ArgumentError);
}

TEST(NearestNeighbours, RiseInDistance) {
  const MatrixXd distance = on_a_line({0, 5, 1, 9});

  const auto neighbours = nearest_neighbours(distance, no_error(distance), 2);

  ASSERT_EQ(neighbours[0].size(), 2U);
  EXPECT_EQ(neighbours[0][0].material, 2U);
  EXPECT_EQ(neighbours[0][1].material, 1U);
  EXPECT_EQ(neighbours[0][1].distance.value, 5);
}

TEST(NearestNeighbours, AreAllOthersWhereThereAreFewer) {
  const MatrixXd distance = random_distances(3, 1);

  EXPECT_EQ(nearest_neighbours(distance, no_error(distance), 9)[1].size(), 2U);
}

TEST(NearestNeighbours, AreListedInOrderWhereAsNear) {
  const MatrixXd distance = on_a_line({0, 1, -1});

  const auto neighbours = nearest_neighbours(distance, no_error(distance), 2);

  EXPECT_EQ(neighbours[0][0].material, 1U);
  EXPECT_TRUE(neighbours[0][0].is_rank_uncertain);
}

TEST(NearestNeighbours, AreOfUncertainRankWithinTheErrorsOfBoth) {
  const MatrixXd distance = on_a_line({0, 1, -1.1, 5});
  MatrixXd error = MatrixXd::Constant(4, 4, 0.04);

  EXPECT_FALSE(nearest_neighbours(distance, error, 1)[0][0].is_rank_uncertain);
  error.setConstant(0.06);
  EXPECT_TRUE(nearest_neighbours(distance, error, 1)[0][0].is_rank_uncertain);
  EXPECT_FALSE(nearest_neighbours(distance, error, 3)[0][2].is_rank_uncertain);
}

TEST(NearestNeighbours, SeeTheErrorOfAMaterialBeyondTheNext) {
  const MatrixXd distance = on_a_line({0, 1, 2, 3});
  MatrixXd error = MatrixXd::Zero(4, 4);
  error(3, 0) = error(0, 3) = 2.5;

  EXPECT_TRUE(nearest_neighbours(distance, error, 1)[0][0].is_rank_uncertain);
}

class BadDistances : public ::testing::Test {
 protected:
  static void expect_refused(const MatrixXd& distance, const MatrixXd& error) {
    EXPECT_THROW((void)average_linkage(distance, error), Error);
    EXPECT_THROW((void)k_medoids(distance, error, 1), Error);
    EXPECT_THROW((void)nearest_neighbours(distance, error, 1), Error);
  }
};

TEST_F(BadDistances, OfNoMaterialsAreRefused) {
  expect_refused(MatrixXd(0, 0), MatrixXd(0, 0));
}

TEST_F(BadDistances, ThatAreNotSquareAreRefused) {
  expect_refused(MatrixXd::Zero(2, 3), MatrixXd::Zero(2, 3));
}

TEST_F(BadDistances, WithErrorsOfAnotherSizeAreRefused) {
  expect_refused(MatrixXd::Zero(2, 2), MatrixXd::Zero(3, 3));
}

TEST_F(BadDistances, ThatAreNotSymmetricAreRefused) {
  MatrixXd distance = random_distances(3, 1);
  distance(2, 0) += 1e-6;
  expect_refused(distance, no_error(distance));
}

TEST_F(BadDistances, FromAMaterialToItselfAreRefused) {
  MatrixXd distance = random_distances(3, 1);
  distance(1, 1) = 0.5;
  expect_refused(distance, no_error(distance));
}

TEST_F(BadDistances, ThatAreNegativeAreRefused) {
  MatrixXd distance = random_distances(3, 1);
  distance(1, 0) = distance(0, 1) = -1;
  EXPECT_THROW((void)tree_of(distance), NumericError);
}

TEST_F(BadDistances, ThatAreNoNumbersAreRefusedByName) {
  MatrixXd distance = random_distances(3, 1);
  distance(2, 1) = distance(1, 2) = std::nan("");
  try {
    (void)tree_of(distance);
    FAIL() << "no error";
  } catch (const NumericError& error) {
    EXPECT_STREQ(error.what(), "distance of materials 2 and 1 is nan; expected a finite number of at least 0");
  }
}

TEST_F(BadDistances, WithInfiniteErrorsAreRefused) {
  MatrixXd error = MatrixXd::Zero(3, 3);
  error(2, 1) = std::numeric_limits<double>::infinity();
  expect_refused(random_distances(3, 1), error);
}

Metric metric_of(const MatrixXd& distance) {
  Metric metric;
  metric.distance = distance;
  metric.distance_error = relative_error(distance, 1e-9);
  return metric;
}

TEST(ClusterMaterials, TakesTheNumberOfClustersOfTheBestSilhouette) {
  const Clustering clustering = cluster_materials(metric_of(three_groups()));

  EXPECT_EQ(clustering.medoids.medoid.size(), 3U);
  EXPECT_EQ(clustering.tree_cluster, clustering.medoids.cluster);
  ASSERT_EQ(clustering.candidates.size(), 7U);  // 2 to 8, of nine materials
  EXPECT_EQ(clustering.candidates[1].clusters, 3U);
  EXPECT_EQ(clustering.candidates[1].silhouette.value, clustering.mean_silhouette.value);
  EXPECT_GT(clustering.mean_silhouette.value, clustering.candidates[0].silhouette.value);
}

TEST(ClusterMaterials, TriesNoMoreThanTwelveClusters) {
  EXPECT_EQ(cluster_materials(metric_of(random_distances(30, 1))).candidates.back().clusters, 12U);
}

TEST(ClusterMaterials, TakesTheNumberOfClustersThatIsGiven) {
  const Clustering clustering = cluster_materials(metric_of(three_groups()), {.clusters = 2, .neighbours = 4});

  EXPECT_EQ(clustering.medoids.medoid.size(), 2U);
  EXPECT_TRUE(clustering.candidates.empty());
  EXPECT_EQ(clustering.neighbours[0].size(), 4U);
}

TEST(ClusterMaterials, TakesOneMaterialForOneCluster) {
  const Clustering clustering = cluster_materials(metric_of(MatrixXd::Zero(1, 1)));

  EXPECT_EQ(clustering.medoids.medoid, std::vector<std::size_t>{0});
  EXPECT_TRUE(clustering.neighbours[0].empty());
}

TEST(ClusterMaterials, TakesTwoMaterialsForOneCluster) {
  EXPECT_EQ(cluster_materials(metric_of(random_distances(2, 1))).medoids.medoid.size(), 1U);
}

TEST(ClusterMaterials, RefusesMoreClustersThanMaterials) {
  EXPECT_THROW((void)cluster_materials(metric_of(random_distances(3, 1)), {.clusters = 4}), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
