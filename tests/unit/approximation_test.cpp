// Approximation by scalar products, on vectors of a plain Euclidean space, against enumeration of all active sets.
#include "lobe/fit/approximation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "lobe/core/error.hpp"

namespace lobe::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Sums of a few dozen products of numbers near 1, divided by pivots that are rarely below 1e-3.
constexpr double kRounding = 1e-10;

/// Basis vectors as columns, and a target.
struct Vectors {
  MatrixXd basis;
  VectorXd target;
  VectorXd albedo;
};

/// \param seed of one problem: k vectors of lengths within a factor of 100, in a space of k + 2 dimensions
Vectors random_vectors(unsigned seed, Index k) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(generator); };
  Vectors vectors{MatrixXd::NullaryExpr(k + 2, k, draw), VectorXd::NullaryExpr(k + 2, draw), VectorXd(k)};
  // Like reflectances, vectors lean to one side, so that constraints hold some back and let some free.
  vectors.basis.row(0).array() += 1;
  vectors.target(0) += 1;
  for (Index i = 0; i < k; ++i) {
    vectors.basis.col(i) *= std::pow(10, normal(generator) / 2);
    vectors.albedo(i) = vectors.basis.col(i).norm() * std::exp(normal(generator));
  }
  return vectors;
}

ApproximationProblem problem_of(const Vectors& vectors) {
  ApproximationProblem problem;
  problem.gram = vectors.basis.transpose() * vectors.basis;
  problem.products = vectors.basis.transpose() * vectors.target;
  problem.target_square = {vectors.target.squaredNorm(), 0};
  problem.largest_albedo = vectors.albedo;
  return problem;
}

double distance(const Vectors& vectors, const VectorXd& x) {
  return (vectors.target - vectors.basis * x).norm();
}

double energy(const Vectors& vectors, const VectorXd& x) {
  return x.cwiseAbs().dot(vectors.albedo);
}

/// The stationary point with these signs, and with sum sign_i albedo_i x_i = 1 where the energy is at its bound.
VectorXd stationary(const ApproximationProblem& problem, const std::vector<int>& signs, bool at_bound) {
  std::vector<Index> free;
  for (std::size_t i = 0; i < signs.size(); ++i) {
    if (signs[i] != 0) free.push_back(static_cast<Index>(i));
  }
  const auto n = static_cast<Index>(free.size());
  MatrixXd system = MatrixXd::Zero(n + 1, n + 1);
  VectorXd right(n + 1);
  system.topLeftCorner(n, n) = problem.gram(free, free);
  right.head(n) = problem.products(free);
  system(n, n) = 1;
  right(n) = 0;
  if (at_bound) {
    for (Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(free[static_cast<std::size_t>(i)]);
      system(i, n) = system(n, i) = signs[at] * problem.largest_albedo(static_cast<Index>(at));
    }
    system(n, n) = 0;
    right(n) = 1;
  }
  const VectorXd solution = system.fullPivLu().solve(right);
  VectorXd x = VectorXd::Zero(problem.gram.rows());
  for (Index i = 0; i < n; ++i) x(free[static_cast<std::size_t>(i)]) = solution(i);
  return x;
}

/// The best of the stationary points of all faces that are admitted.
VectorXd enumerated(const Vectors& vectors, const ApproximationForm& form) {
  const auto problem = problem_of(vectors);
  const auto k = static_cast<std::size_t>(vectors.basis.cols());
  std::vector<int> signs(k, form.non_negative ? 0 : -1);
  VectorXd best = VectorXd::Zero(static_cast<Index>(k));
  for (;;) {
    for (const bool at_bound : {false, true}) {
      const bool is_empty = std::ranges::all_of(signs, [](int sign) { return sign == 0; });
      if (at_bound && (!form.energy || is_empty)) continue;
      const VectorXd x = stationary(problem, signs, at_bound);
      const bool is_admitted =
          (!form.non_negative || x.minCoeff() >= -1e-12) && (!form.energy || energy(vectors, x) <= 1 + 1e-12);
      if (is_admitted && distance(vectors, x) < distance(vectors, best)) best = x;
    }
    std::size_t digit = 0;
    while (digit < k && signs[digit] == 1) signs[digit++] = form.non_negative ? 0 : -1;
    if (digit == k) return best;
    ++signs[digit];
  }
}

struct FormCase {
  std::string name;
  ApproximationForm form;
};

class Form : public ::testing::TestWithParam<FormCase> {};

constexpr unsigned kProblems = 200;

