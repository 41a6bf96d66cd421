#include "fit/fit_descent.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The squared distance around a point, |r - J s|^2 to first order of the residual.
struct Neighbourhood {
  VectorXd x;
  double square = 0;  ///< |r|^2
  MatrixXd hessian;   ///< J^T J
  VectorXd slope;     ///< J^T r
};

/// The box in the axes' coordinates.
struct Box {
  VectorXd lower;
  VectorXd upper;
  VectorXd unit;

  explicit Box(const FitSpace& space) {
    const auto n = static_cast<Index>(space.size());
    lower = upper = unit = VectorXd(n);
    for (Index j = 0; j < n; ++j) {
      const auto at = static_cast<std::size_t>(j);
      lower(j) = space.lower(at);
      upper(j) = space.upper(at);
      unit(j) = space.axis(at).unit;
    }
  }
  [[nodiscard]] VectorXd clamped(const VectorXd& x) const { return x.cwiseMax(lower).cwiseMin(upper); }
};

Neighbourhood look_around(const FitSpace& space, const Box& box, const DistanceFunction& distances, const VectorXd& x,
                          double step, std::size_t& evaluations) {
  constexpr Index kTarget = 0;
  constexpr Index kHere = 1;
  const Index n = x.size();
  std::vector<Material> members{space.material(x)};
  std::vector<std::pair<Index, Index>> pairs;
  VectorXd length(n);
  for (Index j = 0; j < n; ++j) {
    const auto moved_to = [&](double coordinate) {
      VectorXd moved = x;
      moved(j) = coordinate;
      members.push_back(space.material(moved));
      return static_cast<Index>(members.size());  // one more than its index: the target is in front
    };
    const double ahead = std::min(x(j) + step * box.unit(j), box.upper(j));
    const double behind = std::max(x(j) - step * box.unit(j), box.lower(j));
    const Index first = ahead > x(j) ? moved_to(ahead) : kHere;
    const Index second = behind < x(j) ? moved_to(behind) : kHere;
    pairs.emplace_back(first, second);
    length(j) = ahead - behind;
  }
  const MatrixXd square = distances(members).cwiseAbs2();
  evaluations += members.size();
  const auto product = [&](Index a, Index b, Index c, Index d) {
    return 0.5 * (square(a, d) + square(b, c) - square(a, c) - square(b, d));
  };
  Neighbourhood around{x, square(kTarget, kHere), MatrixXd(n, n), VectorXd(n)};
  for (Index j = 0; j < n; ++j) {
    const auto [a, b] = pairs[static_cast<std::size_t>(j)];
    around.slope(j) = product(a, b, kTarget, kHere) / length(j);
    for (Index k = 0; k <= j; ++k) {
      const auto [c, d] = pairs[static_cast<std::size_t>(k)];
      around.hessian(j, k) = around.hessian(k, j) = product(a, b, c, d) / (length(j) * length(k));
    }
  }
  return around;
}

/// The step to the minimum of the damped model; axes that would leave the box, or do nothing, stand still.
VectorXd damped_step(const Neighbourhood& here, const Box& box, double damping) {
  std::vector<Index> free;
  const double largest = here.hessian.diagonal().cwiseProduct(box.unit.cwiseAbs2()).maxCoeff();
  constexpr double kNothing = 1e-14;
  for (Index j = 0; j < here.x.size(); ++j) {
    const bool leaves =
        (here.x(j) <= box.lower(j) && here.slope(j) <= 0) || (here.x(j) >= box.upper(j) && here.slope(j) >= 0);
    if (!leaves && here.hessian(j, j) * box.unit(j) * box.unit(j) > kNothing * largest) free.push_back(j);
  }
  VectorXd step = VectorXd::Zero(here.x.size());
  // An axis that reaches its bound on the way is held there and the others go on without it.
  while (!free.empty()) {
    MatrixXd system = here.hessian(free, free);
    system.diagonal() *= 1 + damping;
    const VectorXd found = system.ldlt().solve(here.slope(free));
    if (!found.allFinite()) return VectorXd::Zero(here.x.size());
    step(free) = found;
    const auto is_stopped = [&](Index j) {
      return (here.x(j) <= box.lower(j) && step(j) < 0) || (here.x(j) >= box.upper(j) && step(j) > 0);
    };
    const auto stopped = std::ranges::find_if(free, is_stopped);
    if (stopped == free.end()) break;
    step(*stopped) = 0;
    free.erase(stopped);
  }
  return box.clamped(here.x + step) - here.x;
}

}  // namespace

Descent descend(const FitSpace& space, const DistanceFunction& distances, VectorXd start,
                const DescentOptions& options) {
  constexpr double kFirstDamping = 1e-3;
  constexpr double kLeastDamping = 1e-12;
  constexpr double kMostDamping = 1e9;
  constexpr double kEasier = 0.1;
  constexpr double kHarder = 8;
  const Box box(space);
  std::size_t evaluations = 0;
  Neighbourhood here = look_around(space, box, distances, box.clamped(start), options.step, evaluations);
  const auto tell = [&] {
    if (options.moved) options.moved(here.x, std::sqrt(here.square));
  };
  tell();
  double damping = kFirstDamping;
  bool converged = false;
  for (int count = 0; count < options.most_steps && !converged; ++count) {
    if (options.progress) options.progress(static_cast<double>(count) / options.most_steps);
    const VectorXd step = damped_step(here, box, damping);
    converged = step.cwiseQuotient(box.unit).cwiseAbs().maxCoeff() <= options.precision;
    if (converged && damping > kFirstDamping) {
      // Short because it is damped: what counts is the step that the model would like.
      converged =
          damped_step(here, box, 0).cwiseQuotient(box.unit).cwiseAbs().maxCoeff() <= std::sqrt(options.precision);
      break;
    }
    std::optional<Neighbourhood> there;
    try {
      there = look_around(space, box, distances, here.x + step, options.step, evaluations);
    } catch (const NumericError&) {
      // Not resolved, or infinite: a shorter step.
    }
    if (there && there->square <= here.square) {
      here = std::move(*there);
      tell();
      damping = std::max(kLeastDamping, damping * kEasier);
    } else {
      damping *= kHarder;
      if (damping > kMostDamping) break;
    }
  }
  return {std::move(here.x), std::sqrt(here.square), std::move(here.hessian), converged, evaluations};
}

}  // namespace lobe
