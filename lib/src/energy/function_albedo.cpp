#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "hemisphere/cubature.hpp"
#include "hemisphere/kronrod.hpp"
#include "lobe/core/error.hpp"
#include "table/ring_cells.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::RowVectorXd;
using std::numbers::pi;

constexpr double kGoal = 2e-5;                    // error wanted, relative
constexpr std::size_t kMostPoints = 30'000;       // for an albedo; what is not resolved by then is in its error
constexpr double kMeanGoal = 2e-4;                // of means
constexpr std::size_t kMostPointsOfMean = 4'000;  // for each of its albedos
constexpr std::size_t kMostPanels = 12;           // of the elevation of L
constexpr std::size_t kAzimuths = 8;              // of L, in means of anisotropic functions

/// Integrals over the hemisphere of V, by channel.
struct Sums {
  RowVectorXd value;
  RowVectorXd quadrature;  ///< error of the quadrature
  RowVectorXd own;         ///< integral of the function's own error
};

/// Limits of panels of the elevation of V, which shrink towards that of L, where lobes are, and towards the horizon,
/// where measured functions end in steep slopes.
std::vector<PanelEdge> elevations(double incident, double width) {
  constexpr double kRatio = 0.2;
  std::vector<PanelEdge> edges{{0, true}, {0.02}, {0.1}, {0.4}, {incident}, {pi / 2}};
  for (double step = std::min(width, incident); step < pi / 2; step /= kRatio) {
    if (incident + step < pi / 2) edges.push_back({incident + step});
    if (step < 0.8 * incident) edges.push_back({incident - step});
  }
  tidy_edges(edges);
  return edges;
}

/// Limits of panels of the azimuth of V from the mirror direction. At normal incidence isotropic functions see none.
std::vector<PanelEdge> azimuths(double incident, double width, bool is_isotropic) {
  constexpr double kRatio = 0.2;
  if (is_isotropic && std::cos(incident) < 1e-6) return {{0}, {pi}};
  std::vector<PanelEdge> edges{{0}, {pi / 2}, {pi}};
  const double finest = 2 * width * std::sin(incident) / std::max(std::cos(incident), 1e-9);
  for (double psi = pi * kRatio; psi > finest; psi *= kRatio) edges.push_back({psi});
  tidy_edges(edges);
  return edges;
}

/// Albedos of a function. Points are the elevation of V and its azimuth from the mirror direction; both signs of
/// delta_phi count for each, of bilateral functions one for both.
class FunctionAlbedo {
 public:
  FunctionAlbedo(const BrdfFunction& function, double width) : function_(function), width_(std::min(width, 1.0)) {}

  [[nodiscard]] Sums at(const Direction& in, double goal, std::size_t most_points) const {
    const double incident = pi / 2 - in.theta;
    const auto of_u = elevations(incident, width_);
    const auto of_v = azimuths(incident, width_, function_.is_isotropic);
    std::vector<Rectangle> rectangles;
    for (std::size_t i = 0; i + 1 < of_u.size(); ++i) {
      for (std::size_t j = 0; j + 1 < of_v.size(); ++j) {
        rectangles.push_back({{of_u[i], of_u[i + 1]}, {of_v[j], of_v[j + 1]}});
      }
    }
    const auto channels = static_cast<Index>(function_.channels.size());
    const Integrands integrands = [&](std::span<const CubaturePoint> points) { return values(in, points); };
    const CubatureSums sums =
        integrate_rectangles(std::move(rectangles), integrands,
                             {.relative = goal, .most_points = most_points, .steering = channels, .has_errors = true});
    return {sums.value.head(channels), sums.error.head(channels), sums.value.tail(channels)};
  }