TEST_P(Form, IsAsGoodAsTheBestOfAllActiveSets) {
  for (unsigned seed = 0; seed < kProblems; ++seed) {
    const auto vectors = random_vectors(seed, 1 + static_cast<Index>(seed % 5));

    const auto fit = best_combination(problem_of(vectors), GetParam().form);

    const VectorXd best = enumerated(vectors, GetParam().form);
    ASSERT_NEAR(distance(vectors, fit.coefficients), distance(vectors, best), kRounding) << "seed " << seed;
    ASSERT_LE((vectors.basis * (fit.coefficients - best)).norm(), 1e-7) << "seed " << seed;
  }
}

TEST_P(Form, IsAdmitted) {
  for (unsigned seed = 0; seed < kProblems; ++seed) {
    SCOPED_TRACE(seed);
    const auto vectors = random_vectors(seed, 2 + static_cast<Index>(seed % 20));

    const auto fit = best_combination(problem_of(vectors), GetParam().form);

    const double least = fit.coefficients.minCoeff();
    const double sum = energy(vectors, fit.coefficients);
    ASSERT_TRUE(!GetParam().form.non_negative || least >= 0) << "seed " << seed << ", " << least;
    ASSERT_TRUE(!GetParam().form.energy || sum <= 1 + 1e-12) << "seed " << seed << ", " << sum;
    ASSERT_NEAR(fit.energy, energy(vectors, fit.coefficients), 1e-12 * fit.energy);
  }
}

/// The largest violation of the conditions of Karush, Kuhn and Tucker, from the vectors themselves. The multiplier is
/// the one that fits the material with the largest coefficient.
double violation(const Vectors& vectors, const ApproximationForm& form, const LinearFit& fit) {
  const VectorXd rest = vectors.target - vectors.basis * fit.coefficients;
  const double norm = vectors.target.norm();
  VectorXd slope(fit.coefficients.size());
  VectorXd albedo = slope;
  for (Index i = 0; i < slope.size(); ++i) {
    const double length = vectors.basis.col(i).norm();
    slope(i) = vectors.basis.col(i).dot(rest) / (length * norm);
    albedo(i) = vectors.albedo(i) * norm / length;
  }
  double multiplier = 0;
  if (form.energy && energy(vectors, fit.coefficients) > 1 - 1e-10) {
    Index largest = 0;
    fit.coefficients.cwiseAbs().maxCoeff(&largest);
    multiplier = std::abs(slope(largest)) / albedo(largest);
  }
  double worst = 0;
  for (Index i = 0; i < slope.size(); ++i) {
    const double x = fit.coefficients(i);
    if (x == 0 && (form.non_negative || form.energy)) {
      worst = std::max(worst, (form.non_negative ? slope(i) : std::abs(slope(i))) - multiplier * albedo(i));
    } else {
      worst = std::max(worst, std::abs(slope(i) - (x > 0 ? 1 : -1) * multiplier * albedo(i)));
    }
  }
  return worst;
}

TEST_P(Form, MeetsTheOptimalityConditionsTo1em9) {
  for (unsigned seed = 0; seed < kProblems; ++seed) {
    const auto vectors = random_vectors(seed, 2 + static_cast<Index>(seed % 40));

    const auto fit = best_combination(problem_of(vectors), GetParam().form);

    ASSERT_LE(violation(vectors, GetParam().form, fit), 1e-9) << "seed " << seed;
    ASSERT_LE(fit.kkt_residual, 1e-9) << "seed " << seed;
  }
}

