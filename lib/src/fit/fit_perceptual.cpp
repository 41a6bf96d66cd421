#include "fit/fit_perceptual.hpp"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <numbers>
#include <type_traits>
#include <utility>

#include "energy/albedo.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/evaluate.hpp"
#include "model/values.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kAlbedoSearchTolerance = 1e-4;  // of albedos

/// Polar coordinates of a direction.
Direction direction_of(const Eigen::Vector3d& x) {
  return {std::atan2(std::hypot(x.x(), x.y()), x.z()), std::atan2(x.y(), x.x())};
}

std::vector<double> azimuths(bool is_isotropic) {
  if (is_isotropic) return {0};
  return {0, 45 * kDegree, 90 * kDegree, 135 * kDegree};
}

struct OptimizerEnd {
  void operator()(nlopt_opt optimizer) const { nlopt_destroy(optimizer); }
};
using Optimizer = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, OptimizerEnd>;

/// Data shared by NLopt's callbacks: unknowns are the coordinates in units of their axes, and t.
struct Problem {
  const FitSpace& space;
  const PerceptualErrorsOf& errors;
  const std::function<void()>& progress;
  VectorXd unit;
  nlopt_opt optimizer = nullptr;
  std::exception_ptr failure = nullptr;
  std::size_t evaluations = 0;
  Index count = 0;     ///< of errors
  VectorXd best = {};  ///< coordinates
  double largest = std::numeric_limits<double>::infinity();

  [[nodiscard]] VectorXd coordinates(const double* unknowns) const {
    return Eigen::Map<const VectorXd>(unknowns, unit.size()).cwiseProduct(unit);
  }

  VectorXd errors_at(const VectorXd& x) {
    progress();
    ++evaluations;
    VectorXd found = errors.at(space.material(x), kAlbedoSearchTolerance);
    const double worst = found.cwiseAbs().maxCoeff();
    if (worst < largest) {
      largest = worst;
      best = x;
    }
    return found;
  }
};

double bound(unsigned n, const double* unknowns, double*, void*) {
  return unknowns[n - 1];
}

void constraints(unsigned m, double* result, unsigned n, const double* unknowns, double*, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  Eigen::Map<VectorXd> values(result, m);
  if (problem.failure) return values.setZero(), void();
  try {
    const VectorXd errors = problem.errors_at(problem.coordinates(unknowns));
    values.head(problem.count) = errors.array() - unknowns[n - 1];
    values.tail(problem.count) = -errors.array() - unknowns[n - 1];
  } catch (...) {
    // No exception may pass through C.
    problem.failure = std::current_exception();
    values.setZero();
    nlopt_force_stop(problem.optimizer);
  }
}

/// \param reach length of the first steps, in units of the axes
bool run_cobyla(Problem& problem, double reach) {
  constexpr double kPrecision = 1e-7;
  constexpr int kMostEvaluations = 1500;
  const auto n = static_cast<unsigned>(problem.unit.size()) + 1;
  const Optimizer optimizer(nlopt_create(NLOPT_LN_COBYLA, n));
  if (!optimizer) throw NumericError("NLopt has no memory for the search");
  problem.optimizer = optimizer.get();
  std::vector<double> unknowns(n);
  std::vector<double> lower(n);
  std::vector<double> upper(n);
  for (unsigned j = 0; j + 1 < n; ++j) {
    const auto at = static_cast<Index>(j);
    unknowns[j] = problem.best(at) / problem.unit(at);
    lower[j] = problem.space.lower(j) / problem.unit(at);
    upper[j] = problem.space.upper(j) / problem.unit(at);
  }
  unknowns.back() = problem.largest;
  lower.back() = 0;
  upper.back() = std::numeric_limits<double>::infinity();
  std::vector<double> steps(n, reach);
  steps.back() = std::max(reach * problem.largest, kPrecision);
  for (unsigned j = 0; j + 1 < n; ++j) steps[j] = std::min(reach, 0.25 * (upper[j] - lower[j]));
  const std::vector<double> tolerances(2 * static_cast<std::size_t>(problem.count), kPrecision);

  nlopt_set_min_objective(optimizer.get(), bound, nullptr);
  nlopt_set_lower_bounds(optimizer.get(), lower.data());
  nlopt_set_upper_bounds(optimizer.get(), upper.data());
  nlopt_set_initial_step(optimizer.get(), steps.data());
  nlopt_add_inequality_mconstraint(optimizer.get(), 2 * static_cast<unsigned>(problem.count), constraints, &problem,
                                   tolerances.data());
  const std::vector<double> precision(n, kPrecision);
  nlopt_set_xtol_abs(optimizer.get(), precision.data());
  nlopt_set_maxeval(optimizer.get(), kMostEvaluations);
  double least = 0;
  const nlopt_result result = nlopt_optimize(optimizer.get(), unknowns.data(), &least);
  problem.optimizer = nullptr;
  if (problem.failure) std::rethrow_exception(problem.failure);
  return result > 0 && result != NLOPT_MAXEVAL_REACHED;
}

}  // namespace

