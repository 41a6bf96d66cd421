#include "hemisphere/row_tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lobe::test {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

TEST(RowTables, HaveScaledCosines) {
  for (const std::size_t stride : {8U, 16U, 272U}) {
    for (const double psi : {0.0, 1e-9, 0.3, 1.7, 3.14159, 3.141592653589793}) {
      std::vector<double> values(stride);
      write_cosines(psi, 2.5, stride, values.data());
      for (std::size_t m = 0; m < stride; ++m) {
        const auto order = static_cast<double>(m);
        // T_m is at most m^2 times as far off as its argument: cos(psi) by half an ulp, and twice as much for what the
        // steps of the recurrence add.
        EXPECT_NEAR(values[m], 2.5 * std::cos(order * psi), 2.5 * std::max(1.0, order * order) * 1.5 * kEps)
            << psi << ", " << m << " of " << stride;
      }
    }
  }
}

TEST(RowTables, CombineRowsByWeights) {
  for (const Eigen::Index rows : {1, 3, 4, 7, 12}) {
    for (const Eigen::Index fine_rows : {1, 5, 30}) {
      const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(rows, fine_rows);
      const RowMajorMatrix fine = RowMajorMatrix::Random(fine_rows, 24);
      std::vector<double> combined(static_cast<std::size_t>(rows * 24 + 1), -7);
      combine_rows(weights, fine, combined.data());
      for (Eigen::Index row = 0; row < rows; ++row) {
        for (Eigen::Index column = 0; column < 24; ++column) {
          double sum = 0;
          for (Eigen::Index k = 0; k < fine_rows; ++k) sum += weights(row, k) * fine(k, column);
          // Terms below 1, whose partial sums are rounded.
          const double rounding = static_cast<double>(fine_rows * fine_rows) * kEps;
          EXPECT_NEAR(combined[static_cast<std::size_t>(row * 24 + column)], sum, rounding)
              << rows << " of " << fine_rows << ": " << row << ", " << column;
        }
      }
      EXPECT_EQ(combined.back(), -7) << "written past the end for " << rows << " of " << fine_rows;
    }
  }
}

}  // namespace
}  // namespace lobe::test
