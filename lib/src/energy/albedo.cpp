#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/text.hpp"
#include "energy/adaptive_albedo.hpp"
#include "energy/albedo.hpp"
#include "energy/material_albedo.hpp"
#include "hemisphere/kronrod.hpp"
#include "hemisphere/refinement.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

std::string degrees(double radians) {
  return shortest(to_degrees(radians)) + " degrees";
}

[[noreturn]] void refuse_not_finite(const std::string& what, const Material& material) {
  throw NumericError(what + " of '" + material.name + "' is no finite number");
}

/// Tells `options.missed` where an outcome misses the tolerance.
/// \throws NumericError where not even its size is known: it may be infinite
void tell_missed(const AlbedoOutcome& outcome, MissedTolerance missed, const Material& material,
                 const AlbedoOptions& options) {
  missed.quantity += " of '" + material.name + "'";
  missed.relative_error = outcome.worst;
  missed.tolerance = options.tolerance;
  if (outcome.is_divergent) throw NumericError(to_string(missed) + " and does not converge: it may be infinite");
  if (options.missed) options.missed(missed);
}

/// Whether refinement changes values by as much as ever, as that of infinite integrals does; what is below a hundredth
/// is the accident of a level.
/// \param levels the values of all levels of refinement
bool is_divergent(const std::vector<Eigen::ArrayXd>& levels) {
  constexpr std::size_t kLooked = 4;  // changes
  constexpr double kDecay = 0.9;      // of a change and the next, at least; of a root at an end 0.7 and less
  constexpr double kSmall = 0.01;     // relative
  if (levels.size() <= kLooked) return false;
  std::vector<Eigen::ArrayXd> changes;
  for (std::size_t k = levels.size() - kLooked; k < levels.size(); ++k) {
    changes.push_back((levels[k] - levels[k - 1]).abs());
  }
  const double decay = std::pow(kDecay, static_cast<double>(kLooked - 1));
  return (changes.back() > kSmall * levels.back().abs() && changes.back() > decay * changes.front()).any();
}

/// Values of all channels, to the tolerance or as near as the last level comes.
/// \param missed what is told of these
/// \param most levels of refinement
/// \throws NumericError where they do not converge.
std::vector<Estimate> reached(const std::function<Eigen::ArrayXd(int)>& at_level, MissedTolerance missed,
                              const Material& material, double floor, int most, const AlbedoOptions& options) {
  std::vector<Eigen::ArrayXd> levels;
  const auto noting = [&](int level) { return levels.emplace_back(at_level(level)); };
  const std::string what = missed.quantity;
  Refined result = refine(noting, what, material, floor, options.tolerance, most);
  if (result.is_reached) return std::move(result.values);
  missed.quantity += " of '" + material.name + "'";
  missed.relative_error = result.worst;
  missed.tolerance = options.tolerance;
  if (is_divergent(levels)) throw NumericError(to_string(missed) + " and does not converge: it may be infinite");
  if (options.missed) options.missed(missed);
  return std::move(result.values);
}

/// A panel of the elevation of L and its part of a mean.
struct MeanPanel {
  PanelEdge low, high;
  Eigen::ArrayXd value, difference, error, magnitude;
};

/// Mean albedo of isotropic lobes: adaptive panels of the elevation of L over adaptive albedos.
class AdaptiveMean {
 public:
  AdaptiveMean(AdaptiveAlbedo& integral, double goal) : integral_(integral), goal_(goal) {}

  /// One column.
  AlbedoValues result() {
    std::vector<MeanPanel> waiting;
    const auto& edges = integral_.rule().edges();
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) waiting.push_back({edges[k], edges[k + 1], {}, {}, {}, {}});
    std::vector<MeanPanel> done;
    for (;;) {
      integrate(waiting);
      done.insert(done.end(), waiting.begin(), waiting.end());
      AlbedoValues sums{done.front().value, done.front().difference + done.front().error, done.front().magnitude,
                        Eigen::Array<bool, 1, 1>(is_exhausted_)};
      for (std::size_t k = 1; k < done.size(); ++k) {
        sums.value += done[k].value;
        sums.error += done[k].difference + done[k].error;
        sums.magnitude += done[k].magnitude;
      }
      waiting = halves_of_worst(done, sums);
      if (waiting.empty() || !sums.value.isFinite().all()) return sums;
    }
  }

 private:
  /// Takes the panels with more than their share of the allowed error from the list.
  std::vector<MeanPanel> halves_of_worst(std::vector<MeanPanel>& panels, const AlbedoValues& sums) const {
    constexpr double kShare = 0.5;  // of the error, for the rule over L
    constexpr std::size_t kMostPanels = 60;
    const Eigen::ArrayXd allowed = kShare * goal_ * sums.value.col(0).abs();
    Eigen::ArrayXd total = Eigen::ArrayXd::Zero(allowed.size());
    for (const MeanPanel& panel : panels) total += panel.difference;
    if ((total <= allowed).all() || panels.size() > kMostPanels || is_exhausted_) return {};
    std::vector<MeanPanel> halves;
    std::vector<MeanPanel> kept;
    for (const MeanPanel& panel : panels) {
      const bool is_accurate = (panel.difference <= allowed / static_cast<double>(panels.size())).all();
      if (is_accurate) {
        kept.push_back(panel);
        continue;
      }
      const PanelEdge middle{(panel.low.at + panel.high.at) / 2};
      halves.push_back({panel.low, middle, {}, {}, {}, {}});
      halves.push_back({middle, panel.high, {}, {}, {}, {}});
    }
    panels = std::move(kept);
    return halves;
  }

  void integrate(std::vector<MeanPanel>& panels) {
    constexpr std::size_t kMostNodesOfMean = 200'000;
    constexpr double kInner = 0.3;  // of the goal, for the albedos
    constexpr double kSafety = 2;   // as of albedos
    const EmbeddedPair& rule = middle_pair();
    const std::size_t n = rule.nodes.size();
    std::vector<IncidentNode> incident;
    for (const MeanPanel& panel : panels) {
      for (const double x : rule.nodes) {
        const PanelPoint at = panel_point(panel.low, panel.high, x);
        incident.push_back({at.at, 2 * at.stretch * std::sin(at.at) * std::cos(at.at), 0});
      }
    }
    const AlbedoValues albedos = integral_.at(incident, kInner * goal_, kMostNodesOfMean);
    is_exhausted_ = is_exhausted_ || albedos.is_exhausted.any();
    for (std::size_t p = 0; p < panels.size(); ++p) {
      MeanPanel& panel = panels[p];
      panel.value = panel.error = panel.magnitude = Eigen::ArrayXd::Zero(albedos.value.rows());
      Eigen::ArrayXd coarse = panel.value;
      Eigen::ArrayXd null = panel.value;
      for (std::size_t k = 0; k < n; ++k) {
        const auto column = static_cast<Eigen::Index>(p * n + k);
        const double measure = incident[p * n + k].weight;
        panel.value += measure * rule.weights[k] * albedos.value.col(column);
        coarse += measure * rule.coarse_weights[k] * albedos.value.col(column);
        null += measure * rule.null_weights[k] * albedos.value.col(column);
        panel.error += measure * rule.weights[k] * albedos.error.col(column);
        panel.magnitude += measure * rule.weights[k] * albedos.magnitude.col(column);
      }
      panel.difference = kSafety * joint_difference(panel.value - coarse, null);
    }
  }

  AdaptiveAlbedo& integral_;
  double goal_;
  bool is_exhausted_ = false;
};

}  // namespace

