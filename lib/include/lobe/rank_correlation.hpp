#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace lobe {

/// Spearman's rho of two series: the linear correlation of their ranks, equal values sharing the mean of theirs.
/// NaN where a series is constant. O(n log n).
/// \throws ArgumentError for series of different or of no length; NumericError for values that are NaN.
[[nodiscard]] double spearman(std::span<const double> a, std::span<const double> b);

/// Kendall's tau-b of two series (Kendall 1945): (concordant - discordant) / sqrt((p - ties in a) (p - ties in b)) of
/// the p = n (n - 1) / 2 pairs. NaN where a series is constant. O(n log n) (Knight 1966).
/// \throws as spearman()
[[nodiscard]] double kendall(std::span<const double> a, std::span<const double> b);

/// How alike the distance matrices of one set of materials by several metrics rank the pairs of materials.
struct RankAgreement {
  Eigen::MatrixXd spearman;  ///< metrics x metrics, symmetric, 1 on the diagonal; NaN where a matrix is constant
  Eigen::MatrixXd kendall;   ///< idem
};

/// Rank correlations between the n (n - 1) / 2 entries below the diagonals, for all pairs of matrices.
/// \throws ArgumentError for matrices that are not square, of different sizes or smaller than 2 x 2, or for none;
///   NumericError for distances that are NaN.
[[nodiscard]] RankAgreement rank_agreement(std::span<const Eigen::MatrixXd> distances);

}  // namespace lobe
