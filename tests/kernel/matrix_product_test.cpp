#include "device/multiply_matrices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "support/deviation.hpp"
#include "support/device.hpp"
#include "support/error_budget.hpp"
#include "support/names.hpp"
#include "support/scale.hpp"

namespace lobe::test {
namespace {

/// A matrix with room after each row.
struct Matrix {
  std::size_t rows, columns, row_stride;
  std::vector<double> values;

  Matrix(std::size_t row_count, std::size_t column_count, std::size_t padding = 0, double value = 0)
      : rows(row_count), columns(column_count), row_stride(column_count + padding), values(rows * row_stride, value) {}

  double& operator()(std::size_t i, std::size_t j) { return values[i * row_stride + j]; }
  double operator()(std::size_t i, std::size_t j) const { return values[i * row_stride + j]; }

  [[nodiscard]] MatrixView view() const { return {values.data(), rows, columns, row_stride}; }
  [[nodiscard]] MutableMatrixView view() { return {values.data(), rows, columns, row_stride}; }
};

Matrix random_matrix(std::size_t rows, std::size_t columns, unsigned seed, std::size_t padding = 0) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Matrix matrix(rows, columns, padding, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) matrix(i, j) = uniform(generator);
  }
  return matrix;
}

Matrix random_symmetric(std::size_t size, unsigned seed) {
  Matrix matrix = random_matrix(size, size, seed);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < i; ++j) matrix(i, j) = matrix(j, i);
  }
  return matrix;
}

std::vector<double> random_row_scale(std::size_t size) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(0.1, 2);
  std::vector<double> scale(size);
  std::ranges::generate(scale, [&] { return uniform(generator); });
  return scale;
}

Matrix product(const Matrix& a, const Matrix& b, const std::vector<double>& scale, Precision precision,
               const PieceLimits& limits = {}) {
  Matrix c(a.rows, b.columns, 0, std::numeric_limits<double>::quiet_NaN());
  multiply(device(), plan_product(device(), a.rows, a.columns, b.columns, precision, limits), a.view(), b.view(), scale,
           c.view(), precision);
  return c;
}

/// Compares with the sum of the same terms in long double. Each term has three roundings and each sum at most
/// min(depth, 256) of the arithmetic, and they are independent: 4 sqrt(n) half ulps of the sum of magnitudes.
void expect_product(const Matrix& c, const Matrix& a, const Matrix& b, const std::vector<double>& scale,
                    Precision precision) {
  const double eps = precision == Precision::double_precision ? kDoubleEps : kSingleEps;
  const double roundings = static_cast<double>(3 + std::min<std::size_t>(scale.size(), 256));
  Deviation deviation;
  for (std::size_t i = 0; i < c.rows; ++i) {
    for (std::size_t j = 0; j < c.columns; ++j) {
      long double sum = 0;
      long double magnitude = 0;
      for (std::size_t x = 0; x < scale.size(); ++x) {
        const long double factor = scale[x];
        const long double term = (a(i, x) * factor) * (b(x, j) * factor);
        sum += term;
        magnitude += std::abs(term);
      }
      const auto tolerance = 4 * std::sqrt(roundings) * (eps / 2) * static_cast<double>(magnitude);
      deviation.add(static_cast<double>(std::abs(c(i, j) - sum)), tolerance,
                    "entry " + std::to_string(i) + ", " + std::to_string(j));
    }
  }
  deviation.report("product");
  EXPECT_LE(deviation.worst(), 1) << deviation.cause();
}

struct MatrixCase {
  std::string name;
  std::size_t rows, depth, columns;
};

std::ostream& operator<<(std::ostream& out, const MatrixCase& c) {
  return out << c.name;
}

MatrixCase shape(std::size_t rows, std::size_t depth, std::size_t columns) {
  return {std::to_string(rows) + "_by_" + std::to_string(depth) + "_by_" + std::to_string(columns), rows, depth,
          columns};
}

// Around register tiles (6 or 12 rows; 8, 16 or 32 columns), local tiles (64), blocks of terms (256); primes.
std::vector<MatrixCase> shapes() {
  std::vector<MatrixCase> list{shape(1, 1, 1), shape(5, 15, 7), shape(6, 16, 8), shape(13, 17, 33)};
  if (small_scale()) return list;
  for (const auto& more : {shape(11, 255, 15), shape(12, 256, 16), shape(13, 257, 17), shape(12, 16, 32),
                           shape(64, 64, 64), shape(65, 63, 129), shape(211, 307, 103), shape(1, 1031, 1),
                           shape(400, 2, 3), shape(3, 2, 600), shape(397, 523, 601)}) {
    list.push_back(more);
  }
  return list;
}

class MatrixProduct : public ::testing::TestWithParam<MatrixCase> {
 protected:
  Matrix a_ = random_matrix(GetParam().rows, GetParam().depth, 1);
  Matrix b_ = random_matrix(GetParam().depth, GetParam().columns, 2);
  std::vector<double> scale_ = random_row_scale(GetParam().depth);
};

