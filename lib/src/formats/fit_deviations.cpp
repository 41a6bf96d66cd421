// Effect of a target's noise on the values of a fit, to first order.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "fit/fit_space.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measurement.hpp"
#include "metric/channel_metric.hpp"
#include "metric/routes.hpp"
#include "table/as_function.hpp"

namespace lobe {
namespace {

using Eigen::Index;

/// A member of the family with a derivative of it: the fit itself has none.
struct Derivative {
  std::size_t axis = 0;
  BrdfFunction above;  ///< the fit, moved along the axis
  BrdfFunction below;
  double length = 0;  ///< length of the way between, in values of the axis
};

void check(const BrdfFunction& target, const FitResult& result, const FitOptions& options) {
  if (target.replicates < 2) {
    throw ArgumentError("'" + target.name + "' has no replicates; expected some to follow deviations by");
  }
  if (result.objective != FitObjective::l2 || takes_tables(options.lighting)) {
    throw ArgumentError("deviations of a fit by '" + std::string(to_string(result.objective)) + "' under lighting '" +
                        options.lighting.name() +
                        "'; expected the objective l2 and point, daylight or mean-albedo light");
  }
}

/// The values of a fit as a point of the space; scales are their own coordinates.
Eigen::VectorXd point_of(const FitSpace& space, const FitResult& result) {
  Eigen::VectorXd x(static_cast<Index>(space.size()));
  for (std::size_t j = 0; j < space.size(); ++j) {
    x(static_cast<Index>(j)) = space.axis(j).scale.coordinate(result.values[j].value);
  }
  return x;
}

}  // namespace

std::vector<double> fit_deviations(const Device& device, const BrdfFunction& target, const Family& family,
                                   const FitResult& result, const FitOptions& options) {
  check(target, result, options);
  const std::size_t own = own_channels(target);
  const FitSpace space(family, own, options.ranges);
  const Eigen::VectorXd x = point_of(space, result);
  std::vector<Derivative> directions;
  for (std::size_t j = 0; j < space.size(); ++j) {
    if (result.values[j].at_bound) continue;
    const auto at = static_cast<Index>(j);
    const auto& axis = space.axis(j);
    // Wide enough for products that are refined to a percent or so, and within the bounds.
    constexpr double kStep = 0.03;
    const double step = axis.is_scale ? std::max(0.1 * std::abs(x(at)), 1e-3) : kStep * axis.unit;
    Eigen::VectorXd above = x;
    Eigen::VectorXd below = x;
    above(at) = std::min(x(at) + step, space.upper(j));
    below(at) = std::max(x(at) - step, space.lower(j));
    directions.push_back({j, as_function(device, space.material(above)), as_function(device, space.material(below)),
                          space.value(j, above(at)) - space.value(j, below(at))});
  }
  std::vector<BrdfFunction> functions{target};
  for (const Derivative& direction : directions) {
    functions.push_back(direction.above);
    functions.push_back(direction.below);
  }
  constexpr double kTolerance = 0.05;
  const MetricResult products =
      measure_functions(aligned_replicates(functions), options.lighting,
                        {.tolerance = kTolerance, .theta_max = options.theta_max, .progress = options.progress});

  // J^T J and J^T f of every copy, over channels.
  const std::vector<double> weights = channel_weights(options.channel_weights, own);
  const auto n = static_cast<Index>(directions.size());
  const auto copies = static_cast<Index>(target.replicates);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd projections = Eigen::MatrixXd::Zero(n, copies);
  const auto row_of = [](Index direction, bool is_above) { return 1 + 2 * direction + (is_above ? 0 : 1); };
  for (std::size_t c = 0; c < own; ++c) {
    const Eigen::MatrixXd& gram = products.channels[c].gram;
    for (Index a = 0; a < n; ++a) {
      const double length = directions[static_cast<std::size_t>(a)].length;
      for (Index b = 0; b < n; ++b) {
        const double difference = gram(row_of(a, true), row_of(b, true)) - gram(row_of(a, true), row_of(b, false)) -
                                  gram(row_of(a, false), row_of(b, true)) + gram(row_of(a, false), row_of(b, false));
        hessian(a, b) += weights[c] * difference / (length * directions[static_cast<std::size_t>(b)].length);
      }
      for (Index k = 0; k < copies; ++k) {
        const auto& copy = products.channels[(static_cast<std::size_t>(k) + 1) * own + c].gram;
        projections(a, k) += weights[c] * (copy(0, row_of(a, true)) - copy(0, row_of(a, false))) / length;
      }
    }
  }
  const Eigen::VectorXd scale = hessian.diagonal().cwiseMax(0).cwiseSqrt();
  std::vector<double> deviations(result.values.size(), 0.0);
  if (n == 0) return deviations;
  for (const Derivative& direction : directions) {
    deviations[direction.axis] = std::numeric_limits<double>::infinity();
  }
  if (scale.minCoeff() <= 0) return deviations;
  // In units in which the diagonal is 1.
  const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * hessian * scale.cwiseInverse().asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> solver(scaled);
  constexpr double kSingular = 1e-8;
  if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() < kSingular) return deviations;
  const Eigen::MatrixXd moves =
      scale.cwiseInverse().asDiagonal() * solver.solve(scale.cwiseInverse().asDiagonal() * projections);
  for (Index a = 0; a < n; ++a) {
    const Eigen::VectorXd row = moves.row(a).transpose();
    const double mean = row.mean();
    deviations[directions[static_cast<std::size_t>(a)].axis] =
        std::sqrt((row.array() - mean).square().sum() / static_cast<double>(copies - 1));
  }
  return deviations;
}

}  // namespace lobe
