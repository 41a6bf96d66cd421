#include "energy/albedo_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "energy/adaptive_albedo.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kRoughBound = 1e-3;  // relative error of albedos that only tell where to look

/// A direction of incidence and the albedos there by channel.
struct Sample {
  double elevation = 0;
  double azimuth = 0;
  std::vector<Estimate> albedos;
};

/// Where light comes from.
struct Place {
  double elevation = 0;
  double azimuth = 0;
};

class BoundSearch {
 public:
  BoundSearch(const Device& device, const Material& material, bool is_isotropic, const PlausibilityOptions& options)
      : material_(material),
        integral_(device, material, options.precision),
        options_(options),
        turn_(integral_.extent().half_turn ? pi : 2 * pi),
        azimuths_(is_isotropic ? 1 : options.azimuths * (integral_.extent().half_turn ? 1 : 2)) {}

  AlbedoBounds result() {
    scan();
    AlbedoBounds bounds;
    for (std::size_t c = 0; c < material_.channels(); ++c) {
      bounds.channels.push_back(bound(c));
      bounds.certain.push_back(certain_);
    }
    bounds.incident = incident_;
    bounds.unresolved = unresolved_;
    bounds.least_elevation = grazing_.back();
    bounds.nodes = integral_.nodes();
    return bounds;
  }

 private:
  /// Albedos where light comes from these places, all at once: a device has less to wait for than by one after another.
  std::vector<Sample> samples_at(std::span<const Place> places, double tolerance) {
    std::vector<IncidentNode> incident;
    for (const Place& place : places) incident.push_back({place.elevation, 1, place.azimuth});
    incident_ += places.size();
    std::vector<Sample> samples;
    for (AlbedoOutcome& outcome : integral_.within(incident, tolerance, options_.most_nodes)) {
      if (!outcome.is_finite) throw NumericError("albedo of '" + material_.name + "' is no finite number");
      if (!outcome.is_reached) ++unresolved_;
      const Place& place = places[samples.size()];
      samples.push_back({place.elevation, place.azimuth, std::move(outcome.values)});
    }
    return samples;
  }

  double rough() const { return std::max(options_.tolerance, kRoughBound); }

  void scan() {
    step_ = pi / 2 / static_cast<double>(options_.angles - 1);
    std::vector<Place> places;
    for (std::size_t i = 0; i + 1 < options_.angles; ++i) {
      for (std::size_t k = 0; k < (i == 0 ? 1 : azimuths_); ++k) {
        places.push_back({pi / 2 - step_ * static_cast<double>(i), azimuth(k)});
      }
    }
    const double width = std::min(integral_.extent().width, 1.0);
    const double deepest = std::clamp(0.01 * width * width, 1e-12, 1e-7);
    for (double e = std::pow(10.0, -1.5); e > 0.9 * deepest; e /= std::sqrt(10.0)) {
      if (e < step_) grazing_.push_back(e);
    }
    for (std::size_t k = 0; k < azimuths_; ++k) {
      for (const double e : grazing_) places.push_back({e, azimuth(k)});
    }
    samples_ = samples_at(places, rough());
  }

  double azimuth(std::size_t k) const { return turn_ * static_cast<double>(k) / static_cast<double>(azimuths_); }

  /// The sample at the i-th last grazing elevation of the azimuth k.
  const Sample& grazing(std::size_t k, std::size_t from_last) const {
    return samples_[samples_.size() - (azimuths_ - k - 1) * grazing_.size() - 1 - from_last];
  }

  /// p of a ~ (N.L)^-p over the two last powers of 10, at the azimuth where it is largest there; none without growth.
  std::optional<Estimate> growth(std::size_t channel) const {
    constexpr std::size_t kPower = 2;      // grazing elevations per power of 10
    constexpr double kLeastGrowth = 0.02;  // what counts as growth at all
    constexpr double kLeastAlbedo = 1e-6;  // below, it is that of rounding: Fresnel's equations at an index of 1
    std::optional<Estimate> steepest;
    for (std::size_t k = 0; k < azimuths_; ++k) {
      std::array<double, 3> logarithms{};
      double error = 0;
      for (std::size_t i = 0; i < logarithms.size(); ++i) {
        const auto& albedos = grazing(k, i * kPower).albedos;
        logarithms[i] = std::log10(albedos[channel].value);
        error = std::max(error, albedos[channel].error / albedos[channel].value);
      }
      const double last = logarithms[0] - logarithms[1];
      const double before = logarithms[1] - logarithms[2];
      if (!std::isfinite(last) || !std::isfinite(before)) continue;  // not positive
      const Estimate p{last, std::abs(last - before) + 2 * error / std::numbers::ln10};
      if (grazing(k, 0).albedos[channel].value < kLeastAlbedo) continue;
      if (p.value < kLeastGrowth || p.value < 2 * p.error) continue;
      if (!steepest || p.value > steepest->value) steepest = p;
    }
    return steepest;
  }

  /// Certain part of an albedo.
  static double certain(const Sample& sample, std::size_t channel) {
    return sample.albedos[channel].value - sample.albedos[channel].error;
  }

  void note_upper(const Sample& sample, std::size_t channel) {
    upper_ = std::max(upper_, sample.albedos[channel].value + sample.albedos[channel].error);
  }

  const Sample& highest(std::size_t channel) const {
    return *std::ranges::max_element(samples_, {}, [&](const Sample& one) { return certain(one, channel); });
  }

