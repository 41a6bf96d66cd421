// Products of sums from those of their terms.
#include "fit/unit_terms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace lobe::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using ::testing::ElementsAre;
using ::testing::SizeIs;

/// Products of vectors, which are as good as any reflectances.
ChannelProducts products_of_columns(const MatrixXd& columns) {
  const Eigen::Index n = columns.cols();
  ChannelProducts products{columns.transpose() * columns, MatrixXd::Zero(n, n), MatrixXd::Zero(n, n),
                           MatrixXd::Zero(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      products.squared_distance(i, j) = (columns.col(i) - columns.col(j)).squaredNorm();
    }
  }
  return products;
}

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  return MatrixXd::NullaryExpr(rows, columns, [&] { return number(generator); });
}

TEST(UnitTerms, AreThoseThatDifferInMoreThanScales) {
  const std::vector<Material> materials{
      parse_material("lambert:scale=0.3+phong:n=5,scale=0.4"), parse_material("phong:n=5,scale=0.7+lambert:scale=0.2"),
      parse_material("lambert:scale=0.1+phong:n=6,scale=0"), parse_material("phong:n=5*fresnel:ior=1.5,k=0+lambert")};

  const UnitTerms terms = unit_terms(materials, 1);

  ASSERT_THAT(terms.terms, SizeIs(3));  // of phong:n=6 there is nothing
  for (const Material& term : terms.terms) EXPECT_THAT(term.terms.front().weight, ElementsAre(1)) << term.name;
  ASSERT_THAT(terms.factors, SizeIs(1));
  MatrixXd expected(4, 3);
  expected << 0.3, 0.4, 0, 0.2, 0.7, 0, 0.1, 0, 0, 1, 0, 1;
  EXPECT_EQ(terms.factors.front(), expected);
}

TEST(UnitTerms, HaveFactorsForEachChannel) {
  const std::vector<Material> materials{parse_material("lambert:scale=0.3/0.2/0.1+phong:n=5,scale=0.4")};

  const UnitTerms terms = unit_terms(materials, 3);

  ASSERT_THAT(terms.factors, SizeIs(3));
  constexpr std::array kLambert{0.3, 0.2, 0.1};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(terms.factors[c](0, 0), kLambert.at(c)) << c;
    EXPECT_EQ(terms.factors[c](0, 1), 0.4) << c;
  }
}

TEST(ProductsOfSums, AreThoseOfTheSums) {
  const MatrixXd columns = random_matrix(20, 5, 1);  // a target and four terms
  const MatrixXd factors = random_matrix(6, 4, 2);
  MatrixXd sums(20, 7);
  sums << columns.col(0), columns.rightCols(4) * factors.transpose();
  const ChannelProducts expected = products_of_columns(sums);

  const ChannelProducts found = products_of_sums(products_of_columns(columns), factors);

  constexpr double kRounding = 1e-13;  // of some hundred products of numbers up to 10
  EXPECT_LE((found.gram - expected.gram).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LE((found.squared_distance - expected.squared_distance).cwiseAbs().maxCoeff(), kRounding);
}

// Where materials differ in shape alone, the squares of norms cancel out to the last bit.
TEST(ProductsOfSums, KeepDistancesOfWhatIsNear) {
  constexpr double kStep = 1e-9;
  MatrixXd columns = random_matrix(20, 4, 3);
  columns.col(2) = columns.col(1) + kStep * random_matrix(20, 1, 4);
  MatrixXd factors(2, 3);
  factors << 0.7, 0, 0.3, 0, 0.7, 0.3;
  const double expected = 0.49 * (columns.col(2) - columns.col(1)).squaredNorm();

  const ChannelProducts found = products_of_sums(products_of_columns(columns), factors);

  EXPECT_NEAR(found.squared_distance(1, 2), expected, 1e-14 * expected);
}

TEST(ProductsOfSums, HaveErrorsOfAllThatTheTermsMayBeOffBy) {
  const ChannelProducts exact = products_of_columns(random_matrix(10, 4, 5));
  const MatrixXd factors = random_matrix(3, 3, 6);
  const ChannelProducts expected = products_of_sums(exact, factors);
  double largest_share = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const auto error_of = [&](unsigned more) -> MatrixXd {
      const MatrixXd any =
          random_matrix(4, 4, 100 + 2 * seed + more).unaryExpr([](double x) { return x < 0 ? -1e-3 : 1e-3; });
      return any.triangularView<Eigen::Lower>().toDenseMatrix() +
             MatrixXd(any.triangularView<Eigen::StrictlyLower>()).transpose();
    };
    ChannelProducts moved = exact;
    moved.gram += error_of(0);
    const MatrixXd distance_error = error_of(1);
    moved.squared_distance += distance_error - MatrixXd(distance_error.diagonal().asDiagonal());
    moved.gram_error.setConstant(1e-3);
    moved.squared_distance_error.setConstant(1e-3);
    moved.squared_distance_error.diagonal().setZero();

    const ChannelProducts found = products_of_sums(moved, factors);

    const auto shares = [](const MatrixXd& a, const MatrixXd& b, const MatrixXd& error) -> MatrixXd {
      return ((a - b).cwiseAbs().array() / error.array().max(1e-12)).matrix();
    };
    const double gram = shares(found.gram, expected.gram, found.gram_error).maxCoeff();
    const double distance =
        shares(found.squared_distance, expected.squared_distance, found.squared_distance_error).maxCoeff();
    EXPECT_LE(std::max(gram, distance), 1 + 1e-9);
    largest_share = std::max({largest_share, gram, distance});
  }
  EXPECT_GE(largest_share, 0.9);
}

