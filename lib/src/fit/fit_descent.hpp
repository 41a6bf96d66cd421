#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>

#include "fit/fit_space.hpp"

namespace lobe {

/// Distances among the target, number 0, and materials.
using DistanceFunction = std::function<Eigen::MatrixXd(std::span<const Material>)>;

struct DescentOptions {
  double step = 1e-3;       ///< of difference quotients, in units of the axes
  double precision = 1e-6;  ///< ends where the next step is below this, in units of the axes
  int most_steps = 40;
  std::function<void(double share)> progress = {};
  /// Told of the first point and of each next.
  std::function<void(const Eigen::VectorXd& x, double distance)> moved = {};
};

/// Where a descent ended.
struct Descent {
  Eigen::VectorXd x;
  double distance = 0;
  Eigen::MatrixXd hessian;  ///< J^T J by the axes' coordinates
  bool converged = false;
  std::size_t evaluations = 0;  ///< materials measured
};

/// Minimises the distance of a family's member from the target over the family's box, by Gauss-Newton steps with
/// Levenberg and Marquardt's damping (Marquardt 1963); axes at bounds that they would leave stand still. Nothing but
/// distances is asked for: with difference quotients J_j = (a - b) / (x_a - x_b) of members a, b, all products come
/// from polarisation, (a - b).(c - d) = (|a-d|^2 + |b-c|^2 - |a-c|^2 - |b-d|^2) / 2, and lose no digits, as distances
/// of neighbours are integrated as such. It holds for every distance |F(f) - F(g)| in a space with a scalar product.
/// \throws what the distances of the first point throw; where those of a later one do (NumericError), it is no
///   candidate.
[[nodiscard]] Descent descend(const FitSpace& space, const DistanceFunction& distances, Eigen::VectorXd start,
                              const DescentOptions& options);

}  // namespace lobe
