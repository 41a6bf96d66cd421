#include "energy/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "energy/albedo.hpp"
#include "energy/albedo_bound.hpp"
#include "energy/function_bound.hpp"
#include "energy/known_as.hpp"
#include "energy/value_search.hpp"
#include "lobe/core/error.hpp"
#include "model/delta_shares.hpp"
#include "model/lobes.hpp"
#include "model/traits.hpp"
#include "model/values.hpp"
#include "table/tabulate.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Rounding of values, relative to the sum of the sizes of their terms.
constexpr double kPlausibilityRounding = 1e-12;
/// A relative difference of f(L, V) and f(V, L) that azimuths known to an ulp make, at least, and over the square of
/// the width of narrow lobes.
constexpr double kReciprocityRounding = 1e-8;
constexpr double kNarrowRounding = 1e-15;
/// What a largest albedo may be above 1 in materials that were made white: by curves that are off by up to this, of
/// which errors of albedos know nothing.
constexpr double kWhite = 2e-6;
/// Share of a reflectance's mean size, below which values count for less in relative differences.
constexpr double kSmallShare = 1e-3;

void check(const PlausibilityOptions& options) {
  if (!(options.tolerance > 0 && options.tolerance < 1)) {
    throw ArgumentError("the tolerance of a check is out of range; expected a value in (0, 1)");
  }
  if (options.most_nodes == 0) throw ArgumentError("a check may use no quadrature nodes; expected at least 1");
  if (options.pairs < 4 || options.angles < 3 || options.azimuths < 1) {
    throw ArgumentError("a check looks at too few directions; expected at least 4 pairs, 3 angles and 1 azimuth");
  }
}

/// Values of a channel forward and backward.
class ValueCheck {
 public:
  ValueCheck(const Device& device, const Material& smooth, bool is_isotropic, std::size_t pairs)
      : device_(device),
        smooth_(smooth),
        with_azimuths_(!is_isotropic),
        pairs_(spread_pairs(pairs, !is_isotropic)),
        sharpest_(make_lobe_set({&smooth, 1}, {.with_anisotropic = true}).sharpest()) {
    forward_ = unchecked_values(device_, smooth_, pairs_);
    backward_ = unchecked_values(device_, smooth_, reversed_pairs(pairs_));
  }

  [[nodiscard]] std::size_t pairs() const { return pairs_.size(); }

  void check(std::size_t channel, ChannelPlausibility& result) const {
    const auto c = static_cast<Eigen::Index>(channel);
    const auto negated = [&](std::span<const Directions> at) -> Eigen::ArrayXd {
      return -unchecked_values(device_, smooth_, at).col(c).array();
    };
    const FoundPair least = best_pair(negated, pairs_, -forward_.col(c).array(), with_azimuths_);
    result.least = {{-least.merit, rounding(channel, least.at)}, least.at};
    result.is_non_negative = result.least.value.value >= -result.least.value.error;

    const Eigen::Index anywhere = std::max<Eigen::Index>(forward_.rows() / 4, 1);
    const double small = kSmallShare * forward_.col(c).head(anywhere).cwiseAbs().mean();
    // Where both values are infinite or 0 they do not differ.
    const auto absolute = [](const Eigen::ArrayXd& f, const Eigen::ArrayXd& g) -> Eigen::ArrayXd {
      return (f == g).select(0.0, (f - g).abs());
    };
    const auto relative = [&](const Eigen::ArrayXd& f, const Eigen::ArrayXd& g) -> Eigen::ArrayXd {
      return (f == g).select(0.0, (f - g).abs() / f.abs().max(g.abs()).max(small));
    };
    const FoundPair largest = worst_pair(channel, absolute);
    const FoundPair worst = worst_pair(channel, relative);
    result.reciprocity = {largest.merit, largest.at, worst.merit, worst.at};
    result.is_reciprocal = worst.merit <= std::max(kReciprocityRounding, kNarrowRounding / (sharpest_ * sharpest_));
  }

 private:
  static std::vector<Directions> reversed_pairs(std::span<const Directions> pairs) {
    std::vector<Directions> backward;
    for (const auto& pair : pairs) backward.push_back(reversed(pair));
    return backward;
  }

