#include "energy/adaptive_albedo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "device/evaluate_lobes.hpp"
#include "energy/material_albedo.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/kronrod.hpp"

namespace lobe {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;
using ArrayXb = Eigen::Array<bool, Eigen::Dynamic, 1>;

constexpr std::size_t kArcsPerBlock = 400;  // as many as make a launch cheap beside the work
constexpr double kPanelSafety = 2;          // of error estimates: kinks near the ends of a panel are hardly seen
constexpr std::size_t kTogether = 16;       // directions, which bounds the memory for panels

/// A panel of the outer variable of a direction, or of the inner one on a ring.
struct Panel {
  std::size_t owner;  ///< index of the direction or ring
  PanelEdge low, high;
};

/// Directions V of one elevation, or of one ray of half-vectors.
struct ViewRing {
  std::size_t direction;
  double at;
  double weight;  ///< weight in the integral over the inner variable
};

std::array<Panel, 2> halves(const Panel& panel) {
  const PanelEdge middle{(panel.low.at + panel.high.at) / 2};
  return {Panel{panel.owner, panel.low, middle}, Panel{panel.owner, middle, panel.high}};
}

bool can_be_halved(const Panel& panel) {
  constexpr double kShortest = 1e-14;
  return panel.high.at - panel.low.at > kShortest;
}

void append_panels(const std::vector<PanelEdge>& edges, std::size_t owner, std::vector<Panel>& panels) {
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) panels.push_back({owner, edges[k], edges[k + 1]});
}

/// \param column of the values
AlbedoOutcome outcome_of(const AlbedoValues& found, Index column, double rounding, double goal) {
  constexpr double kUnsettled = 0.1;
  AlbedoOutcome outcome;
  outcome.is_finite = found.value.col(column).isFinite().all();
  for (Index c = 0; c < found.value.rows(); ++c) {
    const double value = found.value(c, column);
    const double error = found.error(c, column) + rounding * found.magnitude(c, column);
    outcome.values.push_back({value, error});
    if (error > 0) outcome.worst = std::max(outcome.worst, error / std::abs(value));
    if (error > kUnsettled * found.magnitude(c, column)) outcome.is_divergent = true;
  }
  outcome.is_reached = outcome.worst <= goal;
  return outcome;
}

}  // namespace

std::vector<AlbedoOutcome> albedos_within(const AlbedosAtGoal& albedos_at, std::size_t count, double tolerance,
                                          double rounding) {
  constexpr int kAttempts = 3;
  const double goal = std::max(tolerance, 2 * rounding);
  std::vector<AlbedoOutcome> outcomes(count);
  std::vector<std::size_t> open(count);
  std::iota(open.begin(), open.end(), std::size_t{0});
  double strictness = 1;
  for (int attempt = 1; attempt <= kAttempts && !open.empty(); ++attempt, strictness *= 0.1) {
    const AlbedoValues found = albedos_at(open, strictness * goal);
    std::vector<std::size_t> unmet;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const auto column = static_cast<Index>(i);
      AlbedoOutcome& outcome = outcomes[open[i]];
      outcome = outcome_of(found, column, rounding, goal);
      const bool is_rounding = (rounding * found.magnitude.col(column) > goal * found.value.col(column).abs()).any();
      if (!outcome.is_reached && !is_rounding && !found.is_exhausted(column)) unmet.push_back(open[i]);
    }
    if (!std::ranges::all_of(outcomes, &AlbedoOutcome::is_finite)) break;
    open = std::move(unmet);
  }
  return outcomes;
}

/// Adaptive quadrature of the lobes of a part at some directions.
class AdaptiveAlbedo::Integral {
 public:
  Integral(Part& part, const HalfVectorRule& half_vectors, const LobeExtent& extent,
           std::span<const IncidentNode> incident, double goal, std::size_t most_nodes)
      : rule_(pair_for(goal)),
        part_(part),
        half_vectors_(half_vectors),
        extent_(extent),
        incident_(incident),
        goal_(goal),
        most_nodes_(most_nodes),
        channels_(part.mix.rows()),
        nodes_(incident.size()),
        first_arcs_(incident.size(), 0) {}

  AlbedoValues result() {
    const auto count = static_cast<Index>(incident_.size());
    const ArrayXXd zero = ArrayXXd::Zero(channels_, count);
    values_ = {zero, zero, zero, ArrayXb::Constant(count, false)};
    scale_ = zero;
    std::vector<Panel> bands;
    for (std::size_t k = 0; k < incident_.size(); ++k) append_panels(outer_panels(incident_[k]), k, bands);
    first_bands_.assign(incident_.size(), 0);
    for (const Panel& band : bands) ++first_bands_[band.owner];
    while (!bands.empty()) bands = settle(bands);
    for (Index k = 0; k < count; ++k) values_.is_exhausted(k) = nodes_[static_cast<std::size_t>(k)] > most_nodes_;
    return values_;
  }

