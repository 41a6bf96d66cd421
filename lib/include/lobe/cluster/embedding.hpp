#pragma once

#include <Eigen/Core>

namespace [[gnu::visibility("default")]] lobe {

/// Points whose Euclidean distances approximate a distance matrix.
struct Embedding {
  Eigen::MatrixXd coordinates;  ///< n x dimensions, columns by falling eigenvalue
  Eigen::VectorXd eigenvalues;  ///< all n eigenvalues, falling
  double explained_share = 0;   ///< sum of the kept eigenvalues over the sum of the positive ones, in [0, 1]
};

/// Embeds distances by classical multidimensional scaling (Torgerson 1952): eigenvectors of -1/2 J D^2 J. The sign of
/// each axis is fixed by making its largest coordinate positive.
/// \throws ArgumentError for a matrix that is not square or fewer points than dimensions
[[nodiscard]] Embedding classical_scaling(const Eigen::MatrixXd& distance, int dimensions = 2);

}  // namespace lobe