  template <typename Difference>
  [[nodiscard]] FoundPair worst_pair(std::size_t channel, const Difference& difference) const {
    const auto c = static_cast<Eigen::Index>(channel);
    const auto merit = [&](std::span<const Directions> at) -> Eigen::ArrayXd {
      return difference(unchecked_values(device_, smooth_, at).col(c).array(),
                        unchecked_values(device_, smooth_, reversed_pairs(at)).col(c).array());
    };
    const Eigen::ArrayXd first = difference(forward_.col(c).array(), backward_.col(c).array());
    Eigen::Index best = 0;
    const double most = first.maxCoeff(&best);
    // Differences of rounding lead nowhere.
    const double size = forward_.col(c).cwiseAbs().maxCoeff();
    if (most <= kPlausibilityRounding * std::max(size, 1.0)) return {most, pairs_[static_cast<std::size_t>(best)]};
    return best_pair(merit, pairs_, first, with_azimuths_);
  }

  /// Rounding of a value that is a sum of terms.
  [[nodiscard]] double rounding(std::size_t channel, const Directions& at) const {
    double size = 0;
    for (const Term& term : smooth_.terms) {
      const Material alone{smooth_.name, smooth_.family, {term}};
      const Eigen::MatrixXd value = unchecked_values(device_, alone, {&at, 1});
      size += std::abs(value(0, value.cols() == 1 ? 0 : static_cast<Eigen::Index>(channel)));
    }
    return kPlausibilityRounding * size;
  }

  const Device& device_;
  const Material& smooth_;
  bool with_azimuths_;
  std::vector<Directions> pairs_;
  double sharpest_;  // width, radians of the half-vector
  Eigen::MatrixXd forward_;
  Eigen::MatrixXd backward_;
};

/// How far a material jumps at an edge, along an azimuth (radians) from the mirror or the retro direction.
std::vector<double> jumps_at(const Device& device, const Material& smooth, bool is_about_retro, double radius,
                             double azimuth) {
  constexpr double kAside = 1e-7;   // of the radius
  constexpr double kNoJump = 1e-5;  // relative: what a slope makes of that distance
  // V as far from the normal as L; in the base plane they are a radius apart, or V and the mirror image of L are.
  std::vector<Directions> sides;
  for (const double side : {1 - kAside, 1 + kAside}) {
    const double theta = std::asin(std::min(radius / 2 * side, 1.0));
    sides.push_back({theta, theta, is_about_retro ? pi : 0.0, azimuth});
  }
  const Eigen::MatrixXd values = unchecked_values(device, smooth, sides);
  std::vector<double> jumps;
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    const double jump = std::abs(values(1, c) - values(0, c));
    jumps.push_back(jump > kNoJump * values.col(c).cwiseAbs().maxCoeff() ? jump : 0);
  }
  return jumps;
}

/// The edges that the models of a material tell of, and how far it jumps there.
std::vector<SmoothnessBreak> breaks_of(const Device& device, const Material& smooth) {
  const LobeSet lobes = make_lobe_set({&smooth, 1}, {.with_anisotropic = true});
  std::vector<SmoothnessBreak> breaks;
  for (const bool is_about_retro : {false, true}) {
    for (const double radius : is_about_retro ? lobes.retro_patch_radii : lobes.patch_radii) {
      if (!(radius < 2)) continue;
      breaks.push_back({is_about_retro, radius, jumps_at(device, smooth, is_about_retro, radius, 0), false});
    }
    for (const PatchEdge& edge : is_about_retro ? lobes.retro_patch_edges : lobes.patch_edges) {
      if (!(edge.radius < 2)) continue;
      const double across = edge.rotation + pi / 2;
      breaks.push_back(
          {is_about_retro, edge.radius, jumps_at(device, smooth, is_about_retro, edge.radius, across), true});
    }
  }
  return breaks;
}

