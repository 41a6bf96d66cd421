#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "algebra/pointwise.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "hemisphere/cubature.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using std::numbers::pi;

constexpr std::size_t kMostPoints = 400'000;  // of X for a pair; what is not resolved by then is in its error
constexpr double kFinest = 0.01;              // width of the panels next to peaks, radians
constexpr double kRatio = 0.2;                // of successive panels

/// Elevations of X at which panels end: they shrink towards those of L and V, where lobes are, and towards the horizon.
std::vector<PanelEdge> elevation_edges(const Directions& pair) {
  std::vector<PanelEdge> edges{{0, true}, {0.02}, {0.1}, {0.4}, {pi / 2}};
  for (const double peak : {pi / 2 - pair.theta_in, pi / 2 - pair.theta_out}) {
    edges.push_back({peak});
    for (double step = std::min(kFinest, peak); step < pi / 2; step /= kRatio) {
      if (peak + step < pi / 2) edges.push_back({peak + step});
      if (step < 0.8 * peak) edges.push_back({peak - step});
    }
  }
  tidy_edges(edges);
  return edges;
}

/// Azimuths of X from the direction that mirrors L, over a turn; panels shrink towards both peaks.
std::vector<PanelEdge> azimuth_edges(const Directions& pair) {
  const double of_v = std::remainder(pair.delta_phi, 2 * pi);
  std::vector<PanelEdge> edges{{-pi}, {-pi / 2}, {pi / 2}, {pi}};
  const double finest = kFinest / std::max({std::sin(pair.theta_in), std::sin(pair.theta_out), kFinest});
  for (const double peak : {0.0, of_v}) {
    edges.push_back({peak});
    for (double step = finest; step < pi; step /= kRatio) {
      for (const double edge : {peak - step, peak + step}) {
        if (std::abs(edge) < pi) edges.push_back({edge});
      }
    }
  }
  tidy_edges(edges);
  return edges;
}

/// Integrands of pairs: products by channel, then what the functions' own errors make of them.
class PairIntegral {
 public:
  PairIntegral(const BrdfFunction& f, const BrdfFunction& g)
      : f_(f), g_(g), channels_(static_cast<Index>(std::max(f.channels.size(), g.channels.size()))) {}

  [[nodiscard]] Index channels() const { return channels_; }

  /// Integrals over X for one pair.
  [[nodiscard]] CubatureSums at(const Directions& pair, double tolerance) const {
    const auto of_u = elevation_edges(pair);
    const auto of_v = azimuth_edges(pair);
    std::vector<Rectangle> rectangles;
    for (std::size_t i = 0; i + 1 < of_u.size(); ++i) {
      for (std::size_t j = 0; j + 1 < of_v.size(); ++j) {
        rectangles.push_back({{of_u[i], of_u[i + 1]}, {of_v[j], of_v[j + 1]}});
      }
    }
    return integrate_rectangles(
        std::move(rectangles), [&](std::span<const CubaturePoint> points) { return products(pair, points); },
        {.relative = tolerance, .most_points = kMostPoints, .steering = channels_, .has_errors = true});
  }

 private:
  [[nodiscard]] static BrdfValues values(const BrdfFunction& function, std::span<const Directions> pairs) {
    BrdfValues found = function.at(pairs);
    if (!found.value.allFinite()) {
      throw NumericError("'" + function.name + "' has values that are no finite numbers");
    }
    if (found.error.size() == 0) found.error = Eigen::MatrixXd::Zero(found.value.rows(), found.value.cols());
    return found;
  }