TEST_P(Form, FindsATargetThatIsAdmittedItself) {
  auto vectors = random_vectors(7, 6);
  VectorXd x(6);
  x << 0.3, 0, 1, 0, 0.01, 2;
  x /= 1.5 * x.dot(vectors.albedo);
  vectors.target = vectors.basis * x;

  const auto fit = best_combination(problem_of(vectors), GetParam().form);

  EXPECT_LE((fit.coefficients - x).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE(fit.relative_residual.value, fit.relative_residual.error);
}

TEST_P(Form, IsTheSameInOtherUnitsOfTheBasis) {
  const auto vectors = random_vectors(11, 5);
  auto scaled = vectors;
  scaled.basis.col(2) *= 1e3;
  scaled.albedo(2) *= 1e3;

  const auto fit = best_combination(problem_of(vectors), GetParam().form);
  const auto other = best_combination(problem_of(scaled), GetParam().form);

  VectorXd expected = fit.coefficients;
  expected(2) /= 1e3;
  EXPECT_LE((other.coefficients - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(other.condition, fit.condition, 1e-9 * fit.condition);
}

TEST_P(Form, GrowsWithItsTarget) {
  const auto vectors = random_vectors(12, 5);
  auto scaled = vectors;
  scaled.target *= 50;
  scaled.albedo /= 50;

  const auto fit = best_combination(problem_of(vectors), GetParam().form);
  const auto other = best_combination(problem_of(scaled), GetParam().form);

  EXPECT_LE((other.coefficients - 50 * fit.coefficients).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(other.residual.value, 50 * fit.residual.value, 1e-10);
  EXPECT_NEAR(other.relative_residual.value, fit.relative_residual.value, 1e-12);
}

TEST_P(Form, BoundsTheEffectOfErrorsInTheProducts) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const auto vectors = random_vectors(seed, 4);
    auto problem = problem_of(vectors);
    const auto exact = best_combination(problem, GetParam().form);
    problem.gram_error = 1e-7 * problem.gram.cwiseAbs();
    problem.products_error = 1e-7 * problem.products.cwiseAbs();
    problem.target_square.error = 1e-7 * problem.target_square.value;
    std::mt19937 generator(seed + 1000);
    std::uniform_real_distribution<double> share(-1, 1);
    for (Index i = 0; i < 4; ++i) {
      for (Index j = 0; j <= i; ++j) {
        problem.gram(i, j) = problem.gram(j, i) = problem.gram(i, j) + share(generator) * problem.gram_error(i, j);
      }
      problem.products(i) += share(generator) * problem.products_error(i);
    }
    problem.target_square.value += share(generator) * problem.target_square.error;

    const auto disturbed = best_combination(problem, GetParam().form);

    // The errors themselves were taken before the disturbance.
    const VectorXd change = (disturbed.coefficients - exact.coefficients).cwiseAbs();
    for (Index i = 0; i < 4; ++i) ASSERT_LE(change(i), 1.01 * disturbed.coefficients_error(i) + 1e-12) << seed;
    ASSERT_LE(std::abs(disturbed.residual.value - exact.residual.value), 1.01 * disturbed.residual.error) << seed;
  }
}

TEST_P(Form, BoundsTheEffectOfErrorsInLargestAlbedos) {
  double largest_share = 0;
  double largest_residual_share = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    auto problem = problem_of(random_vectors(seed, 4));
    // Errors of the last material are large beside the others', so that it is the one that may be free.
    VectorXd error = 1e-6 * problem.largest_albedo;
    if (seed % 2 == 1) error(3) *= 100;
    auto exact = problem;
    std::mt19937 generator(seed + 1000);
    for (Index i = 0; i < 4; ++i) {
      const double share = seed % 4 < 2 ? 1 : std::uniform_real_distribution<double>(0, 1)(generator);
      exact.largest_albedo(i) -= share * error(i);
    }
    problem.largest_albedo_error = error;

    const auto fit = best_combination(problem, GetParam().form);
    const auto other = best_combination(exact, GetParam().form);

    ASSERT_EQ(fit.energy_slack > 0, fit.at_energy_bound) << seed;
    for (Index i = 0; i < 4; ++i) {
      const double change = std::abs(fit.coefficients(i) - other.coefficients(i));
      ASSERT_LE(change, 1.01 * fit.coefficients_error(i) + 1e-12) << seed;
      if (change > 1e-9) largest_share = std::max(largest_share, change / fit.coefficients_error(i));
    }
    const double gain = std::abs(other.residual.value - fit.residual.value);
    ASSERT_LE(gain, 1.01 * fit.residual.error + 1e-12) << seed;
    if (gain > 1e-9) largest_residual_share = std::max(largest_residual_share, gain / fit.residual.error);
  }
  if (!GetParam().form.energy) return;
  EXPECT_GE(largest_share, 0.9);
  EXPECT_GE(largest_residual_share, 0.99);
}

/// A problem with a material at zero that is all but free; none: no material is at zero, or all are.
std::optional<ApproximationProblem> nearly_free(unsigned seed, const ApproximationForm& form) {
  auto problem = problem_of(random_vectors(seed, 4));
  const auto fit = best_combination(problem, form);
  const VectorXd slope = problem.products - problem.gram * fit.coefficients;
  const auto zero = std::ranges::find(fit.at_zero, true);
  const auto used = std::ranges::find(fit.at_zero, false);
  if (zero == fit.at_zero.end() || used == fit.at_zero.end()) return {};
  const Index j = zero - fit.at_zero.begin();
  const Index i = used - fit.at_zero.begin();
  const double multiplier = fit.at_energy_bound ? std::abs(slope(i)) / problem.largest_albedo(i) : 0;
  problem.products(j) += multiplier * problem.largest_albedo(j) - slope(j) - 1e-8 * std::abs(problem.products(j));
  return problem;
}

TEST_P(Form, DoubtsZerosThatErrorsMightFree) {
  if (!GetParam().form.energy && !GetParam().form.non_negative) return;
  int freed = 0;
  double largest_share = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    const auto made = nearly_free(seed, GetParam().form);
    if (!made) continue;
    ApproximationProblem problem = *made;
    ApproximationProblem exact = problem;
    std::mt19937 generator(seed + 1000);
    const auto coin = [&] { return generator() % 2 == 0; };
    problem.largest_albedo_error = VectorXd::Zero(4);
    if (seed % 2 == 0) {
      problem.largest_albedo_error = 1e-5 * problem.largest_albedo;
      for (Index i = 0; i < 4; ++i) exact.largest_albedo(i) -= coin() ? problem.largest_albedo_error(i) : 0;
    } else {
      problem.products_error = 1e-5 * problem.products.cwiseAbs();
      for (Index i = 0; i < 4; ++i) exact.products(i) += (coin() ? 1 : -1) * problem.products_error(i);
    }

    const auto fit = best_combination(problem, GetParam().form);
    const auto other = best_combination(exact, GetParam().form);

    if (fit.at_energy_bound != other.at_energy_bound) continue;
    for (Index i = 0; i < 4; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!fit.at_zero[at] || other.at_zero[at]) continue;
      ++freed;
      const double share = std::abs(other.coefficients(i)) / fit.coefficients_error(i);
      ASSERT_LE(share, 1.01) << seed;
      largest_share = std::max(largest_share, share);
    }
  }
  EXPECT_GE(freed, 100);
  EXPECT_GE(largest_share, 0.9);
}