std::vector<Estimate> mean_albedos(const Device& device, const Material& material, const PlausibilityOptions& options) {
  try {
    return mean_albedo(
        device, material,
        {.tolerance = options.tolerance, .precision = options.precision, .missed = refuse_missed_tolerance});
  } catch (const NumericError&) {
    return {};  // slow to converge or infinite; the rest is worth knowing
  }
}

/// Elevations of light at which delta parts are examined, radians above the horizon.
std::vector<double> elevations_looked_at(const PlausibilityOptions& options) {
  std::vector<double> elevations;
  for (std::size_t i = 1; i <= options.angles; ++i) {
    elevations.push_back(pi / 2 * static_cast<double>(i) / static_cast<double>(options.angles));
  }
  return elevations;
}

}  // namespace

bool Plausibility::is_plausible() const {
  return std::ranges::all_of(channels, &ChannelPlausibility::is_plausible);
}

Plausibility check_plausibility(const Device& device, const Material& material, const PlausibilityOptions& options) {
  check(options);
  const DeltaSplit split = split_delta(material);
  const std::size_t channels = material.channels();
  const bool isotropic = is_isotropic(material);
  const AlbedoBounds bounds = albedo_bounds(device, material, isotropic, options);
  const auto means = options.with_mean_albedo ? mean_albedos(device, material, options) : std::vector<Estimate>{};
  Plausibility result;
  result.incident = bounds.incident;
  result.unresolved = bounds.unresolved;
  result.least_elevation = bounds.least_elevation;
  result.nodes = bounds.nodes;
  result.channels.resize(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    ChannelPlausibility& channel = result.channels[c];
    channel.albedo = bounds.channels[c];
    if (!means.empty()) channel.mean_albedo = means[c];
    channel.conserves_energy = !channel.albedo.growth && bounds.certain[c] <= 1 + kWhite;
  }
  if (!split.smooth.terms.empty()) {
    const ValueCheck values(device, split.smooth, isotropic, options.pairs);
    result.pairs = values.pairs();
    result.breaks = breaks_of(device, split.smooth);
    const std::size_t own_channels = split.smooth.channels();
    // Terms may have one weight for all channels.
    for (std::size_t c = 0; c < channels; ++c) values.check(own_channels == 1 ? 0 : c, result.channels[c]);
  }
  // A negative mirror takes away more light than it gets.
  const DeltaParts deltas = delta_parts(device, split.deltas, channels, elevations_looked_at(options));
  for (std::size_t c = 0; c < channels; ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    const bool is_negative = deltas.mirror.row(row).minCoeff() < 0 || deltas.retro.row(row).minCoeff() < 0;
    if (is_negative) result.channels[c].is_non_negative = false;
  }
  return result;
}

Plausibility check_plausibility(const BrdfFunction& function, const PlausibilityOptions& options) {
  // Values are those at the nodes of a grid, which may be too coarse for their integrals.
  const BrdfTable table = natural_table(function);
  Plausibility result = check_plausibility(table);
  result.grid = table.grid;
  const FunctionSearch search{.angles = options.angles, .azimuths = 2 * options.azimuths};
  const FunctionBounds bounds = albedo_bounds(function, search);
  result.incident = bounds.incident;
  result.least_elevation = search.least_elevation;
  const auto means = options.with_mean_albedo ? mean_albedo(function) : std::vector<Estimate>();
  for (std::size_t c = 0; c < result.channels.size(); ++c) {
    ChannelPlausibility& channel = result.channels[c];
    channel.albedo = bounds.channels[c];
    channel.conserves_energy = bounds.certain[c] <= 1;
    channel.mean_albedo = means.empty() ? std::nullopt : std::optional(means[c]);
  }
  return result;
}

Plausibility check_plausibility(const Device& device, const Reflectance& reflectance,
                                const PlausibilityOptions& options) {
  check(options);
  const auto of_table = [](const BrdfTable& table) {
    Plausibility found = check_plausibility(table);
    found.grid = table.grid;
    return found;
  };
  return known_as(device, reflectance,
                  Cases{[&](const Material& formula) { return check_plausibility(device, formula, options); },
                        [&](const BrdfFunction& function) { return check_plausibility(function, options); },
                        [&](const BrdfTable& table) { return of_table(table); }});
}

}  // namespace lobe