 private:
  /// Values times N.V sin(theta_V) and both halves of the azimuth, then errors the same way: points x twice the
  /// channels.
  [[nodiscard]] Eigen::MatrixXd values(const Direction& in, std::span<const CubaturePoint> points) const {
    constexpr double kHighest = pi / 2 - 1e-12;  // functions are defined above the horizon
    const std::size_t signs = function_.is_bilateral ? 1 : 2;
    std::vector<Directions> pairs;
    pairs.reserve(signs * points.size());
    for (const auto& [elevation, psi] : points) {
      const double theta_out = std::clamp(pi / 2 - elevation, 0.0, kHighest);
      pairs.push_back({in.theta, theta_out, pi - psi, in.phi});
      if (signs == 2) pairs.push_back({in.theta, theta_out, psi - pi, in.phi});
    }
    const BrdfValues found = function_.at(pairs);
    if (!found.value.allFinite()) {
      throw NumericError("'" + function_.name + "' has values that are no finite numbers");
    }
    const Index channels = found.value.cols();
    const auto step = static_cast<Index>(signs);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(static_cast<Index>(points.size()), 2 * channels);
    for (Index k = 0; k < all.rows(); ++k) {
      const double elevation = points[static_cast<std::size_t>(k)].u;
      const double weight = 2 * std::sin(elevation) * std::cos(elevation) / static_cast<double>(signs);
      all.row(k).head(channels) = weight * found.value.middleRows(step * k, step).colwise().sum();
      if (found.error.size() > 0) {
        all.row(k).tail(channels) = weight * found.error.middleRows(step * k, step).colwise().sum();
      }
    }
    return all;
  }

  const BrdfFunction& function_;
  double width_;
};

/// At once where the function allows it.
void for_each(const BrdfFunction& function, std::size_t count, const std::function<void(std::size_t)>& work) {
  if (function.is_concurrent) {
    parallel_for(count, work);
  } else {
    for (std::size_t k = 0; k < count; ++k) work(k);
  }
}

/// A panel of the elevation of L and its part of the mean albedo.
struct MeanPanel {
  PanelPart part;
  RowVectorXd value;
  RowVectorXd difference;              ///< of the rules over L, and of what both do not see at the ends
  RowVectorXd square;                  ///< sum of the squared errors of the albedos
  RowVectorXd own;                     ///< of the function's own errors
  std::array<RowVectorXd, 3> albedos;  ///< at both ends and in the middle; empty at the horizon
};

/// Mean over all L: adaptive panels of the elevation. Errors of single albedos have either sign. Azimuths of
/// anisotropic functions begin elsewhere at each elevation; what the odd ones and the even ones differ by counts as
/// error.
class MeanAlbedo {
 public:
  MeanAlbedo(const BrdfFunction& function, double width) : function_(function), albedo_(function, width) {}

  [[nodiscard]] Sums mean() {
    constexpr double kBeside = 0.01;  // of the function's own error: good enough
    constexpr std::array<PanelEdge, 5> kEdges{{{0, true}, {0.16}, {pi / 6}, {pi / 4}, {pi / 2}}};
    std::vector<MeanPanel> waiting;
    for (std::size_t k = 0; k + 1 < kEdges.size(); ++k) waiting.push_back(panel_of({kEdges[k], kEdges[k + 1]}));
    for (std::size_t k = 0; k < waiting.size(); ++k) {
      waiting[k].albedos[1] = at_end(kEdges.at(k + 1).at);
      if (k + 1 < waiting.size()) waiting[k + 1].albedos[0] = waiting[k].albedos[1];
    }
    std::vector<MeanPanel> done;
    for (;;) {
      integrate(waiting);
      done.insert(done.end(), waiting.begin(), waiting.end());
      const Sums sums = summed(done);
      const auto own = sums.own.array();
      const auto allowed = (kMeanGoal * sums.value.array().abs()).eval();
      const auto enough = (own > 0).select(allowed.max(kBeside * own), allowed).eval();
      if ((sums.quadrature.array() <= enough).all() || done.size() >= kMostPanels) return sums;
      waiting = halves_of_worst(done);
      if (waiting.empty()) return sums;
    }
  }

 private:
  [[nodiscard]] MeanPanel panel_of(const PanelPart& part) const {
    const RowVectorXd zero = RowVectorXd::Zero(static_cast<Index>(function_.channels.size()));
    return {part, zero, zero, zero, zero, {}};
  }

  /// The albedo where a panel ends, of any azimuths.
  [[nodiscard]] RowVectorXd at_end(double elevation) const {
    const std::size_t turns = function_.is_isotropic ? 1 : kAzimuths;
    std::vector<RowVectorXd> values(turns);
    for_each(function_, turns, [&](std::size_t k) {
      const double azimuth = 2 * pi * static_cast<double>(k) / static_cast<double>(turns);
      values[k] = albedo_.at({pi / 2 - elevation, azimuth}, kMeanGoal, kMostPointsOfMean).value;
    });
    RowVectorXd mean = RowVectorXd::Zero(values.front().size());
    for (const RowVectorXd& value : values) mean += value / static_cast<double>(turns);
    return mean;
  }