std::vector<Directions> perceptual_directions(bool is_isotropic) {
  constexpr int kHalfAngles = 30;
  constexpr double kLargest = 80 * kDegree;
  std::vector<Directions> list;
  for (const double phi : azimuths(is_isotropic)) {
    for (int k = 0; k < kHalfAngles; ++k) {
      const double share = static_cast<double>(k) / kHalfAngles;
      const double theta_h = 90 * kDegree * share * share;
      for (int d = 0; d <= 5; ++d) {
        const double theta_d = 15 * kDegree * d;
        for (int p = 0; p < 4; ++p) {
          // At theta_h = 0 or theta_d = 0 the azimuth makes no difference.
          if (p > 0 && (k == 0 || d == 0)) continue;
          const double phi_d = 45 * kDegree * p;
          // The difference direction about the z axis, then turned by theta_h towards x.
          const Eigen::Vector3d difference(std::sin(theta_d) * std::cos(phi_d), std::sin(theta_d) * std::sin(phi_d),
                                           std::cos(theta_d));
          const auto turned = [&](double sign) {
            const double x = sign * difference.x();
            const double z = difference.z();
            return direction_of({std::cos(theta_h) * x + std::sin(theta_h) * z, sign * difference.y(),
                                 std::cos(theta_h) * z - std::sin(theta_h) * x});
          };
          const Direction in = turned(1);
          const Direction out = turned(-1);
          if (in.theta > kLargest || out.theta > kLargest) continue;
          const double delta_phi = std::remainder(out.phi - in.phi, 2 * std::numbers::pi);
          list.push_back({in.theta, out.theta, delta_phi, phi});
        }
      }
    }
  }
  return list;
}

std::vector<Direction> perceptual_incidence(bool is_isotropic) {
  std::vector<Direction> list;
  for (const double phi : azimuths(is_isotropic)) {
    for (const double degrees : {0, 15, 30, 45, 60, 75, 80}) list.push_back({degrees * kDegree, phi});
  }
  return list;
}

PerceptualErrorsOf::PerceptualErrorsOf(const Device& device, const FitTarget& target, bool is_isotropic,
                                       const FitOptions& options)
    : device_(device),
      precision_(options.precision),
      radiance_floor_(options.radiance_floor),
      albedo_floor_(options.albedo_floor),
      directions_(perceptual_directions(is_isotropic)),
      incidence_(perceptual_incidence(is_isotropic)),
      radiance_(target.values(directions_)),
      albedo_(target.albedos(incidence_)) {
  for (auto& channel : radiance_) {
    for (std::size_t i = 0; i < channel.size(); ++i) {
      const double cosine = std::cos(directions_[i].theta_in);
      channel[i] = {channel[i].value * cosine, channel[i].error * cosine};
    }
  }
}

Eigen::VectorXd PerceptualErrorsOf::at(const Material& member, double albedo_tolerance) const {
  const Eigen::MatrixXd values = unchecked_values(device_, member, directions_, precision_);
  const auto albedos = albedo(device_, member, incidence_, {.tolerance = albedo_tolerance, .precision = precision_});
  VectorXd errors(static_cast<Index>(radiance_.size() * (directions_.size() + incidence_.size())));
  Index row = 0;
  for (std::size_t c = 0; c < radiance_.size(); ++c) {
    const std::size_t own = albedos.size() == 1 ? 0 : c;
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const double f = radiance_[c][i].value;
      const double g = values(static_cast<Index>(i), static_cast<Index>(own)) * std::cos(directions_[i].theta_in);
      errors(row++) = (g - f) / std::max(f, radiance_floor_);
    }
    for (std::size_t i = 0; i < incidence_.size(); ++i) {
      const double f = albedo_[c][i].value;
      errors(row++) = (albedos[own][i].value - f) / std::max(f, albedo_floor_);
    }
  }
  return errors;
}

Estimate PerceptualErrorsOf::error_of(const Estimate& target, const Estimate& member, double floor) const {
  const double size = std::max(target.value, floor);
  const double value = std::abs(member.value - target.value) / size;
  const double below = target.value > floor ? value * target.error / size : 0;
  return {value, (target.error + member.error) / size + below};
}

PerceptualErrors PerceptualErrorsOf::largest(const Material& member) const {
  const Eigen::MatrixXd values = unchecked_values(device_, member, directions_, precision_);
  const auto albedos = albedo(device_, member, incidence_, {.precision = precision_});
  PerceptualErrors errors;
  const auto take = [](LargestError& largest, const Estimate& error, const Directions& directions, std::size_t c) {
    if (error.value >= largest.value.value) largest = {error, directions, c};
  };
  for (std::size_t c = 0; c < radiance_.size(); ++c) {
    const std::size_t own = albedos.size() == 1 ? 0 : c;
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const double g = values(static_cast<Index>(i), static_cast<Index>(own)) * std::cos(directions_[i].theta_in);
      take(errors.radiance, error_of(radiance_[c][i], {g, 0}, radiance_floor_), directions_[i], c);
    }
    for (std::size_t i = 0; i < incidence_.size(); ++i) {
      take(errors.albedo, error_of(albedo_[c][i], albedos[own][i], albedo_floor_),
           {incidence_[i].theta, 0, 0, incidence_[i].phi}, c);
    }
  }
  return errors;
}

MinimaxFit least_largest_error(const FitSpace& space, const PerceptualErrorsOf& errors, const VectorXd& start,
                               const std::function<void()>& progress) {
  constexpr double kFirstReach = 0.2;
  constexpr double kNextReach = 0.02;
  constexpr double kNoGain = 1e-5;
  constexpr int kMostRuns = 5;
  VectorXd unit(start.size());
  for (Index j = 0; j < unit.size(); ++j) unit(j) = space.axis(static_cast<std::size_t>(j)).unit;
  Problem problem{.space = space, .errors = errors, .progress = progress, .unit = std::move(unit)};
  problem.count = problem.errors_at(start).size();
  bool converged = false;
  for (int run = 0; run < kMostRuns; ++run) {
    const double before = problem.largest;
    converged = run_cobyla(problem, run == 0 ? kFirstReach : kNextReach);
    if (run > 0 && before - problem.largest <= kNoGain * before) break;
  }
  return {std::move(problem.best), problem.largest, converged, problem.evaluations};
}

}  // namespace lobe
