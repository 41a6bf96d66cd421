#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace [[gnu::visibility("default")]] lobe {

/// Spearman's rho of two series: the linear correlation of their ranks, with equal values sharing their mean rank. NaN
/// if a series is constant. O(n log n).
/// \throws ArgumentError for empty series or different lengths; NumericError for values that are NaN
[[nodiscard]] double spearman(std::span<const double> a, std::span<const double> b);

/// Kendall's tau-b of two series (Kendall 1945): (concordant - discordant) / sqrt((p - ties in a) (p - ties in b)) of
/// the p = n (n - 1) / 2 pairs. NaN where a series is constant. O(n log n) (Knight 1966).
/// \throws as spearman()
[[nodiscard]] double kendall(std::span<const double> a, std::span<const double> b);

/// Agreement of several metrics in ranking the pairs of materials by distance.
struct RankAgreement {
  Eigen::MatrixXd spearman;  ///< metrics x metrics, symmetric, 1 on the diagonal; NaN where a matrix is constant
  Eigen::MatrixXd kendall;   ///< metrics x metrics, symmetric, 1 on the diagonal; NaN where a matrix is constant
};

/// Computes rank correlations between the n (n - 1) / 2 entries below the diagonals, for all pairs of matrices.
/// \throws ArgumentError for no matrices, matrices that are not square, of different sizes or smaller than 2 x 2;
///   NumericError for distances that are NaN
[[nodiscard]] RankAgreement rank_agreement(std::span<const Eigen::MatrixXd> distances);

/// Computes rank correlations over the pairs within groups of materials: the mean over groups of three or more,
/// weighted by their numbers of pairs. Groups in which a matrix is constant are left out. NaN if no group is left.
/// \param group group of each material
/// \throws ArgumentError also if the number of groups differs
[[nodiscard]] RankAgreement rank_agreement_within(std::span<const Eigen::MatrixXd> distances,
                                                  std::span<const std::string> group);

}  // namespace lobe