TEST_P(MatrixProduct, IsTheSumOfScaledTerms) {
  expect_product(product(a_, b_, scale_, Precision::double_precision), a_, b_, scale_, Precision::double_precision);
}

TEST_P(MatrixProduct, InSinglePrecisionIsTheSumOfScaledTerms) {
  expect_product(product(a_, b_, scale_, Precision::single_precision), a_, b_, scale_, Precision::single_precision);
}

INSTANTIATE_TEST_SUITE_P(device, MatrixProduct, ::testing::ValuesIn(shapes()), ByName{});

struct SymmetricCase {
  std::string name;
  std::size_t size;
  Precision precision;
};

std::ostream& operator<<(std::ostream& out, const SymmetricCase& c) {
  return out << c.name;
}

std::vector<SymmetricCase> symmetric_cases() {
  std::vector<SymmetricCase> list;
  for (const std::size_t size : scaled<std::vector<std::size_t>>({1, 12, 37, 64, 257, 523}, {1, 13, 33})) {
    list.push_back({std::to_string(size) + "_double", size, Precision::double_precision});
    list.push_back({std::to_string(size) + "_single", size, Precision::single_precision});
  }
  return list;
}

class SymmetricMatrices : public ::testing::TestWithParam<SymmetricCase> {};

TEST_P(SymmetricMatrices, InSwappedOrderGiveTheTransposeBitForBit) {
  const auto& [name, size, precision] = GetParam();
  const Matrix a = random_symmetric(size, 3);
  const Matrix b = random_symmetric(size, 4);
  const auto scale = random_row_scale(size);

  const Matrix ab = product(a, b, scale, precision);
  const Matrix ba = product(b, a, scale, precision);

  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) ASSERT_EQ(ab(i, j), ba(j, i)) << "entry " << i << ", " << j;
  }
}

INSTANTIATE_TEST_SUITE_P(device, SymmetricMatrices, ::testing::ValuesIn(symmetric_cases()), ByName{});

struct PieceCase {
  std::string name;
  PieceLimits limits;
};

std::ostream& operator<<(std::ostream& out, const PieceCase& c) {
  return out << c.name;
}

class MatrixPieces : public ::testing::TestWithParam<PieceCase> {
 protected:
  // More than one piece each way also where pieces are largest.
  std::size_t rows_ = scaled<std::size_t>(150, 14);
  std::size_t depth_ = scaled<std::size_t>(1100, 260);
  std::size_t columns_ = scaled<std::size_t>(170, 35);
  Matrix a_ = random_matrix(rows_, depth_, 1);
  Matrix b_ = random_matrix(depth_, columns_, 2);
  std::vector<double> scale_ = random_row_scale(depth_);
};

TEST_P(MatrixPieces, OfAnySizeGiveTheSameBits) {
  const Matrix whole = product(a_, b_, scale_, Precision::double_precision);

  const Matrix assembled = product(a_, b_, scale_, Precision::double_precision, GetParam().limits);

  EXPECT_EQ(assembled.values, whole.values);
}

TEST_P(MatrixPieces, InSinglePrecisionOfAnySizeGiveTheSameBits) {
  const Matrix whole = product(a_, b_, scale_, Precision::single_precision);

  const Matrix assembled = product(a_, b_, scale_, Precision::single_precision, GetParam().limits);

  EXPECT_EQ(assembled.values, whole.values);
}

std::vector<PieceCase> piece_cases() {
  std::vector<PieceCase> list{{"of_a_tile", {12, 256, 32, 0}}, {"of_wide_registers", {100, 512, 100, 64}}};
  if (small_scale()) return list;
  for (const auto& more : {PieceCase{"smallest", {1, 1, 1, 0}}, PieceCase{"uneven", {100, 512, 100, 0}},
                           PieceCase{"of_narrow_registers", {100, 512, 100, 32}}}) {
    list.push_back(more);
  }
  return list;
}

INSTANTIATE_TEST_SUITE_P(device, MatrixPieces, ::testing::ValuesIn(piece_cases()), ByName{});

TEST(MatrixViews, MayHaveRoomBetweenRows) {
  const std::size_t padding = 3;
  const Matrix a = random_matrix(15, 21, 1, padding);  // the room holds NaN
  const Matrix b = random_matrix(21, 19, 2, padding);
  const auto scale = random_row_scale(21);
  Matrix c(15, 19, padding, -5);

  multiply(device(), a.view(), b.view(), scale, c.view(), Precision::double_precision);

  expect_product(c, a, b, scale, Precision::double_precision);
  for (std::size_t i = 0; i < c.rows; ++i) {
    for (std::size_t j = c.columns; j < c.row_stride; ++j) ASSERT_EQ(c(i, j), -5) << "room after row " << i;
  }
}

TEST(MatrixViews, MayShowTheSameFactorTwice) {
  const Matrix a = random_matrix(21, 21, 1);
  const auto scale = random_row_scale(21);

  expect_product(product(a, a, scale, Precision::double_precision), a, a, scale, Precision::double_precision);
}