  static Sums summed(const std::vector<MeanPanel>& panels) {
    const RowVectorXd zero = RowVectorXd::Zero(panels.front().value.size());
    Sums sums{zero, zero, zero};
    RowVectorXd square = zero;
    for (const MeanPanel& panel : panels) {
      sums.value += panel.value;
      sums.quadrature += panel.difference;
      sums.own += panel.own;
      square += panel.square;
    }
    sums.quadrature += kDeviations * square.cwiseSqrt();
    return sums;
  }

  /// Takes panels with the larger half of the differences from the list.
  [[nodiscard]] std::vector<MeanPanel> halves_of_worst(std::vector<MeanPanel>& panels) const {
    const auto error = [](const MeanPanel& panel) { return panel.difference.maxCoeff(); };
    std::ranges::sort(panels, std::greater<>(), error);
    double total = 0;
    for (const MeanPanel& panel : panels) total += error(panel);
    std::vector<MeanPanel> halves;
    double taken = 0;
    std::size_t count = 0;
    for (; count < panels.size() && taken < total / 2; ++count) {
      const MeanPanel& whole = panels[count];
      const PanelPart& part = whole.part;
      taken += error(whole);
      const double middle = (part.from + part.to) / 2;
      halves.push_back(panel_of({part.low, part.high, part.from, middle}));
      halves.back().albedos = {whole.albedos[0], whole.albedos[2], {}};
      halves.push_back(panel_of({part.low, part.high, middle, part.to}));
      halves.back().albedos = {whole.albedos[2], whole.albedos[1], {}};
    }
    panels.erase(panels.begin(), panels.begin() + static_cast<std::ptrdiff_t>(count));
    return halves;
  }

  void integrate(std::vector<MeanPanel>& panels) {
    constexpr double kUnsure = 4;  // of the sum of the albedo at an end and those of the nodes with their weights
    const EmbeddedPair& rule = short_pair();
    const std::size_t n = rule.nodes.size();
    const std::size_t turns = function_.is_isotropic ? 1 : kAzimuths;
    std::vector<Sums> parts(panels.size() * n * turns);
    const auto point_of = [&](std::size_t node) {
      const PanelPart& part = panels[node / n].part;
      PanelPoint point = panel_point(part.low, part.high, part.from + (part.to - part.from) * rule.nodes[node % n]);
      point.stretch *= part.to - part.from;
      return point;
    };
    for_each(function_, parts.size(), [&](std::size_t k) {
      constexpr double kGolden = 0.6180339887498949;
      const std::size_t node = k / turns;
      const double start = kGolden * static_cast<double>(nodes_ + node);
      const double azimuth =
          2 * pi * (static_cast<double>(k % turns) + start - std::floor(start)) / static_cast<double>(turns);
      parts[k] = albedo_.at({pi / 2 - point_of(node).at, azimuth}, kMeanGoal, kMostPointsOfMean);
    });
    nodes_ += panels.size() * n;
    for (std::size_t p = 0; p < panels.size(); ++p) {
      MeanPanel& panel = panels[p];
      RowVectorXd coarse = panel.value;
      RowVectorXd null = panel.value;
      // A kink between the end and the first node is seen by no rule: the albedo at the end is not that to which the
      // polynomial through the nodes leads.
      std::array<RowVectorXd, 2> beyond{panel.albedos[0], panel.albedos[1]};
      std::array<double, 2> measure_at_end{};
      RowVectorXd by_azimuth = panel.value;  // what the albedos there are unsure by
      for (std::size_t i = 0; i < n; ++i) {
        const PanelPoint at = point_of(p * n + i);
        const double measure = 2 * at.stretch * std::sin(at.at) * std::cos(at.at);  // over pi: of the mean
        RowVectorXd value = RowVectorXd::Zero(panel.value.size());
        RowVectorXd odd = value;
        for (std::size_t a = 0; a < turns; ++a) {
          const Sums& part = parts[(p * n + i) * turns + a];
          const double share = 1 / static_cast<double>(turns);
          const double weight = measure * rule.weights[i] * share;
          value += share * part.value;
          odd += (a % 2 == 1 ? share : -share) * part.value;
          panel.square += (weight * part.quadrature).cwiseAbs2();
          panel.own += weight * part.own;
        }
        for (std::size_t end = 0; end < 2; ++end) {
          if (i == (end == 0 ? 0 : n - 1)) measure_at_end.at(end) = measure;
          if (beyond.at(end).size() > 0) beyond.at(end) -= rule.end_weights[end == 0 ? i : n - 1 - i] * value;
        }
        if (2 * i + 1 == n) panel.albedos[2] = value;
        by_azimuth = by_azimuth.cwiseMax(odd.cwiseAbs());
        panel.value += measure * rule.weights[i] * value;
        coarse += measure * rule.coarse_weights[i] * value;
        null += measure * rule.null_weights[i] * value;
        if (turns > 1) panel.square += (measure * rule.weights[i] * odd).cwiseAbs2();
      }
      RowVectorXd square = (panel.value - coarse).cwiseAbs2() + null.cwiseAbs2();
      for (std::size_t end = 0; end < 2; ++end) {
        if (beyond.at(end).size() == 0) continue;
        const RowVectorXd sure = (beyond.at(end).cwiseAbs() - (turns > 1 ? kUnsure : 0) * by_azimuth).cwiseMax(0);
        square += (rule.nodes.front() * measure_at_end.at(end) * sure).cwiseAbs2();
      }
      panel.difference = square.cwiseSqrt();
    }
  }

