#include "lobe/cluster/embedding.hpp"

#include <string>

#include "core/decompositions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {

Embedding classical_scaling(const Eigen::MatrixXd& distance, int dimensions) {
  const Eigen::Index n = distance.rows();
  if (distance.cols() != n) {
    throw ArgumentError("distance matrix is " + std::to_string(n) + " x " + std::to_string(distance.cols()) +
                        "; expected a square one");
  }
  if (dimensions < 1 || n < dimensions) {
    throw ArgumentError(std::to_string(n) + " points in " + std::to_string(dimensions) +
                        " dimensions; expected at least as many points as dimensions");
  }
  const Eigen::MatrixXd squared = distance.cwiseProduct(distance);
  const Eigen::VectorXd row_mean = squared.rowwise().mean();
  Eigen::MatrixXd centred = squared;
  centred.colwise() -= row_mean;
  centred.rowwise() -= row_mean.transpose();
  centred.array() += row_mean.mean();
  const Eigenpairs eigen = symmetric_eigenpairs(-0.5 * centred);

  Embedding embedding;
  embedding.eigenvalues = eigen.values.reverse();
  embedding.coordinates.resize(n, dimensions);
  double kept = 0;
  for (Eigen::Index axis = 0; axis < dimensions; ++axis) {
    const double eigenvalue = std::max(0.0, embedding.eigenvalues(axis));
    Eigen::VectorXd column = eigen.vectors.col(n - 1 - axis) * std::sqrt(eigenvalue);
    Eigen::Index largest = 0;
    column.cwiseAbs().maxCoeff(&largest);
    if (column(largest) < 0) column = -column;
    embedding.coordinates.col(axis) = column;
    kept += eigenvalue;
  }
  const double total = embedding.eigenvalues.cwiseMax(0.0).sum();
  embedding.explained_share = total > 0 ? kept / total : 1.0;
  return embedding;
}

}  // namespace lobe
