#pragma once

#include <Eigen/Core>

namespace lobe {

// Eigen's decompositions, compiled in one place: their templates take the compiler longer than all that uses them.

struct Eigenpairs {
  Eigen::VectorXd values;   ///< rising
  Eigen::MatrixXd vectors;  ///< columns; empty where they are not wanted
};

/// Decomposes a symmetric matrix, reading its lower triangle.
/// \throws NumericError where the iteration does not converge.
[[nodiscard]] Eigenpairs symmetric_eigenpairs(const Eigen::MatrixXd& matrix, bool with_vectors = true);

struct SingularValues {
  Eigen::VectorXd values;  ///< falling
  Eigen::MatrixXd left;    ///< columns, as many as values; empty where vectors are not wanted
  Eigen::MatrixXd right;   ///< right singular vectors
};

[[nodiscard]] SingularValues singular_values(const Eigen::MatrixXd& matrix, bool with_vectors = true);

}  // namespace lobe