std::vector<std::vector<Estimate>> albedo(const Device& device, const Material& material,
                                          std::span<const double> theta_in, const AlbedoOptions& options) {
  std::vector<Direction> incident;
  for (const double theta : theta_in) incident.push_back({theta, 0});
  return albedo(device, material, incident, options);
}

std::vector<std::vector<Estimate>> albedo(const Device& device, const Material& material,
                                          std::span<const Direction> directions, const AlbedoOptions& options) {
  for (const auto& [theta, phi] : directions) {
    if (!(theta >= 0 && theta < std::numbers::pi / 2)) {
      throw ArgumentError("angle of incidence of " + degrees(theta) + "; expected a value in [0, 90) degrees");
    }
    if (!std::isfinite(phi)) throw ArgumentError("azimuth of incidence is no finite number");
  }
  std::vector<std::vector<Estimate>> result(material.channels(), std::vector<Estimate>(directions.size()));
  if (directions.empty()) return result;

  constexpr std::size_t kMostNodes = 1'000'000;  // per direction
  AdaptiveAlbedo integral(device, material, options.precision);
  std::vector<IncidentNode> incident;
  for (const auto& [theta, phi] : directions) incident.push_back({std::numbers::pi / 2 - theta, 1, phi});
  const auto outcomes = integral.within(incident, options.tolerance, kMostNodes);
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const AlbedoOutcome& outcome = outcomes[k];
    const std::string what = "albedo at " + degrees(directions[k].theta);
    if (!outcome.is_finite) refuse_not_finite(what, material);
    for (std::size_t c = 0; c < result.size(); ++c) result[c][k] = outcome.values[c];
    if (!outcome.is_reached) tell_missed(outcome, {.quantity = what, .index = k}, material, options);
  }
  return result;
}

std::vector<Estimate> mean_albedo(const Device& device, const Material& material, const AlbedoOptions& options) {
  AdaptiveAlbedo adaptive(device, material, options.precision);
  if (adaptive.is_isotropic()) {
    const AlbedosAtGoal mean_at = [&](std::span<const std::size_t>, double goal) {
      return AdaptiveMean(adaptive, goal).result();
    };
    AlbedoOutcome outcome = albedos_within(mean_at, 1, options.tolerance, adaptive.rounding()).front();
    if (!outcome.is_finite) refuse_not_finite("mean albedo", material);
    if (!outcome.is_reached) tell_missed(outcome, {.quantity = "mean albedo"}, material, options);
    return std::move(outcome.values);
  }
  MaterialAlbedo integral(device, material, options.precision);
  const auto at_level = [&](int level) {
    Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(material.channels()));
    for (std::size_t slab = 0; slab < integral.rule().slabs(); ++slab) {
      const auto incident = integral.rule().incident_nodes(slab, level);
      const Eigen::MatrixXd albedos = integral.at(incident, level);
      for (std::size_t k = 0; k < incident.size(); ++k) {
        mean += incident[k].weight / std::numbers::pi * albedos.col(static_cast<Eigen::Index>(k)).array();
      }
    }
    return mean;
  };
  // Jumps between azimuths of the light: levels hardly converge, and agree by accident.
  constexpr double kOfHiddenJumps = 2e-3;
  constexpr int kLevelsOfHiddenJumps = 4;
  const double floor = integral.hides_jumps() ? kOfHiddenJumps : integral.rounding();
  const int most = integral.hides_jumps() ? kLevelsOfHiddenJumps : kLevels;
  return reached(at_level, {.quantity = "mean albedo"}, material, floor, most, options);
}

}  // namespace lobe