/// By how much, of what is stated, sums of vectors of whole numbers are off at most. Products of these are right to the
/// last bit, so that roundings of sums alone count.
struct RoundingShares {
  double gram = 0;
  double squared_distance = 0;
};
RoundingShares shares_of_rounding(Eigen::Index terms, bool cancels) {
  constexpr int kSums = 2000;
  constexpr Eigen::Index kLength = 12;
  using Exact = long double;
  RoundingShares largest;
  std::mt19937 generator(static_cast<unsigned>(terms));
  std::uniform_int_distribution<int> whole(-8, 8);
  std::uniform_real_distribution<double> number(0, 1);
  for (int k = 0; k < kSums; ++k) {
    // Where factors cancel, norms are far larger than distances.
    const double offset = cancels ? 1000 : 0;
    const MatrixXd columns =
        MatrixXd::NullaryExpr(kLength, terms + 1, [&] { return offset + static_cast<double>(whole(generator)); });
    MatrixXd factors = MatrixXd::NullaryExpr(2, terms, [&] { return number(generator); });
    // Members whose factors have almost the same sum.
    if (cancels) factors(1, 0) += factors.row(0).sum() - factors.row(1).sum() + 1e-9 * number(generator);

    const ChannelProducts found = products_of_sums(products_of_columns(columns), factors);

    Exact product = 0;
    Exact square = 0;
    for (Eigen::Index row = 0; row < kLength; ++row) {
      Exact first = 0;
      Exact second = 0;
      Exact difference = 0;
      for (Eigen::Index t = 0; t < terms; ++t) {
        const auto value = static_cast<Exact>(columns(row, t + 1));
        first += static_cast<Exact>(factors(0, t)) * value;
        second += static_cast<Exact>(factors(1, t)) * value;
        difference += (static_cast<Exact>(factors(0, t)) - static_cast<Exact>(factors(1, t))) * value;
      }
      product += first * second;
      square += difference * difference;
    }
    const auto share = [](double value, Exact expected, double error) {
      return std::abs(static_cast<double>(static_cast<Exact>(value) - expected)) / error;
    };
    EXPECT_TRUE(found.gram.allFinite() && found.squared_distance.allFinite()) << k;
    largest.gram = std::max(largest.gram, share(found.gram(1, 2), product, found.gram_error(1, 2)));
    largest.squared_distance = std::max(
        largest.squared_distance, share(found.squared_distance(1, 2), square, found.squared_distance_error(1, 2)));
  }
  return largest;
}

TEST(ProductsOfSums, HaveErrorsOfRounding) {
  double largest = 0;
  for (const Eigen::Index terms : {1, 2, 3, 4, 8}) {
    for (const bool cancels : {false, true}) {
      if (cancels && terms == 1) continue;
      SCOPED_TRACE(std::to_string(terms) + (cancels ? " that cancel" : ""));
      const RoundingShares shares = shares_of_rounding(terms, cancels);
      EXPECT_LE(shares.gram, 1);
      EXPECT_LE(shares.squared_distance, 1);
      EXPECT_GT(shares.gram, 0.05);
      largest = std::max(largest, shares.squared_distance);
    }
  }
  EXPECT_GT(largest, 0.5);
}

// What is not known of a term counts for the members that have it alone.
TEST(ProductsOfSums, KeepWhatIsNotKnownToItsMembers) {
  ChannelProducts products = products_of_columns(random_matrix(10, 4, 7));
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  for (MatrixXd* matrix :
       {&products.gram, &products.gram_error, &products.squared_distance, &products.squared_distance_error}) {
    matrix->row(3).setConstant(kUnknown);
    matrix->col(3).setConstant(kUnknown);
  }
  MatrixXd factors(3, 3);
  factors << 0.5, 0.2, 0, 0.4, 0.3, 0, 0, 0, 1;

  const ChannelProducts found = products_of_sums(products, factors);

  for (const MatrixXd* matrix :
       {&found.gram, &found.gram_error, &found.squared_distance, &found.squared_distance_error}) {
    EXPECT_TRUE(matrix->topLeftCorner(3, 3).allFinite()) << *matrix;
    EXPECT_TRUE(std::isnan((*matrix)(3, 1))) << *matrix;
  }
}

}  // namespace
}  // namespace lobe::test
