#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace [[gnu::visibility("default")]] lobe {

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

/// The same by pairs within groups of materials: the mean over groups of three or more, each with the weight of its
/// number of pairs, a group in which a matrix is constant left out. NaN where no group is left.
/// \param group the group of each material
/// \throws ArgumentError also for another number of groups
[[nodiscard]] RankAgreement rank_agreement_within(std::span<const Eigen::MatrixXd> distances,
                                                  std::span<const std::string> group);

}  // namespace lobe
