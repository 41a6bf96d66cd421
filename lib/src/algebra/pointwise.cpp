// Composition at single pairs of directions: nested adaptive quadrature. An integral over the elevation of X of
// integrals over its azimuth, each a sum over panels with an embedded pair of rules; panels whose estimated error is
// too large are halved, outer ones (bands) after their inner ones (arcs). Panels of many pairs are evaluated together.
#include "algebra/pointwise.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "device/evaluate_lobes.hpp"
#include "hemisphere/composition_rule.hpp"
#include "hemisphere/geometry.hpp"
#include "hemisphere/kronrod.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/lobes.hpp"

namespace lobe {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

constexpr std::size_t kNodesPerBlock = 6800;    // as many as make a launch cheap beside the work
constexpr std::size_t kPairsTogether = 16;      // bounds the memory for panels
constexpr std::size_t kMostNodes = 10'000'000;  // per pair; what is not resolved by then is an error
constexpr double kDensitySafety = 4;            // of error estimates: two rules may agree by accident
constexpr double kArcShare = 0.025;             // of the tolerance, for the errors of all arcs together
constexpr double kBandShare = 0.05;             // the same for bands

/// A panel of the azimuth of X on a ring, or of its elevation for a pair of directions.
struct Panel {
  std::size_t owner;  ///< index of the ring or pair
  PanelEdge low, high;
};

/// Directions X of one elevation, for one pair.
struct DensityRing {
  std::size_t pair;
  double elevation;
  double weight;          ///< weight in the integral over the azimuth
  ElevationPair in, out;  ///< elevations of L and X, of X and V
};

/// State of the integrals for a set of pairs, channels x pairs.
struct Totals {
  Totals(Index channels, Index pairs)
      : value(ArrayXXd::Zero(channels, pairs)), error(value), magnitude(value), scale(value) {}
  ArrayXXd value, error;
  ArrayXXd magnitude;  ///< integral of the absolute value, over the bands done
  ArrayXXd scale;      ///< the same over all bands, as far as known: what errors are measured against
};

/// Values of a material at blocks of nodes.
class MaterialEvaluator {
 public:
  MaterialEvaluator(const Device& device, const Material& material, std::size_t channels, Precision precision)
      : lobes_(make_lobe_set({&material, 1})),
        channels_(channels),
        evaluator_(device, lobes_.batches, precision, kNodesPerBlock),
        block_(evaluator_.node_stride()) {}

  [[nodiscard]] const LobeSet& lobes() const { return lobes_; }
  [[nodiscard]] LobeExtent extent() const { return lobes_.extent(); }

  /// Nodes that set() gives, for the next take().
  void begin(std::size_t nodes) {
    block_.clear();
    block_.extend(nodes);
  }
  void set(std::size_t column, const ElevationPair& pair, double psi, double factor) {
    place_node(block_, column, pair, psi, factor);
  }
  /// Once these are set, and before take().
  void complete(std::size_t first, std::size_t count) { complete_nodes(block_, first, count); }

  /// Values at these nodes, channels x nodes.
  [[nodiscard]] Eigen::MatrixXd take() {
    const Eigen::MatrixXd samples = values_at(evaluator_, block_);
    Eigen::MatrixXd values(static_cast<Index>(channels_), samples.cols());
    for (std::size_t c = 0; c < channels_; ++c) {
      values.row(static_cast<Index>(c)) = lobes_.mix[std::min(c, lobes_.channels() - 1)] * samples;
    }
    return values;
  }

 private:
  LobeSet lobes_;
  std::size_t channels_;
  LobeEvaluator evaluator_;
  NodeBlock block_;
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

/// Whether lobes jump anywhere, at a limit of panels or between.
bool may_jump(const LobeSet& lobes) {
  return !lobes.patch_radii.empty() || !lobes.retro_patch_radii.empty() || lobes.has_hidden_jumps() ||
         std::ranges::any_of(lobes.kinks, &Kink::is_jump);
}

/// Adaptive quadrature of f(L,X) g(X,V) for sets of pairs.
class Composer {
 public:
  Composer(const Device& device, const Material& f, const Material& g, std::size_t channels, Precision precision)
      : what_("composition of '" + f.name + "' and '" + g.name + "'"),
        channels_(static_cast<Index>(channels)),
        f_(device, f, channels, precision),
        g_(device, g, channels, precision) {
    has_jumps_ = may_jump(f_.lobes()) || may_jump(g_.lobes());
  }

