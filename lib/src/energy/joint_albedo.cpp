#include "energy/joint_albedo.hpp"

#include <algorithm>
#include <cmath>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using std::numbers::pi;

/// Limits of panels of the elevation, which shrink towards that of the direction that stays, where lobes are, and
/// towards the horizon, where measured functions end in steep slopes.
std::vector<PanelEdge> elevations(double incident, double width, double lowest) {
  constexpr double kRatio = 0.2;
  std::vector<PanelEdge> edges{{0, true}, {0.02}, {0.1}, {0.4}, {incident}, {pi / 2}};
  for (double step = std::min(width, incident); step < pi / 2; step /= kRatio) {
    if (incident + step < pi / 2) edges.push_back({incident + step});
    if (step < 0.8 * incident) edges.push_back({incident - step});
  }
  tidy_edges(edges);
  return lowest > 0 ? cut_below(lowest, std::move(edges)) : edges;
}

/// Limits of panels of the azimuth from the mirror direction. At normal incidence isotropic functions see none.
std::vector<PanelEdge> azimuths(double incident, double width, bool is_isotropic) {
  constexpr double kRatio = 0.2;
  if (is_isotropic && std::cos(incident) < 1e-6) return {{0}, {pi}};
  std::vector<PanelEdge> edges{{0}, {pi / 2}, {pi}};
  const double finest = 2 * width * std::sin(incident) / std::max(std::cos(incident), 1e-9);
  for (double psi = pi * kRatio; psi > finest; psi *= kRatio) edges.push_back({psi});
  tidy_edges(edges);
  return edges;
}

}  // namespace

JointAlbedo::JointAlbedo(std::span<const BrdfFunction> functions, std::size_t channels, const Options& options)
    : functions_(functions), channels_(channels), options_(options) {
  options_.lobe_width = std::min(options.lobe_width, 1.0);
  is_isotropic_ = std::ranges::all_of(functions, &BrdfFunction::is_isotropic);
  is_bilateral_ = std::ranges::all_of(functions, &BrdfFunction::is_bilateral);
}

JointSums JointAlbedo::at(const Direction& stays, double relative, std::size_t most_points) const {
  const double incident = pi / 2 - stays.theta;
  const auto of_u = elevations(incident, options_.lobe_width, options_.lowest);
  const auto of_v = azimuths(incident, options_.lobe_width, is_isotropic_);
  std::vector<Rectangle> rectangles;
  for (std::size_t i = 0; i + 1 < of_u.size(); ++i) {
    for (std::size_t j = 0; j + 1 < of_v.size(); ++j) {
      rectangles.push_back({{of_u[i], of_u[i + 1]}, {of_v[j], of_v[j + 1]}});
    }
  }
  const auto columns = static_cast<Index>(functions_.size() * channels_);
  const Integrands integrands = [&](std::span<const CubaturePoint> points) { return values(stays, points); };
  const CubatureSums sums =
      integrate_rectangles(std::move(rectangles), integrands,
                           {.relative = relative, .most_points = most_points, .steering = columns, .has_errors = true});
  const Index rest = sums.value.size() - 2 * columns;
  return {sums.value.head(columns), sums.error.head(columns), sums.value.segment(columns, columns),
          sums.value.tail(rest), sums.error.tail(rest)};
}

/// Values times the cosine and the measure of the direction that runs and both halves of its azimuth, then errors the
/// same way, then differences: points x columns.
Eigen::MatrixXd JointAlbedo::values(const Direction& stays, std::span<const CubaturePoint> points) const {
  constexpr double kHighest = pi / 2 - 1e-12;  // functions are defined above the horizon
  const std::size_t signs = is_bilateral_ ? 1 : 2;
  std::vector<Directions> pairs;
  pairs.reserve(signs * points.size());
  for (const auto& [elevation, psi] : points) {
    const double theta = std::clamp(pi / 2 - elevation, 0.0, kHighest);
    for (std::size_t sign = 0; sign < signs; ++sign) {
      const double delta_phi = sign == 0 ? pi - psi : psi - pi;
      if (options_.stays == Stays::light) {
        pairs.push_back({stays.theta, theta, delta_phi, stays.phi});
      } else {
        pairs.push_back({theta, std::min(stays.theta, kHighest), delta_phi, stays.phi - delta_phi});
      }
    }
  }
  const auto count = static_cast<Index>(points.size());
  const auto step = static_cast<Index>(signs);
  Eigen::VectorXd weights(count);
  for (Index k = 0; k < count; ++k) {
    const double elevation = points[static_cast<std::size_t>(k)].u;
    weights(k) = 2 * std::sin(elevation) * std::cos(elevation) / static_cast<double>(signs);
  }
  const std::size_t n = functions_.size();
  const auto columns = static_cast<Index>(n * channels_);
  const auto channels = static_cast<Index>(channels_);
  const Index differences = options_.with_differences ? static_cast<Index>(pairs_among(n)) * channels : 0;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(count, 2 * columns + differences);
  for (std::size_t f = 0; f < n; ++f) {
    const BrdfValues found = functions_[f].at(pairs);
    if (!found.value.allFinite()) {
      throw NumericError("'" + functions_[f].name + "' has values that are no finite numbers");
    }
    const auto weighted = [&](const Eigen::MatrixXd& samples, Index channel) -> Eigen::VectorXd {
      const auto column = samples.col(samples.cols() == 1 ? 0 : channel);
      if (step == 1) return weights.cwiseProduct(column);
      return weights.cwiseProduct(column.reshaped(step, count).colwise().sum().transpose());
    };
    for (Index c = 0; c < channels; ++c) {
      const Index at = static_cast<Index>(f) * channels + c;
      all.col(at) = weighted(found.value, c);
      if (found.error.size() > 0) all.col(columns + at) = weighted(found.error, c);
    }
  }
  if (differences == 0) return all;
  Index at = 2 * columns;
  for (Index i = 0; i < static_cast<Index>(n); ++i) {
    for (Index j = i + 1; j < static_cast<Index>(n); ++j, at += channels) {
      all.middleCols(at, channels) = all.middleCols(i * channels, channels) - all.middleCols(j * channels, channels);
    }
  }
  return all;
}

}  // namespace lobe
