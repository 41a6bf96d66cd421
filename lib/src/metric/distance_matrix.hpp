#pragma once

#include <Eigen/Core>

namespace lobe {

/// What lobe/metric/clustering.hpp asks of a distance matrix.
/// \throws ArgumentError, NumericError as stated there.
void require_distances(const Eigen::MatrixXd& distance);
void require_distances(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error);

}  // namespace lobe