INSTANTIATE_TEST_SUITE_P(Approximation, Form,
                         ::testing::Values(FormCase{"free", {}}, FormCase{"non_negative", {.non_negative = true}},
                                           FormCase{"energy", {.energy = true}},
                                           FormCase{"non_negative_and_energy", {.non_negative = true, .energy = true}}),
                         [](const auto& test) { return test.param.name; });

TEST(BestCombination, LeavesARestAtRightAngles) {
  for (unsigned seed = 0; seed < kProblems; ++seed) {
    const auto vectors = random_vectors(seed, 8);

    const auto fit = best_combination(problem_of(vectors));

    const double part = (vectors.basis * fit.coefficients).squaredNorm();
    const double whole = vectors.target.squaredNorm();
    ASSERT_NEAR(part + fit.residual.value * fit.residual.value, whole, 1e-10 * whole) << "seed " << seed;
  }
}

TEST(BestCombination, StatesRankAndCondition) {
  ApproximationProblem problem;
  problem.gram = (MatrixXd(2, 2) << 4, 1, 1, 1).finished();  // scaled to 1: 1 and 1/2, eigenvalues 3/2 and 1/2
  problem.products = VectorXd::Ones(2);
  problem.target_square = {9, 0};

  const auto fit = best_combination(problem);

  EXPECT_EQ(fit.rank, 2);
  EXPECT_NEAR(fit.condition, 3, 1e-14);
  EXPECT_LE((fit.coefficients - VectorXd::Unit(2, 1)).norm(), 1e-15);
  EXPECT_NEAR(fit.residual.value, std::sqrt(8), 1e-14);
}

/// Three vectors in a plane, the last of them the sum of the others, and a target.
ApproximationProblem dependent_problem() {
  Vectors vectors{MatrixXd(3, 3), VectorXd(3), VectorXd::Ones(3)};
  vectors.basis << 1, 0, 1, 0, 2, 2, 0, 0, 0;
  vectors.target << 1, 1, 1;
  auto problem = problem_of(vectors);
  problem.names = {"red", "green", "blue"};
  return problem;
}