  [[nodiscard]] Eigen::MatrixXd products(const Directions& pair, std::span<const CubaturePoint> points) const {
    constexpr double kHighest = pi / 2 - 1e-12;  // functions are defined above the horizon
    std::vector<Directions> to_x;
    std::vector<Directions> from_x;
    for (const auto& [elevation, turn] : points) {
      const double theta = std::clamp(pi / 2 - elevation, 0.0, kHighest);
      const double phi = turn + pi;  // of X from L
      to_x.push_back({pair.theta_in, theta, phi, pair.phi_in});
      from_x.push_back({theta, pair.theta_out, pair.delta_phi - phi, pair.phi_in + phi});
    }
    const BrdfValues f = values(f_, to_x);
    const BrdfValues g = values(g_, from_x);
    Eigen::MatrixXd all(static_cast<Index>(points.size()), 2 * channels_);
    for (Index k = 0; k < all.rows(); ++k) {
      const double elevation = points[static_cast<std::size_t>(k)].u;
      const double weight = std::sin(elevation) * std::cos(elevation);
      for (Index c = 0; c < channels_; ++c) {
        const Index of_f = std::min(c, f.value.cols() - 1);
        const Index of_g = std::min(c, g.value.cols() - 1);
        const double f_error = f.error(k, of_f);
        const double g_error = g.error(k, of_g);
        all(k, c) = weight * f.value(k, of_f) * g.value(k, of_g);
        all(k, channels_ + c) =
            weight * (f_error * std::abs(g.value(k, of_g)) + std::abs(f.value(k, of_f)) * g_error + f_error * g_error);
      }
    }
    return all;
  }

  const BrdfFunction& f_;
  const BrdfFunction& g_;
  Index channels_;
};

std::string degrees_of(const Directions& pair) {
  const auto text = [](double angle) { return shortest(to_degrees(angle)); };
  return "(" + text(pair.theta_in) + ", " + text(pair.theta_out) + ", " + text(pair.delta_phi) + ") degrees";
}

}  // namespace

std::vector<std::vector<Estimate>> composition_at(const BrdfFunction& first, const BrdfFunction& second,
                                                  std::span<const Directions> directions,
                                                  const PointwiseOptions& options) {
  for (const BrdfFunction* function : {&first, &second}) require_no_delta(*function, "expected values alone");
  for (const auto& pair : directions) {
    const auto in_range = [](double theta) { return theta >= 0 && theta < pi / 2; };
    if (in_range(pair.theta_in) && in_range(pair.theta_out) && std::isfinite(pair.delta_phi)) continue;
    throw ArgumentError("directions (theta_in, theta_out, delta_phi) of " + degrees_of(pair) +
                        "; expected theta_in and theta_out in [0, 90) and a finite delta_phi");
  }
  const std::size_t channels = std::max(first.channels.size(), second.channels.size());
  for (const BrdfFunction* function : {&first, &second}) {
    if (function->channels.size() == 1 || function->channels.size() == channels) continue;
    throw ArgumentError("'" + function->name + "' has " + std::to_string(function->channels.size()) +
                        " channels; expected 1 or " + std::to_string(channels));
  }
  const PairIntegral integral(first, second);
  std::vector<std::vector<Estimate>> result(channels, std::vector<Estimate>(directions.size()));
  const auto integrate_at = [&](std::size_t k) {
    const CubatureSums sums = integral.at(directions[k], options.tolerance);
    for (std::size_t c = 0; c < channels; ++c) {
      const auto at = static_cast<Index>(c);
      result[c][k] = {sums.value(at), sums.error(at) + sums.value(at + integral.channels())};
    }
  };
  if (first.is_concurrent && second.is_concurrent) {
    parallel_for(directions.size(), integrate_at);
  } else {
    for (std::size_t k = 0; k < directions.size(); ++k) integrate_at(k);
  }
  for (std::size_t k = 0; k < directions.size() && options.missed; ++k) {
    double worst = 0;
    for (const auto& channel : result) {
      if (channel[k].error <= options.absolute || channel[k].error == 0) continue;
      worst = std::max(worst, channel[k].error / std::abs(channel[k].value));
    }
    if (worst <= options.tolerance) continue;
    options.missed(
        {.quantity = "composition of '" + first.name + "' and '" + second.name + "' at " + degrees_of(directions[k]),
         .index = k,
         .relative_error = worst,
         .tolerance = options.tolerance});
  }
  return result;
}

}  // namespace lobe
