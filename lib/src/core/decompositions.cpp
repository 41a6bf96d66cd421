#include "core/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <string>

#include "lobe/core/error.hpp"

namespace lobe {

Eigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix, bool with_vectors) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      matrix, with_vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) {
    throw NumericError("eigenvalues of a matrix of " + std::to_string(matrix.rows()) + " rows did not converge");
  }
  if (!with_vectors) return {solver.eigenvalues(), {}};
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SingularValues singular_values(const Eigen::MatrixXd& matrix, bool with_vectors) {
  const Eigen::BDCSVD<Eigen::MatrixXd> solver(
      matrix, with_vectors ? static_cast<unsigned>(Eigen::ComputeThinU | Eigen::ComputeThinV) : 0U);
  if (!with_vectors) return {solver.singularValues(), {}, {}};
  return {solver.singularValues(), solver.matrixU(), solver.matrixV()};
}

}  // namespace lobe