std::string message_of(const ApproximationProblem& problem, const ApproximationForm& form = {}) {
  try {
    (void)best_combination(problem, form);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(DependentBasis, IsRefusedNamingOneOfThoseThatDepend) {
  const auto problem = dependent_problem();

  EXPECT_THROW((void)best_combination(problem), NumericError);
  EXPECT_THAT(message_of(problem), AllOf(HasSubstr("rank 2 of 3"), HasSubstr("' depends on the others")));
}

TEST(DependentBasis, NamesTheSecondOfTwoThatAreTheSame) {
  auto problem = problem_of(random_vectors(3, 3));
  problem.gram.col(2) = problem.gram.col(0).eval();
  problem.gram.row(2) = problem.gram.row(0).eval();
  problem.products(2) = problem.products(0);
  problem.names = {"first", "other", "second"};

  EXPECT_THAT(message_of(problem), AllOf(HasSubstr("'second'"), Not(HasSubstr("'first'")), Not(HasSubstr("'other'"))));
}

TEST(DependentBasis, NamesTheOneWhoseNormIsHardlyKnown) {
  auto problem = problem_of(random_vectors(3, 3));
  problem.names = {"first", "hazy", "last"};
  problem.gram_error = MatrixXd::Zero(3, 3);
  problem.gram_error(1, 1) = 0.9 * problem.gram(1, 1);
  EXPECT_THAT(message_of(problem),
              AllOf(HasSubstr("the squared norm of 'hazy' in the basis has an error of 90 % of itself"),
                    Not(HasSubstr("linearly dependent"))));
  problem.gram_error(1, 1) = 1e4 * problem.gram(1, 1);
  EXPECT_THAT(message_of(problem), HasSubstr("'hazy' in the basis has an error of many times itself"));

  // Without it the others would still depend on each other.
  problem.gram.col(2) = problem.gram.col(0).eval();
  problem.gram.row(2) = problem.gram.row(0).eval();
  problem.products(2) = problem.products(0);
  EXPECT_THAT(message_of(problem), HasSubstr("linearly dependent"));

  // One that is known to 40 % is no such one, though the rank may suffer.
  problem = problem_of(random_vectors(3, 3));
  problem.gram_error = MatrixXd::Constant(3, 3, 0.4);
  problem.gram_error = problem.gram_error.cwiseProduct(problem.gram.diagonal().cwiseSqrt() *
                                                       problem.gram.diagonal().cwiseSqrt().transpose());
  EXPECT_THAT(message_of(problem), HasSubstr("linearly dependent"));
}

TEST(DependentBasis, IsRefusedAlsoWithConstraints) {
  EXPECT_THAT(message_of(dependent_problem(), {.non_negative = true}), HasSubstr("linearly dependent"));
  EXPECT_THAT(message_of(dependent_problem(), {.energy = true}), HasSubstr("linearly dependent"));
}

TEST(DependentBasis, IsSeenWithinTheErrorsOfTheProducts) {
  auto problem = dependent_problem();
  problem.gram(2, 2) *= 1 + 1e-9;
  EXPECT_EQ(message_of(problem), "");

  problem.gram_error = 1e-8 * problem.gram.cwiseAbs();

  EXPECT_THAT(message_of(problem), HasSubstr("rank 2 of 3"));
}

TEST(DependentBasis, GivesTheCombinationOfLeastNormWhenAsked) {
  const auto fit = best_combination(dependent_problem(), {.allow_dependent = true});

  // x = (1, 1/2, 0) + t (1, 1, -1), of which (x_1, 2 x_2, sqrt(5) x_3) is shortest: t = -(1 + 2) / (1 + 4 + 5).
  const VectorXd expected = VectorXd{{1 - 0.3, 0.5 - 0.3, 0.3}};
  EXPECT_LE((fit.coefficients - expected).norm(), 1e-14);
  EXPECT_EQ(fit.rank, 2);
  EXPECT_EQ(fit.condition, kInfinity);
  EXPECT_EQ(fit.dependent.size(), 1U);
  EXPECT_NEAR(fit.residual.value, 1, 1e-14);
}

TEST(DependentBasis, WithConstraintsGivesAnOptimalCombinationWhenAsked) {
  for (const bool with_energy : {false, true}) {
    SCOPED_TRACE(with_energy);
    const ApproximationForm form{.non_negative = true, .energy = with_energy, .allow_dependent = true};

    const auto fit = best_combination(dependent_problem(), form);

    EXPECT_GE(fit.coefficients.minCoeff(), 0);
    EXPECT_LE(fit.kkt_residual, 1e-12);
    // The vectors reach the plane's point (1, 1), by energy only up to the segment from (0, 2) to (1, 2) and (1, 0).
    EXPECT_NEAR(fit.residual.value, 1, 1e-7);
  }
}

/// Powers x^p on [0, 1], p from 0.5 to 500, all but dependent, against x^3.3 + (1 - x).
ApproximationProblem powers(Index count) {
  ApproximationProblem problem;
  problem.gram = MatrixXd(count, count);
  problem.products = problem.largest_albedo = VectorXd(count);
  const auto power = [&](Index i) {
    return 0.5 * std::pow(1000, static_cast<double>(i) / static_cast<double>(count - 1));
  };
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < count; ++j) problem.gram(i, j) = 1 / (power(i) + power(j) + 1);
    problem.products(i) = 1 / (power(i) + 4.3) + 1 / (power(i) + 1) - 1 / (power(i) + 2);
    problem.largest_albedo(i) = 1;
  }
  problem.target_square = {1 / 7.6 + 2 * (1 / 4.3 - 1 / 5.3) + 1.0 / 3, 0};
  return problem;
}

