#pragma once

#include <Eigen/Core>

namespace lobe {

/// Checks that a distance matrix satisfies the conditions in lobe/metric/clustering.hpp.
/// \throws ArgumentError, NumericError as stated there.
void require_distances(const Eigen::MatrixXd& distance);
void require_distances(const Eigen::MatrixXd& distance, const Eigen::MatrixXd& distance_error);

}  // namespace lobe