TEST(MatrixProductValues, NaNReachesItsRowAndNoOther) {
  Matrix a = random_matrix(27, 9, 1);
  const Matrix b = random_matrix(9, 35, 2);
  a(13, 8) = std::numeric_limits<double>::quiet_NaN();

  const Matrix c = product(a, b, random_row_scale(9), Precision::double_precision);

  for (std::size_t i = 0; i < c.rows; ++i) {
    for (std::size_t j = 0; j < c.columns; ++j) {
      ASSERT_EQ(std::isnan(c(i, j)), i == 13) << "entry " << i << ", " << j;
    }
  }
}

TEST(MatrixProductValues, InfinityOfTheRightFactorReachesItsColumnAndNoOther) {
  const Matrix a = random_matrix(27, 9, 1);
  Matrix b = random_matrix(9, 35, 2);
  b(8, 33) = std::numeric_limits<double>::infinity();

  const Matrix c = product(a, b, random_row_scale(9), Precision::single_precision);

  for (std::size_t i = 0; i < c.rows; ++i) {
    for (std::size_t j = 0; j < c.columns; ++j) {
      ASSERT_EQ(std::isinf(c(i, j)), j == 33) << "entry " << i << ", " << j;
    }
  }
}

TEST(MatrixProductValues, WithoutTermsAreZero) {
  const Matrix c = product(Matrix(2, 0), Matrix(0, 3), {}, Precision::double_precision);

  EXPECT_EQ(c.values, std::vector<double>(6, 0.0));
}

TEST(MatrixProductArguments, OfShapesThatDoNotFitAreRefused) {
  const Matrix a(4, 3);
  const Matrix b(3, 5);
  Matrix c(4, 4);

  EXPECT_THROW(multiply(device(), a.view(), b.view(), random_row_scale(3), c.view(), Precision::double_precision),
               ArgumentError);
}

TEST(MatrixProductArguments, WithTooFewScalesAreRefused) {
  const Matrix a(4, 3);
  const Matrix b(3, 5);
  Matrix c(4, 5);

  EXPECT_THROW(multiply(device(), a.view(), b.view(), random_row_scale(2), c.view(), Precision::double_precision),
               ArgumentError);
}

/// A product of several pieces on every device: at least two of depth.
void multiply_in_pieces(const ProgressCallback& progress) {
  const Matrix a = random_matrix(24, 257, 1);
  const Matrix b = random_matrix(257, 64, 2);
  Matrix c(24, 64);
  const auto plan = plan_product(device(), 24, 257, 64, Precision::double_precision, {12, 256, 32, 0});
  multiply(device(), plan, a.view(), b.view(), random_row_scale(257), c.view(), Precision::double_precision, progress);
}

TEST(MatrixProductProgress, GoesInEvenStepsUpToTheLastPiece) {
  std::vector<double> fractions;

  multiply_in_pieces([&](std::string_view, double fraction) {
    fractions.push_back(fraction);
    return true;
  });

  const auto pieces = static_cast<double>(fractions.size());
  ASSERT_GE(pieces, 2);
  for (std::size_t i = 0; i < fractions.size(); ++i) EXPECT_EQ(fractions[i], static_cast<double>(i + 1) / pieces) << i;
}

TEST(MatrixProductProgress, MayCancelTheProduct) {
  EXPECT_THROW(multiply_in_pieces([](std::string_view, double fraction) { return fraction < 0.4; }), Cancelled);
}

TEST(MatrixProductPlan, WorkspaceIsThatOfThePlan) {
  for (const auto precision : {Precision::double_precision, Precision::single_precision}) {
    SCOPED_TRACE(precision == Precision::double_precision ? "double" : "single");
    EXPECT_EQ(multiply_workspace_bytes(device(), 300, 1000, 5000, precision),
              plan_product(device(), 300, 1000, 5000, precision).workspace_bytes);
  }
}

TEST(MatrixProductPlan, WorkspaceOfLargeMatricesIsSmallBesideThem) {
  const std::uint64_t matrix_bytes = std::uint64_t{16384} * 16384 * sizeof(double);

  EXPECT_LT(multiply_workspace_bytes(device(), 16384, 16384, 16384, Precision::double_precision), matrix_bytes / 8);
}

TEST(MatrixProductPlan, PiecesOfWholeRowsFitIntoABuffer) {
  const std::size_t columns = std::size_t{1} << 18;
  const auto plan = plan_product(device(), columns, 1, columns, Precision::double_precision);

  EXPECT_LE(plan.rows * columns * sizeof(double), device().info().largest_buffer_bytes);
}

TEST(MatrixProductPlan, OfNothingTakesNothing) {
  EXPECT_EQ(multiply_workspace_bytes(device(), 0, 5, 5, Precision::double_precision), 0U);
}

}  // namespace
}  // namespace lobe::test