TEST_P(Form, IsOptimalForSixtyLobesThatOverlap) {
  auto form = GetParam().form;
  form.allow_dependent = true;

  const auto fit = best_combination(powers(60), form);

  EXPECT_LT(fit.rank, 60);
  // Without constraints eigenvalues that do not count, of 60 sums of 60 terms, leave the root of their size.
  const bool is_free = !form.non_negative && !form.energy;
  EXPECT_LE(fit.kkt_residual, is_free ? std::sqrt(4 * 60 * 60 * std::numeric_limits<double>::epsilon()) : 1e-9);
}

TEST(BestCombination, LeavesOutMaterialsThatAreZero) {
  auto problem = problem_of(random_vectors(5, 2));
  problem.gram.row(1).setZero();
  problem.gram.col(1).setZero();
  problem.products(1) = 0;
  problem.names = {"seen", "unseen"};
  EXPECT_THAT(message_of(problem), HasSubstr("'unseen' depends on the others"));

  const auto fit = best_combination(problem, {.allow_dependent = true});

  EXPECT_NEAR(fit.coefficients(0), problem.products(0) / problem.gram(0, 0), 1e-14);
  EXPECT_EQ(fit.coefficients(1), 0);
  EXPECT_EQ(fit.coefficients_error(1), kInfinity);
}

/// Two unit vectors at right angles, the second of them pointing away from the target by a little.
ApproximationProblem turned_away(double by) {
  ApproximationProblem problem;
  problem.gram = MatrixXd::Identity(2, 2);
  problem.products = VectorXd{{1, -by}};
  problem.products_error = VectorXd::Constant(2, 1e-8);
  problem.target_square = {2, 0};
  return problem;
}

TEST(BestCombination, DoubtsAZeroThatErrorsMightFree) {
  const auto fit = best_combination(turned_away(1e-9), {.non_negative = true});

  EXPECT_TRUE(fit.at_zero[1]);
  EXPECT_NEAR(fit.coefficients_error(1), 0.9e-8, 1e-12);
}

TEST(BestCombination, IsSureOfAZeroBeyondErrors) {
  const auto fit = best_combination(turned_away(1e-7), {.non_negative = true});

  EXPECT_TRUE(fit.at_zero[1]);
  EXPECT_EQ(fit.coefficients_error(1), 0);
}

TEST(BestCombination, ReturnsFromTheEnergyBoundToItsInside) {
  // The first vector alone falls short of the target, at the bound; with the second there is room again.
  const Vectors vectors{MatrixXd{{0.5, 0.7}, {0, 1}}, VectorXd{{0.52, 0.15}}, VectorXd::Ones(2)};

  const auto fit = best_combination(problem_of(vectors), {.non_negative = true, .energy = true});

  EXPECT_FALSE(fit.at_energy_bound);
  EXPECT_LE((fit.coefficients - VectorXd{{0.83, 0.15}}).norm(), 1e-14);
}

TEST(BestCombination, TakesOutMaterialsOfUnboundedAlbedo) {
  auto problem = problem_of(random_vectors(5, 3));
  problem.largest_albedo(1) = kInfinity;

  const auto fit = best_combination(problem, {.energy = true});

  EXPECT_EQ(fit.coefficients(1), 0);
  EXPECT_LE(fit.kkt_residual, 1e-12);
}

TEST(BestCombination, OfACancellingResidualSaysThatItIsUnknown) {
  auto vectors = random_vectors(9, 3);
  vectors.target = vectors.basis * VectorXd::Ones(3);
  auto problem = problem_of(vectors);
  problem.target_square.error = 1e-8 * problem.target_square.value;

  const auto fit = best_combination(problem);

  EXPECT_GE(fit.relative_residual.error, 1e-5);
  EXPECT_LE(fit.relative_residual.value, fit.relative_residual.error);
}