  AlbedoBound bound(std::size_t channel) {
    const Sample& top = highest(channel);
    AlbedoBound bound{top.albedos[channel], {pi / 2 - top.elevation, top.azimuth}, growth(channel)};
    certain_ = certain(top, channel);
    if (bound.growth) return bound;
    sharpen_candidates(channel);
    upper_ = -std::numeric_limits<double>::infinity();
    for (const Sample& sample : samples_) note_upper(sample, channel);
    const Sample best = refined(highest(channel), channel);
    bound.largest = best.albedos[channel];
    certain_ = certain(best, channel) - change_;
    // An albedo that is less certain may be larger.
    bound.largest.error = std::max(bound.largest.error, upper_ - bound.largest.value) + change_;
    bound.at = {pi / 2 - best.elevation, best.azimuth};
    return bound;
  }

  /// Computes anew, to the tolerance, the albedos that may be the largest.
  void sharpen_candidates(std::size_t channel) {
    if (options_.tolerance >= kRoughBound) return;
    const Estimate top = highest(channel).albedos[channel];
    std::vector<std::size_t> candidates;
    std::vector<Place> places;
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const Estimate& albedo = samples_[k].albedos[channel];
      if (albedo.value + albedo.error < top.value - top.error) continue;
      if (albedo.error <= options_.tolerance * std::abs(albedo.value)) continue;
      candidates.push_back(k);
      places.push_back({samples_[k].elevation, samples_[k].azimuth});
    }
    auto sharper = samples_at(places, options_.tolerance);
    for (std::size_t k = 0; k < candidates.size(); ++k) samples_[candidates[k]] = std::move(sharper[k]);
  }

  /// Searches around the best direction in elevation and azimuth by steps that shrink, and at the vertices of the
  /// parabolas through the albedos there. Leaves in change_ what the last round changed: rounds approach a smooth
  /// maximum faster and faster; at grazing incidence also what the last steps towards it changed.
  Sample refined(Sample best, std::size_t channel) {
    constexpr int kRounds = 4;
    constexpr double kShrink = 0.4;
    change_ = 0;
    const double least = grazing_.back();
    if (best.elevation <= std::sqrt(10.0) * least * 1.01) {
      for (std::size_t k = 0; k < azimuths_; ++k) {
        const double last = grazing(k, 0).albedos[channel].value;
        change_ = std::max(change_, std::abs(last - grazing(k, 1).albedos[channel].value));
      }
    }
    // Between grazing directions the elevation changes by factors.
    double factor = std::sqrt(10.0);
    double step = step_;
    double turn = turn_ / static_cast<double>(azimuths_);
    const bool is_grazing = best.elevation < step_;
    double before = 0;
    for (int round = 0; round < kRounds; ++round) {
      factor = std::pow(factor, kShrink);
      step *= kShrink;
      turn *= kShrink;
      before = best.albedos[channel].value;
      best = highest_along(best, channel, [&, from = best.elevation](double steps) {
        return Place{is_grazing ? from * std::pow(factor, steps) : from + steps * step, best.azimuth};
      });
      if (azimuths_ == 1) continue;
      best = highest_along(best, channel, [&, from = best.azimuth](double steps) {
        return Place{best.elevation, from + steps * turn};
      });
    }
    change_ += std::abs(best.albedos[channel].value - before);
    return best;
  }

  /// The highest of the middle of a line, one step to either side and the vertex of the parabola through these.
  template <typename Line>
  Sample highest_along(const Sample& middle, std::size_t channel, const Line& line) {
    Sample best = middle;
    const auto values_at = [&](std::initializer_list<double> all_steps) -> std::vector<double> {
      std::vector<Place> places;
      for (const double steps : all_steps) {
        const Place place = line(steps);
        if (place.elevation >= grazing_.back() && place.elevation <= pi / 2) places.push_back(place);
      }
      std::vector<double> values;
      for (Sample& one : samples_at(places, options_.tolerance)) {
        values.push_back(one.albedos[channel].value);
        note_upper(one, channel);
        if (certain(one, channel) > certain(best, channel)) best = std::move(one);
      }
      return values;
    };
    const auto sides = values_at({-1, 1});
    if (sides.size() < 2) return best;
    const double bend = 2 * middle.albedos[channel].value - sides[0] - sides[1];
    const double vertex = (sides[1] - sides[0]) / (2 * bend);
    if (bend > 0 && std::abs(vertex) < 1) values_at({vertex});
    return best;
  }

  const Material& material_;
  AdaptiveAlbedo integral_;
  const PlausibilityOptions& options_;
  double turn_;                  // after which albedos are the same
  std::size_t azimuths_;         // over that
  double step_ = 0;              // between the angles of the scan
  std::vector<double> grazing_;  // elevations, falling
  std::vector<Sample> samples_;  // the scan, then the grazing ones by azimuth
  double change_ = 0;            // by the last round of the search
  double certain_ = 0;           // what the largest albedo of a channel is at least
  double upper_ = 0;             // how large an albedo may be at most, of those looked at
  std::size_t incident_ = 0;
  std::size_t unresolved_ = 0;
};

}  // namespace

AlbedoBounds albedo_bounds(const Device& device, const Material& material, bool is_isotropic,
                           const PlausibilityOptions& options) {
  return BoundSearch(device, material, is_isotropic, options).result();
}

}  // namespace lobe