  static constexpr double kDeviations = 2;
  const BrdfFunction& function_;
  FunctionAlbedo albedo_;
  std::size_t nodes_ = 0;  ///< so far, elevations of L
};

std::vector<std::vector<Estimate>> ring_albedos(const BrdfFunction& function, std::span<const Direction> incident) {
  std::vector<std::vector<Estimate>> albedos(function.channels.size());
  for (std::size_t c = 0; c < albedos.size(); ++c) {
    for (const Direction& in : incident) albedos[c].push_back(albedo(*function.ring_cells, c, in.theta));
  }
  return albedos;
}

Estimate estimate(const Sums& sums, std::size_t channel) {
  const auto at = static_cast<Index>(channel);
  return {sums.value(at), sums.quadrature(at) + sums.own(at)};
}

}  // namespace

std::vector<std::vector<Estimate>> albedo(const BrdfFunction& function, std::span<const double> theta_in,
                                          double lobe_width) {
  std::vector<Direction> incident;
  for (const double theta : theta_in) incident.push_back({theta, 0});
  return albedo(function, incident, lobe_width);
}

std::vector<std::vector<Estimate>> albedo(const BrdfFunction& function, std::span<const Direction> incident,
                                          double lobe_width) {
  require_no_delta(function, "expected values alone");
  for (const auto& [theta, phi] : incident) {
    if (theta >= 0 && theta < pi / 2) continue;
    throw ArgumentError("angle of incidence of " + shortest(theta * 180 / pi) +
                        " degrees; expected a value in [0, 90) degrees");
  }
  if (function.ring_cells) return ring_albedos(function, incident);
  const FunctionAlbedo integral(function, lobe_width);
  std::vector<std::vector<Estimate>> result(function.channels.size(), std::vector<Estimate>(incident.size()));
  const auto integrate_at = [&](std::size_t k) {
    const Sums sums = integral.at(incident[k], kGoal, kMostPoints);
    for (std::size_t c = 0; c < result.size(); ++c) result[c][k] = estimate(sums, c);
  };
  for_each(function, incident.size(), integrate_at);
  return result;
}

std::vector<Estimate> mean_albedo(const BrdfFunction& function, double lobe_width) {
  require_no_delta(function, "expected values alone");
  std::vector<Estimate> means;
  if (function.ring_cells) {
    for (std::size_t c = 0; c < function.channels.size(); ++c) means.push_back(mean_albedo(*function.ring_cells, c));
    return means;
  }
  const Sums sums = MeanAlbedo(function, lobe_width).mean();
  for (std::size_t c = 0; c < function.channels.size(); ++c) means.push_back(estimate(sums, c));
  return means;
}

}  // namespace lobe
