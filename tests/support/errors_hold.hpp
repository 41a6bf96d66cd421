#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace lobe::test {

/// Expects stated errors of numbers, of which finer ones are at hand, to be large enough everywhere but for a share,
/// there by a factor of 2, and not too large everywhere.
inline void expect_errors_hold(const Eigen::MatrixXd& value, const Eigen::MatrixXd& error, const Eigen::MatrixXd& finer,
                               const Eigen::MatrixXd& finer_error, double missing = 0.01) {
  ASSERT_TRUE(value.allFinite() && error.allFinite() && finer.allFinite() && finer_error.allFinite());
  const Eigen::ArrayXXd deviation = ((value - finer).array().abs() - finer_error.array()).max(0);
  const Eigen::ArrayXXd share = (error.array() > 0).select(deviation / error.array(), 0.0);
  EXPECT_TRUE((error.array() > 0 || deviation == 0).all());
  EXPECT_LE(share.maxCoeff(), 2);
  EXPECT_LE(static_cast<double>((share > 1).count()), missing * static_cast<double>(share.size()));
  EXPECT_GE(share.maxCoeff(), 0.02);
}

}  // namespace lobe::test