TEST(BestCombination, RefusesWhatDoesNotFit) {
  const auto problem = problem_of(random_vectors(1, 3));

  auto other = problem;
  other.products = VectorXd::Ones(2);
  EXPECT_THROW((void)best_combination(other), ArgumentError);
  other = problem;
  other.gram = MatrixXd::Ones(3, 2);
  EXPECT_THROW((void)best_combination(other), ArgumentError);
  other = problem;
  other.gram(0, 1) = std::nan("");
  EXPECT_THROW((void)best_combination(other), ArgumentError);
  other = problem;
  other.names = {"one"};
  EXPECT_THROW((void)best_combination(other), ArgumentError);
  other = problem;
  other.largest_albedo_error = VectorXd::Zero(2);
  EXPECT_THROW((void)best_combination(other, {.energy = true}), ArgumentError);
  other.largest_albedo_error = VectorXd::Constant(3, -1);
  EXPECT_THROW((void)best_combination(other, {.energy = true}), ArgumentError);
  other = problem;
  other.largest_albedo = {};
  EXPECT_THROW((void)best_combination(other, {.energy = true}), ArgumentError);
  other.largest_albedo = VectorXd::Zero(3);
  EXPECT_THROW((void)best_combination(other, {.energy = true}), ArgumentError);
}

TEST(BestCombination, RefusesATargetOfNormZero) {
  auto problem = problem_of(random_vectors(1, 3));
  problem.target_square.value = 0;

  EXPECT_THROW((void)best_combination(problem), NumericError);
}

// --- Greedy selection ---

/// Orthogonal matching pursuit in vectors.
std::vector<std::size_t> pursued(const Vectors& vectors, std::size_t count) {
  std::vector<std::size_t> chosen;
  VectorXd rest = vectors.target;
  while (chosen.size() < count) {
    std::size_t best = 0;
    double largest = 0;
    for (Index i = 0; i < vectors.basis.cols(); ++i) {
      const double cosine = std::abs(vectors.basis.col(i).normalized().dot(rest));
      if (cosine <= largest) continue;
      largest = cosine;
      best = static_cast<std::size_t>(i);
    }
    chosen.push_back(best);
    MatrixXd part(vectors.basis.rows(), static_cast<Index>(chosen.size()));
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      part.col(static_cast<Index>(i)) = vectors.basis.col(static_cast<Index>(chosen[i]));
    }
    rest = vectors.target - part * part.householderQr().solve(vectors.target);
  }
  return chosen;
}

TEST(Greedy, ChoosesAsPursuitInVectorsDoes) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const auto vectors = random_vectors(seed, 12);
    const auto problem = problem_of(vectors);
    const double weight = 1;

    const auto greedy = greedy_combination({&problem, 1}, {&weight, 1}, 5);

    std::vector<std::size_t> chosen;
    for (const auto& step : greedy.steps) chosen.push_back(step.chosen);
    ASSERT_EQ(chosen, pursued(vectors, 5)) << "seed " << seed;
  }
}

TEST(Greedy, LowersTheResidualInEveryStep) {
  const auto problem = problem_of(random_vectors(2, 12));
  const double weight = 1;

  const auto greedy = greedy_combination({&problem, 1}, {&weight, 1}, 12, {.non_negative = true});

  for (std::size_t i = 1; i < greedy.steps.size(); ++i) {
    EXPECT_LT(greedy.steps[i].residual.value, greedy.steps[i - 1].residual.value) << i;
  }
  EXPECT_NEAR(greedy.steps.back().residual.value, best_combination(problem, {.non_negative = true}).residual.value,
              1e-9);
  EXPECT_GE(greedy.fits.front().coefficients.minCoeff(), 0);
}

TEST(Greedy, EndsWhereTheTargetIsReached) {
  auto vectors = random_vectors(4, 6);
  vectors.target = 2 * vectors.basis.col(3);
  const auto problem = problem_of(vectors);
  const double weight = 1;

  const auto greedy = greedy_combination({&problem, 1}, {&weight, 1}, 6);

  ASSERT_EQ(greedy.steps.size(), 1U);
  EXPECT_EQ(greedy.steps[0].chosen, 3U);
  EXPECT_NEAR(greedy.fits[0].coefficients(0), 2, 1e-14);
}

TEST(Greedy, PassesOverWhatDependsOnWhatItHas) {
  const auto problem = dependent_problem();
  const double weight = 1;

  const auto greedy = greedy_combination({&problem, 1}, {&weight, 1}, 3);

  EXPECT_EQ(greedy.steps.size(), 2U);
}

TEST(Greedy, LooksAtAllChannelsTogether) {
  // The first channel would choose the first material, the second, by far heavier one the other.
  auto first = problem_of({MatrixXd::Identity(2, 2), VectorXd{{1, 0.1}}, {}});
  auto second = problem_of({MatrixXd::Identity(2, 2), VectorXd{{0.1, 1}}, {}});
  const std::vector<ApproximationProblem> channels{first, second};

  const auto greedy = greedy_combination(channels, std::vector{0.1, 0.9}, 1);

  EXPECT_EQ(greedy.steps[0].chosen, 1U);
  EXPECT_EQ(greedy.fits.size(), 2U);
  EXPECT_NEAR(greedy.steps[0].residual.value, std::sqrt(0.1 * 1 + 0.9 * 0.01), 1e-14);
}