  /// The number of nodes spent on all directions.
  [[nodiscard]] std::uint64_t nodes() const { return std::accumulate(nodes_.begin(), nodes_.end(), std::uint64_t{0}); }

 private:
  [[nodiscard]] bool is_flat() const { return part_.rays == Rays::none; }
  [[nodiscard]] bool is_retro() const { return part_.rays == Rays::retro; }

  [[nodiscard]] std::vector<PanelEdge> outer_panels(const IncidentNode& in) const {
    if (is_flat()) return elevation_panels(in.elevation, extent_);
    return half_vectors_.azimuths(in.elevation, in.azimuth, is_retro());
  }

  [[nodiscard]] HalfVectorRay ray_of(const ViewRing& ring) const {
    const IncidentNode& in = incident_[ring.direction];
    return {in.elevation, in.azimuth, is_retro(), ring.at};
  }

  [[nodiscard]] std::vector<PanelEdge> inner_panels(const ViewRing& ring) const {
    if (is_flat()) return azimuth_panels(incident_[ring.direction].elevation, ring.at, extent_);
    return half_vectors_.along(ray_of(ring));
  }

  /// Whether a panel's share of the integral is known well enough: relative to itself, or to an even share of the
  /// whole.
  [[nodiscard]] bool is_accurate(const ArrayXd& value, const ArrayXd& error, Index direction, double panels) const {
    constexpr double kShare = 0.2;  // of the goal
    return (error <= kShare * goal_ * value.abs().max(scale_.col(direction) / panels)).all();
  }