  /// \param goal error that the panels may have, relative to the integral
  /// \param floor the same, absolute
  Totals integrate(std::span<const Directions> directions, double goal, double floor) {
    rules_.clear();
    for (const auto& pair : directions) rules_.emplace_back(f_.extent(), g_.extent(), pair);
    nodes_.assign(rules_.size(), 0);
    Totals totals(channels_, static_cast<Index>(rules_.size()));
    std::vector<Panel> bands;
    for (std::size_t pair = 0; pair < rules_.size(); ++pair) append_panels(rules_[pair].elevations(), pair, bands);
    first_bands_ = count_owners(bands, [](const Panel& band) { return band.owner; });
    first_arcs_.assign(rules_.size(), 0);
    goal_ = goal;
    floor_ = floor;
    rule_ = &pair_for(goal);
    while (!bands.empty()) bands = settle(bands, totals);
    return totals;
  }

  /// Smallest width of the lobes of both materials, radians.
  [[nodiscard]] double narrowest() const { return std::min(f_.lobes().sharpest(), g_.lobes().sharpest()); }

 private:
  template <typename PairOf>
  std::vector<double> count_owners(const std::vector<Panel>& panels, const PairOf& pair_of) const {
    std::vector<double> count(rules_.size());
    for (const auto& panel : panels) ++count[pair_of(panel)];
    return count;
  }

  /// Whether a panel's share of the integral is known well enough: relative to itself, or to an even share of the
  /// whole.
  [[nodiscard]] bool accurate(const ArrayXd& value, const ArrayXd& error, double share, const ArrayXd& whole,
                              double panels) const {
    return (error <= share * (goal_ * value.abs().max(whole / panels)).max(floor_ / panels)).all();
  }

  /// Adds the bands that are accurate to the totals and returns the halves of the others.
  std::vector<Panel> settle(const std::vector<Panel>& bands, Totals& totals) {
    const std::vector<DensityRing> rings = make_rings(bands);
    PanelIntegrals over_azimuth = integrate_rings(rings, totals);
    const auto nodes = static_cast<Index>(rule_->nodes.size());
    for (Index ring = 0; ring < over_azimuth.value.cols(); ++ring) {
      const double weight = rings[static_cast<std::size_t>(ring)].weight;
      over_azimuth.value.col(ring) *= weight;
      over_azimuth.error.col(ring) *= weight;
    }
    const PanelIntegrals found = integrate_panels(*rule_, over_azimuth.value, nodes);
    std::vector<Panel> rest;
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const auto band = static_cast<Index>(b);
      const ArrayXd value = found.value.col(band);
      const ArrayXd error = found.error.col(band);
      const ArrayXd inner = over_azimuth.error.middleCols(band * nodes, nodes).rowwise().sum();
      const std::size_t pair = bands[b].owner;
      const auto column = static_cast<Index>(pair);
      const bool done = accurate(value, error, kBandShare, totals.scale.col(column), first_bands_[pair]) ||
                        !can_be_halved(bands[b]) || nodes_[pair] > kMostNodes;
      if (done) {
        totals.value.col(column) += value;
        totals.magnitude.col(column) += value.abs();
        totals.error.col(column) += kDensitySafety * (error + inner);
      } else {
        const auto two = halves(bands[b]);
        rest.insert(rest.end(), two.begin(), two.end());
      }
    }
    return rest;
  }

