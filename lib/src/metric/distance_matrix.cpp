#include "metric/distance_matrix.hpp"

#include <cmath>
#include <string>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr double kAsymmetry = 1e-12;  // of the largest distance

void require_not_negative(const Eigen::MatrixXd& matrix, const std::string& what) {
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      if (std::isfinite(matrix(i, j)) && matrix(i, j) >= 0) continue;
      throw NumericError(what + " of materials " + std::to_string(i) + " and " + std::to_string(j) + " is " +
                         std::to_string(matrix(i, j)) + "; expected a finite number of at least 0");
    }
  }
}

}  // namespace

void require_distances(const Eigen::MatrixXd& distance) {
  const Eigen::Index n = distance.rows();
  if (n == 0 || distance.cols() != n) {
    throw ArgumentError("distance matrix is " + std::to_string(n) + " x " + std::to_string(distance.cols()) +
                        "; expected a square one of at least 1 x 1");
  }
  require_not_negative(distance, "distance");
  const double allowed = kAsymmetry * distance.maxCoeff();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j + 1; i < n; ++i) {
      if (std::abs(distance(i, j) - distance(j, i)) <= allowed) continue;
      throw ArgumentError("distance matrix is not symmetric in materials " + std::to_string(j) + " and " +
                          std::to_string(i) + "; expected a symmetric one");
    }
    if (distance(j, j) > allowed) {
      throw ArgumentError("distance of material " + std::to_string(j) + " from itself is not 0; expected 0");
    }
  }
}

void require_distances(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error) {
  require_distances(distance);
  if (distance_error.rows() != distance.rows() || distance_error.cols() != distance.cols()) {
    throw ArgumentError("distances are " + std::to_string(distance.rows()) + " x " + std::to_string(distance.cols()) +
                        " and their errors " + std::to_string(distance_error.rows()) + " x " +
                        std::to_string(distance_error.cols()) + "; expected as many");
  }
  require_not_negative(distance_error, "error of the distance");
}

}  // namespace lobe