  /// Adds the bands that are accurate to the values and returns the halves of the others.
  std::vector<Panel> settle(const std::vector<Panel>& bands) {
    const std::size_t n = rule_.nodes.size();
    std::vector<ViewRing> rings;
    rings.reserve(bands.size() * n);
    for (const Panel& band : bands) {
      for (std::size_t k = 0; k < n; ++k) {
        const PanelPoint at = panel_point(band.low, band.high, rule_.nodes[k]);
        // Both halves of the azimuth; N.V sin(theta_V).
        const double measure = is_flat() ? 2 * at.stretch * std::sin(at.at) * std::cos(at.at) : at.stretch;
        rings.push_back({band.owner, at.at, measure * rule_.weights[k]});
      }
    }
    auto [inner, inner_error] = integrate_rings(rings);
    for (Index ring = 0; ring < inner.cols(); ++ring) {
      inner.col(ring) *= rings[static_cast<std::size_t>(ring)].weight;
      inner_error.col(ring) *= rings[static_cast<std::size_t>(ring)].weight;
    }
    const auto count = static_cast<Index>(n);
    const auto [values, errors] = integrate_panels(rule_, inner, count);
    std::vector<Panel> rest;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const auto band = static_cast<Index>(b);
      const ArrayXd value = values.col(band);
      const ArrayXd outer = errors.col(band);
      const ArrayXd error = inner_error.middleCols(band * count, count).rowwise().sum();
      const std::size_t owner = bands[b].owner;
      const auto column = static_cast<Index>(owner);
      const bool is_finite = value.isFinite().all();  // else the whole is not, either
      if (!is_finite || is_accurate(value, outer, column, first_bands_[owner]) || !can_be_halved(bands[b]) ||
          nodes_[owner] > most_nodes_) {
        values_.value.col(column) += value;
        values_.magnitude.col(column) += value.abs();
        values_.error.col(column) += kPanelSafety * (outer + error);
      } else {
        const auto two = halves(bands[b]);
        rest.insert(rest.end(), two.begin(), two.end());
      }
    }
    return rest;
  }

  /// Integrals over the inner variable and their errors, channels x rings.
  std::pair<ArrayXXd, ArrayXXd> integrate_rings(const std::vector<ViewRing>& rings) {
    std::vector<Panel> arcs;
    for (std::size_t r = 0; r < rings.size(); ++r) append_panels(inner_panels(rings[r]), r, arcs);
    std::vector<double> count(incident_.size(), 0);
    for (const Panel& arc : arcs) ++count[rings[arc.owner].direction];
    for (std::size_t k = 0; k < count.size(); ++k) first_arcs_[k] = std::max(first_arcs_[k], count[k]);

    const ArrayXXd zero = ArrayXXd::Zero(channels_, static_cast<Index>(rings.size()));
    std::pair<ArrayXXd, ArrayXXd> sums{zero, zero};
    for (bool is_first = true; !arcs.empty(); is_first = false) {
      const auto [values, errors] = integrate_arcs(arcs, rings);
      if (is_first) {
        scale_ = values_.magnitude;
        for (std::size_t a = 0; a < arcs.size(); ++a) {
          const ViewRing& ring = rings[arcs[a].owner];
          scale_.col(static_cast<Index>(ring.direction)) += ring.weight * values.col(static_cast<Index>(a)).abs();
        }
      }
      std::vector<Panel> rest;
      for (std::size_t a = 0; a < arcs.size(); ++a) {
        const ViewRing& ring = rings[arcs[a].owner];
        const ArrayXd value = values.col(static_cast<Index>(a));
        const ArrayXd error = errors.col(static_cast<Index>(a));
        const bool is_finite = value.isFinite().all();
        if (!is_finite || !can_be_halved(arcs[a]) || nodes_[ring.direction] > most_nodes_ ||
            is_accurate(ring.weight * value, ring.weight * error, static_cast<Index>(ring.direction),
                        first_arcs_[ring.direction])) {
          sums.first.col(static_cast<Index>(arcs[a].owner)) += value;
          sums.second.col(static_cast<Index>(arcs[a].owner)) += error;
        } else {
          const auto two = halves(arcs[a]);
          rest.insert(rest.end(), two.begin(), two.end());
        }
      }
      arcs = std::move(rest);
    }
    return sums;
  }

  /// By the larger of the embedded rules, and what they tell of its error, on each arc.
  std::pair<ArrayXXd, ArrayXXd> integrate_arcs(const std::vector<Panel>& arcs, const std::vector<ViewRing>& rings) {
    const ArrayXXd zero = ArrayXXd::Zero(channels_, static_cast<Index>(arcs.size()));
    std::pair<ArrayXXd, ArrayXXd> sums{zero, zero};
    std::size_t first = 0;
    for (std::size_t a = 0; a < arcs.size(); ++a) {
      push_nodes(arcs[a], rings[arcs[a].owner]);
      if (part_.block.size() + rule_.nodes.size() > part_.block.capacity() || a + 1 == arcs.size()) {
        sum_nodes(first, sums);
        first = a + 1;
      }
    }
    return sums;
  }

  /// Nodes with the larger rule's weight in the factor.
  void push_nodes(const Panel& arc, const ViewRing& ring) {
    const IncidentNode& in = incident_[ring.direction];
    nodes_[ring.direction] += rule_.nodes.size();
    if (is_flat()) {
      const ElevationPair pair = elevation_pair(in.elevation, ring.at);
      for (std::size_t k = 0; k < rule_.nodes.size(); ++k) {
        const PanelPoint at = panel_point(arc.low, arc.high, rule_.nodes[k]);
        place_node(part_.block, pair, at.at, at.stretch * rule_.weights[k]);
      }
      return;
    }
    const HalfVectorRay ray = ray_of(ring);
    for (std::size_t k = 0; k < rule_.nodes.size(); ++k) {
      const PanelPoint at = panel_point(arc.low, arc.high, rule_.nodes[k]);
      const auto [node, tangents] = ray.node(at.at, at.stretch * rule_.weights[k]);
      part_.block.push(node, tangents);
    }
  }

  void sum_nodes(std::size_t first_arc, std::pair<ArrayXXd, ArrayXXd>& sums) {
    if (is_flat()) complete_nodes(part_.block, 0, part_.block.size());
    const ArrayXXd terms = part_.mix * values_at(part_.evaluator, part_.block);
    part_.block.clear();
    const auto [values, errors] = integrate_panels(rule_, terms, static_cast<Index>(rule_.nodes.size()));
    sums.first.middleCols(static_cast<Index>(first_arc), values.cols()) = values;
    sums.second.middleCols(static_cast<Index>(first_arc), values.cols()) = errors;
  }

  const EmbeddedPair& rule_;
  Part& part_;
  const HalfVectorRule& half_vectors_;
  const LobeExtent& extent_;
  std::span<const IncidentNode> incident_;
  double goal_;
  std::size_t most_nodes_;
  Index channels_;
  AlbedoValues values_;
  ArrayXXd scale_;                                ///< magnitude of the whole, as far as known
  std::vector<std::size_t> nodes_;                ///< spent on each direction
  std::vector<double> first_bands_, first_arcs_;  ///< panels of each direction before any are halved
};