  std::vector<DensityRing> make_rings(const std::vector<Panel>& bands) const {
    const EmbeddedPair& rule = *rule_;
    std::vector<DensityRing> rings;
    rings.reserve(bands.size() * rule.nodes.size());
    for (const auto& band : bands) {
      const CompositionRule& panels = rules_[band.owner];
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        const PanelPoint at = panel_point(band.low, band.high, rule.nodes[k]);
        const double measure = panels.sides() * at.stretch * std::sin(at.at) * std::cos(at.at);  // N.X cos(elevation)
        rings.push_back({band.owner, at.at, measure * rule.weights[k], elevation_pair(panels.elevation_in(), at.at),
                         elevation_pair(at.at, panels.elevation_out())});
      }
    }
    return rings;
  }

  /// Integrals over the azimuth, and estimates of their errors, channels x rings.
  PanelIntegrals integrate_rings(const std::vector<DensityRing>& rings, Totals& totals) {
    std::vector<Panel> arcs;
    for (std::size_t r = 0; r < rings.size(); ++r) {
      append_panels(rules_[rings[r].pair].azimuths(rings[r].elevation), r, arcs);
    }
    const auto count = count_owners(arcs, [&](const Panel& arc) { return rings[arc.owner].pair; });
    for (std::size_t pair = 0; pair < count.size(); ++pair)
      first_arcs_[pair] = std::max(first_arcs_[pair], count[pair]);

    const ArrayXXd zero = ArrayXXd::Zero(channels_, static_cast<Index>(rings.size()));
    PanelIntegrals sums{zero, zero};
    for (bool first = true; !arcs.empty(); first = false) {
      const PanelIntegrals found = integrate_arcs(arcs, rings);
      if (!found.value.allFinite()) throw NumericError(what_ + " is no finite number");
      if (first) update_scale(arcs, rings, found, totals);
      std::vector<Panel> rest;
      for (std::size_t a = 0; a < arcs.size(); ++a) {
        const DensityRing& ring = rings[arcs[a].owner];
        const auto value = found.value.col(static_cast<Index>(a));
        const auto error = found.error.col(static_cast<Index>(a));
        const bool done = accurate(ring.weight * value, ring.weight * error, kArcShare,
                                   totals.scale.col(static_cast<Index>(ring.pair)), first_arcs_[ring.pair]) ||
                          !can_be_halved(arcs[a]) || nodes_[ring.pair] > kMostNodes;
        if (done) {
          sums.value.col(static_cast<Index>(arcs[a].owner)) += value;
          sums.error.col(static_cast<Index>(arcs[a].owner)) += error;
        } else {
          const auto two = halves(arcs[a]);
          rest.insert(rest.end(), two.begin(), two.end());
        }
      }
      arcs = std::move(rest);
    }
    return sums;
  }

  void update_scale(const std::vector<Panel>& arcs, const std::vector<DensityRing>& rings, const PanelIntegrals& found,
                    Totals& totals) const {
    totals.scale = totals.magnitude;
    for (std::size_t a = 0; a < arcs.size(); ++a) {
      const DensityRing& ring = rings[arcs[a].owner];
      totals.scale.col(static_cast<Index>(ring.pair)) += ring.weight * found.value.col(static_cast<Index>(a)).abs();
    }
  }