TEST(Greedy, RefusesNothingToChoose) {
  const auto problem = problem_of(random_vectors(1, 3));
  const double weight = 1;

  EXPECT_THROW((void)greedy_combination({&problem, 1}, {&weight, 1}, 0), ArgumentError);
  EXPECT_THROW((void)greedy_combination({&problem, 1}, {}, 1), ArgumentError);
}

// --- Families ---

/// Two families: the axes x and y of space, and x + y, alone in the other.
MetricResult axes() {
  MatrixXd vectors(3, 3);
  vectors << 1, 0, 1, 0, 1, 1, 0, 0, 0;
  MetricResult result;
  result.combined.gram = vectors.transpose() * vectors;
  result.combined.gram_error = MatrixXd::Zero(3, 3);
  return result;
}

const std::vector<MaterialLabel>& axis_materials() {
  static const std::vector<MaterialLabel> kMaterials{{"x", "axes"}, {"y", "axes"}, {"sum, both", "sums"}};
  return kMaterials;
}

TEST(FamilyResiduals, AreThoseOfTheSpansWithoutTheTarget) {
  const auto table = family_residuals(axes(), axis_materials());

  EXPECT_THAT(table.families, ElementsAre("axes", "sums"));
  EXPECT_NEAR(table.relative_residual(0, 0), 1, 1e-14);  // x against y
  EXPECT_NEAR(table.relative_residual(0, 1), std::sqrt(0.5), 1e-14);
  EXPECT_LE(table.relative_residual(2, 0), table.relative_residual_error(2, 0));
  EXPECT_LE(table.relative_residual_error(2, 0), 1e-6);
  EXPECT_TRUE(std::isnan(table.relative_residual(2, 1)));  // alone in its family
  EXPECT_EQ(table.rank(2, 0), 2);
}

// 1 - 1.001^2 / 2 of the square.
TEST(FamilyResiduals, AreKnownToWhatErrorsOfProductsMakeOfThem) {
  auto result = axes();
  result.combined.gram_error.setConstant(1e-3);
  const auto table = family_residuals(result, axis_materials());

  const double moved = std::sqrt(0.5) - std::sqrt(1 - 1.001 * 1.001 / 2);
  EXPECT_GE(table.relative_residual_error(0, 1), moved);
  EXPECT_LE(table.relative_residual_error(0, 1), 5 * moved);
}

TEST(FamilyResiduals, AreLargerOrEqualWithoutNegativeCoefficients) {
  auto result = axes();
  result.combined.gram(0, 2) = result.combined.gram(2, 0) = -1;  // the sum is y - x

  const auto table = family_residuals(result, axis_materials(), true);

  EXPECT_NEAR(table.relative_residual(0, 1), 1, 1e-14);
  EXPECT_NEAR(table.relative_residual(2, 0), std::sqrt(0.5), 1e-14);
}

TEST(FamilyResiduals, AddUpOverChannels) {
  auto result = axes();
  Metric dark = result.combined;
  dark.gram(0, 0) = 0;  // x is black in the second channel
  dark.gram.row(0).setZero();
  dark.gram.col(0).setZero();
  result.channels = {result.combined, dark};

  const auto table = family_residuals(result, axis_materials(), false, std::vector{0.75, 0.25});

  EXPECT_NEAR(table.relative_residual(0, 1), std::sqrt(0.5), 1e-14);  // only the first channel sees it
  // In the second channel the sum, of square 2, has y alone, of product 1.
  EXPECT_NEAR(table.relative_residual(2, 0), std::sqrt(0.25 * 1 / 2), 1e-7);
}

TEST(FamilyResiduals, AreATableWithTheBestFamily) {
  const std::string text = csv_text(family_residuals(axes(), axis_materials()));

  EXPECT_THAT(text, HasSubstr("material,axes,sums,best\n"));
  EXPECT_THAT(text, HasSubstr("\nx,1,0.7071067811865476,sums\n"));
  EXPECT_THAT(text, HasSubstr("\n\"sum, both\","));
  EXPECT_THAT(text, HasSubstr(",,axes\n"));
}

TEST(FamilyResiduals, RefuseOtherMaterials) {
  EXPECT_THROW((void)family_residuals(axes(), std::span(axis_materials()).first(2)), ArgumentError);
  auto result = axes();
  result.channels = {result.combined, result.combined};
  EXPECT_THROW((void)family_residuals(result, axis_materials(), false, std::vector{1.0}), ArgumentError);
}

}  // namespace
}  // namespace lobe::test