AdaptiveAlbedo::AdaptiveAlbedo(const Device& device, const Material& material, Precision precision)
    : lobes_(make_lobe_set({&material, 1}, {.with_deltas = true, .with_anisotropic = true})),
      rule_(lobes_.extent()),
      half_vectors_(lobes_.extent()),
      deltas_(device, lobes_.deltas),
      rounding_(albedo_rounding(precision, lobes_)) {
  const auto rays_of = [&](std::size_t batch) {
    if (!lobes_.batches[batch].kernel.is_anisotropic) return Rays::none;
    return lobes_.is_retro_patch[batch] ? Rays::retro : Rays::mirror;
  };
  const auto channels = static_cast<Index>(lobes_.channels());
  for (const Rays rays : {Rays::none, Rays::mirror, Rays::retro}) {
    std::vector<LobeBatch> batches;
    std::vector<Index> columns;
    Index column = 0;
    for (std::size_t b = 0; b < lobes_.batches.size(); ++b) {
      const LobeBatch& batch = lobes_.batches[b];
      for (std::size_t k = 0; k < batch.coefficients.size(); ++k, ++column) {
        if (rays_of(b) == rays) columns.push_back(column);
      }
      if (rays_of(b) == rays) batches.push_back(batch);
    }
    if (batches.empty()) continue;
    if (rays != Rays::none) is_isotropic_ = false;
    Eigen::MatrixXd mix(channels, static_cast<Index>(columns.size()));
    for (Index c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < columns.size(); ++k) {
        mix(c, static_cast<Index>(k)) = lobes_.mix[static_cast<std::size_t>(c)].coeff(0, columns[k]);
      }
    }
    const std::size_t capacity = kArcsPerBlock * long_pair().nodes.size();
    LobeEvaluator evaluator(device, batches, precision, capacity);
    parts_.push_back({rays, std::move(mix), std::move(evaluator), NodeBlock(capacity, rays != Rays::none)});
  }
}

AlbedoValues AdaptiveAlbedo::at(std::span<const IncidentNode> incident, double goal, std::size_t most_nodes) {
  const auto count = static_cast<Index>(incident.size());
  const ArrayXXd zero = ArrayXXd::Zero(static_cast<Index>(lobes_.channels()), count);
  AlbedoValues all{zero, zero, zero, ArrayXb::Constant(count, false)};
  const LobeExtent extent = lobes_.extent();
  for (std::size_t first = 0; first < incident.size(); first += kTogether) {
    const auto some = incident.subspan(first, std::min(kTogether, incident.size() - first));
    const auto begin = static_cast<Index>(first);
    const auto size = static_cast<Index>(some.size());
    for (Part& part : parts_) {
      Integral integral(part, half_vectors_, extent, some, goal, most_nodes);
      const AlbedoValues values = integral.result();
      nodes_ += integral.nodes();
      all.value.middleCols(begin, size) += values.value;
      all.error.middleCols(begin, size) += values.error;
      all.magnitude.middleCols(begin, size) += values.magnitude;
      all.is_exhausted.segment(begin, size) = all.is_exhausted.segment(begin, size) || values.is_exhausted;
    }
  }
  if (!lobes_.deltas.empty()) {
    std::vector<double> elevations;
    for (const IncidentNode& node : incident) elevations.push_back(node.elevation);
    const Eigen::MatrixXd shares = deltas_.at(elevations);
    const auto smooth = static_cast<Index>(lobes_.smooth_lobes());
    for (Index c = 0; c < all.value.rows(); ++c) {
      for (Index d = 0; d < shares.rows(); ++d) {
        const ArrayXd part = lobes_.mix[static_cast<std::size_t>(c)].coeff(0, smooth + d) * shares.row(d).array();
        all.value.row(c) += part.transpose();
        all.magnitude.row(c) += part.abs().transpose();
      }
    }
  }
  return all;
}

std::vector<AlbedoOutcome> AdaptiveAlbedo::within(std::span<const IncidentNode> incident, double tolerance,
                                                  std::size_t most_nodes) {
  const AlbedosAtGoal albedos_at = [&](std::span<const std::size_t> some, double goal) {
    std::vector<IncidentNode> nodes;
    for (const std::size_t k : some) nodes.push_back(incident[k]);
    return at(nodes, goal, most_nodes);
  };
  return albedos_within(albedos_at, incident.size(), tolerance, rounding_);
}

}  // namespace lobe