  /// Integrals over arcs, and estimates of their errors, channels x arcs.
  PanelIntegrals integrate_arcs(const std::vector<Panel>& arcs, const std::vector<DensityRing>& rings) {
    constexpr std::size_t kPiece = 32;  // arcs that a thread takes at a time
    const ArrayXXd zero = ArrayXXd::Zero(channels_, static_cast<Index>(arcs.size()));
    PanelIntegrals integrals{zero, zero};
    const std::size_t nodes = nodes_per_arc();
    const std::size_t together = kNodesPerBlock / nodes;
    for (std::size_t first = 0; first < arcs.size(); first += together) {
      const auto block = std::span(arcs).subspan(first, std::min(together, arcs.size() - first));
      f_.begin(block.size() * nodes);
      g_.begin(block.size() * nodes);
      parallel_for_pieces(block.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t a = begin; a < end; ++a) set_nodes(block[a], rings[block[a].owner], a * nodes);
        f_.complete(begin * nodes, (end - begin) * nodes);
        g_.complete(begin * nodes, (end - begin) * nodes);
      });
      for (const Panel& arc : block) nodes_[rings[arc.owner].pair] += nodes;
      const ArrayXXd terms = f_.take().array() * g_.take().array();
      PanelIntegrals found = integrate_panels(*rule_, terms, static_cast<Index>(nodes));
      if (has_jumps_) add_unseen(terms, found);
      const auto begin = static_cast<Index>(first);
      const auto count = static_cast<Index>(block.size());
      integrals.value.middleCols(begin, count) = found.value;
      integrals.error.middleCols(begin, count) = found.error;
    }
    return integrals;
  }

  /// The nodes of the rule, and where integrands jump both ends.
  [[nodiscard]] std::size_t nodes_per_arc() const { return rule_->nodes.size() + (has_jumps_ ? 2 : 0); }

  /// Sets an arc's nodes, with the larger rule's weight in the factor of f; then both ends of the arc, with the
  /// distance to the nearest node for weight.
  void set_nodes(const Panel& arc, const DensityRing& ring, std::size_t column) {
    constexpr double kInside = 1e-6;  // ends are looked at from inside, for the sake of patches
    const EmbeddedPair& rule = *rule_;
    const double turn = rules_[ring.pair].turn();
    const auto set = [&](double azimuth, double weight) {
      f_.set(column, ring.in, azimuth, weight);
      g_.set(column, ring.out, azimuth - turn, 1);
      ++column;
    };
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const PanelPoint at = panel_point(arc.low, arc.high, rule.nodes[k]);
      set(at.at, at.stretch * rule.weights[k]);
    }
    if (!has_jumps_) return;
    set(panel_point(arc.low, arc.high, kInside).at, panel_point(arc.low, arc.high, rule.nodes.front()).at - arc.low.at);
    set(panel_point(arc.low, arc.high, 1 - kInside).at,
        arc.high.at - panel_point(arc.low, arc.high, rule.nodes.back()).at);
  }

  /// Counts what lies between an end of an arc and its first node where the integrand falls so steeply from the end
  /// that the rules see nothing of it, as the tail of a sharp lobe does within the edge of a patch.
  void add_unseen(const ArrayXXd& terms, PanelIntegrals& integrals) const {
    constexpr double kSteep = 4;  // a fall to about a tenth
    const auto last = static_cast<Index>(rule_->nodes.size()) - 1;
    const auto unseen = [&](Index end, Index node) -> ArrayXd {
      return (terms.col(end).abs() > kSteep * terms.col(node).abs()).select(terms.col(end).abs(), 0.0);
    };
    for (Index begin = 0, arc = 0; begin < terms.cols(); begin += last + 3, ++arc) {
      integrals.error.col(arc) =
          integrals.error.col(arc).max(unseen(begin + last + 1, begin)).max(unseen(begin + last + 2, begin + last));
    }
  }

  std::string what_;
  Index channels_;
  MaterialEvaluator f_, g_;
  const EmbeddedPair* rule_ = nullptr;
  bool has_jumps_ = false;  ///< limits of panels may be jumps
  double goal_ = 0;
  double floor_ = 0;
  std::vector<CompositionRule> rules_;
  std::vector<std::size_t> nodes_;                ///< spent on each pair
  std::vector<double> first_bands_, first_arcs_;  ///< panels of each pair before any are halved
};

std::string degrees_of_pair(const Directions& pair) {
  const auto text = [](double angle) { return shortest(to_degrees(angle)); };
  return "(" + text(pair.theta_in) + ", " + text(pair.theta_out) + ", " + text(pair.delta_phi) + ") degrees";
}

void check(const Directions& pair) {
  const auto in_range = [](double theta) { return theta >= 0 && theta < std::numbers::pi / 2; };
  if (in_range(pair.theta_in) && in_range(pair.theta_out) && std::isfinite(pair.delta_phi)) return;
  throw ArgumentError("directions (theta_in, theta_out, delta_phi) of " + degrees_of_pair(pair) +
                      "; expected theta_in and theta_out in [0, 90) and a finite delta_phi");
}

/// Integral and bound of its error for one channel and pair, and how far the bound is from what is asked for.
struct Outcome {
  Estimate estimate;
  bool is_met = false;
};

