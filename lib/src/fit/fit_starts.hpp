#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "fit/fit_space.hpp"
#include "fit/fit_target.hpp"

namespace lobe {

/// A point of a family, and its distance from the target relative to the target's norm.
struct FitStart {
  Eigen::VectorXd x;
  double relative_residual = 0;
};

/// Starting points, best first, none near a better one.
struct FitStarts {
  std::vector<FitStart> best;
  std::size_t compared = 0;     ///< how many were compared
  std::size_t evaluations = 0;  ///< materials measured for that
  Eigen::VectorXd unit;         ///< for every scale what makes its term as large as the target
};

/// Compares points that fill the family's box of parameters, or those given, by scalar products alone: every term in
/// some shapes, all combinations of these from one Gram matrix, with the best scales >= 0 of each combination. Shapes
/// are Halton's points; of a single parameter equal steps.
/// \param given values of all parameters by label, as FitOptions::starts
/// \param count how many of the best are wanted
/// \throws NumericError for a target of norm 0, and where no shape can be held against it; as FitTarget::rough_products
[[nodiscard]] FitStarts find_starts(const FitTarget& target, const FitSpace& space,
                                    std::span<const std::vector<NamedValue>> given, std::span<const double> weights,
                                    std::size_t count, double tolerance);

}  // namespace lobe
