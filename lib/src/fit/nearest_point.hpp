#pragma once

#include <Eigen/Core>

namespace lobe {

/// Weights z >= 0 of points p_j for which sum z_j p_j is nearest to a target f, by an active set: Lawson and Hanson
/// 1974 over the cone of the points, or, with `is_hull`, Wolfe 1976 over the convex hull of the points and the origin
/// (sum z
/// <= 1). Points that depend on those in use are passed over, so dependent points do no harm.
/// \param gram p_i . p_j, of points of norm about 1
/// \param products p_j . f, of a target of norm about 1
[[nodiscard]] Eigen::VectorXd nearest_in_cone(const Eigen::MatrixXd& gram, const Eigen::VectorXd& products);
[[nodiscard]] Eigen::VectorXd nearest_in_hull(const Eigen::MatrixXd& gram, const Eigen::VectorXd& products);

}  // namespace lobe