Outcome outcome(const Totals& totals, Index channel, Index pair, double narrowest, const PointwiseOptions& options) {
  const double magnitude = totals.magnitude(channel, pair);
  const double rounded = pointwise_rounding(options.precision, magnitude, narrowest);
  // The smallest number stands for what is lost where samples underflow.
  const Estimate estimate{totals.value(channel, pair),
                          totals.error(channel, pair) + rounded * magnitude + std::numeric_limits<double>::min()};
  const double allowed = std::max({std::max(options.tolerance, 4 * rounded) * std::abs(estimate.value),
                                   options.absolute, 2 * std::numeric_limits<double>::min()});
  return {estimate, estimate.error <= allowed};
}

/// A pair whose error exceeds what is allowed, and that error relative to the value.
struct Unmet {
  std::size_t pair;
  double relative_error;
};

/// Writes the estimates of some of the pairs, totals in the order of `pairs`, and returns those that are not good
/// enough.
std::vector<Unmet> write_estimates(const Totals& totals, const std::vector<std::size_t>& pairs, double narrowest,
                                   const PointwiseOptions& options, std::vector<std::vector<Estimate>>& result) {
  std::vector<Unmet> unmet;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    double worst = 0;
    bool is_met = true;
    for (std::size_t c = 0; c < result.size(); ++c) {
      const auto [estimate, is_channel_met] =
          outcome(totals, static_cast<Index>(c), static_cast<Index>(p), narrowest, options);
      result[c][pairs[p]] = estimate;
      if (is_channel_met) continue;
      is_met = false;
      worst = std::max(worst, estimate.error / std::abs(estimate.value));
    }
    if (!is_met) unmet.push_back({pairs[p], worst});
  }
  return unmet;
}

}  // namespace

double pointwise_rounding(Precision precision, double value, double narrowest) {
  const double samples = precision == Precision::double_precision ? 1e-14 : 4e-6;
  const double exponent = value > 0 ? std::abs(std::log(value)) : 0;
  return samples * (1 + 0.1 * exponent) + std::numeric_limits<double>::epsilon() / narrowest;
}

std::vector<std::vector<Estimate>> composition_at(const Device& device, const Material& f, const Material& g,
                                                  std::span<const Directions> directions,
                                                  const PointwiseOptions& options) {
  constexpr int kAttempts = 3;  // each ten times stricter, for sums that cancel or whose size was misjudged
  for (const auto& pair : directions) check(pair);
  const std::size_t channels = make_lobe_set(std::array{f, g}).channels();
  std::vector<std::vector<Estimate>> result(channels, std::vector<Estimate>(directions.size()));
  if (directions.empty()) return result;

  Composer composer(device, f, g, channels, options.precision);
  const double narrowest = composer.narrowest();
  const double goal = std::max(options.tolerance, 4 * pointwise_rounding(options.precision, 1, narrowest));
  for (std::size_t first = 0; first < directions.size(); first += kPairsTogether) {
    std::vector<std::size_t> open(std::min(kPairsTogether, directions.size() - first));
    std::iota(open.begin(), open.end(), first);
    double strictness = 1;
    for (int attempt = 1; !open.empty(); ++attempt, strictness *= 0.1) {
      std::vector<Directions> pairs;
      for (const std::size_t k : open) pairs.push_back(directions[k]);
      const Totals totals = composer.integrate(pairs, strictness * goal, strictness * options.absolute);
      const auto unmet = write_estimates(totals, open, narrowest, options, result);
      open.clear();
      if (attempt == kAttempts) {
        for (const auto& [pair, relative_error] : unmet) {
          if (!options.missed) break;
          options.missed({.quantity = "composition of '" + f.name + "' and '" + g.name + "' at " +
                                      degrees_of_pair(directions[pair]),
                          .index = pair,
                          .relative_error = relative_error,
                          .tolerance = options.tolerance});
        }
        break;
      }
      for (const auto& pair : unmet) open.push_back(pair.pair);
    }
  }
  return result;
}

}  // namespace lobe
