#include "energy/function_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "energy/function_albedo.hpp"
#include "table/ring_cells.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using std::numbers::pi;

/// From all directions to those that may have the largest albedo, and along lines.
constexpr std::array kEfforts{AlbedoEffort{1e-3, 3'000}, AlbedoEffort{2e-4, 10'000}, AlbedoEffort{}};

class FunctionBoundSearch {
 public:
  FunctionBoundSearch(const BrdfFunction& function, const FunctionSearch& how)
      : function_(function), how_(how), azimuths_(function.is_isotropic ? 1 : how.azimuths) {}

  FunctionBounds result() {
    scan();
    FunctionBounds bounds;
    const std::size_t channels = function_.channels.size();
    for (std::size_t c = 0; c < channels; ++c) sharpen_candidates(c);
    for (std::size_t c = 0; c < channels; ++c) bounds.channels.push_back(bound(c));
    for (std::size_t c = 0; c < channels; ++c) bounds.certain.push_back(certain(c));
    bounds.incident = samples_.size();
    return bounds;
  }

 private:
  using Place = std::pair<double, double>;  ///< elevation and azimuth

  struct Sample {
    JointSums sums;
    std::size_t effort = 0;
  };

  /// Places, rising, that a line of albedos is looked at.
  using Line = std::vector<Place>;

  void evaluate(std::span<const Place> places, std::size_t effort) {
    std::vector<Place> open;
    for (const Place& place : places) {
      const auto known = samples_.find(place);
      if (known == samples_.end() || known->second.effort < effort) open.push_back(place);
    }
    std::vector<Direction> incident;
    for (const auto& [elevation, azimuth] : open) incident.push_back({pi / 2 - elevation, azimuth});
    const auto sums = albedo_sums(function_, incident, how_.lobe_width, kEfforts.at(effort));
    for (std::size_t k = 0; k < open.size(); ++k) samples_[open[k]] = {sums[k], effort};
  }

  /// Equal steps over the quarter circle, and half powers of 10 of the elevation towards grazing incidence.
  void scan() {
    const double span = pi / 2 - how_.least_elevation;
    const double step = span / static_cast<double>(how_.angles - 1);
    elevations_.push_back(how_.least_elevation);
    const double half_power = std::sqrt(10.0);
    for (double e = half_power * elevations_.front(); e < elevations_.front() + step / 2; e *= half_power) {
      elevations_.push_back(e);
    }
    for (std::size_t i = 1; i < how_.angles; ++i) {
      elevations_.push_back(i + 1 == how_.angles ? pi / 2 : how_.least_elevation + static_cast<double>(i) * step);
    }
    std::vector<Place> places;
    for (const double elevation : elevations_) {
      for (std::size_t k = 0; k < azimuths_; ++k) places.emplace_back(elevation, azimuth(static_cast<double>(k)));
    }
    evaluate(places, 0);
  }

  [[nodiscard]] double azimuth(double k) const { return 2 * pi * k / static_cast<double>(azimuths_); }

  [[nodiscard]] double merit(const Sample& sample, std::size_t channel) const {
    const double value = sample.sums.value(static_cast<Index>(channel));
    return how_.of_absolute ? std::abs(value) : value;
  }

  [[nodiscard]] static double quadrature(const Sample& sample, std::size_t channel) {
    return sample.sums.quadrature(static_cast<Index>(channel));
  }

  /// Of the quadrature and of the function's own values; NaN where that of the values is not known.
  [[nodiscard]] static double error_of(const Sample& sample, std::size_t channel) {
    return quadrature(sample, channel) + sample.sums.own(static_cast<Index>(channel));
  }

  [[nodiscard]] Place highest(std::size_t channel) const {
    return std::ranges::max_element(samples_, {}, [&](const auto& one) { return merit(one.second, channel); })->first;
  }

  /// Computes anew, better and better, what may be the largest.
  void sharpen_candidates(std::size_t channel) {
    for (std::size_t effort = 1; effort < kEfforts.size(); ++effort) {
      const Sample& top = samples_.at(highest(channel));
      const double least = merit(top, channel) - quadrature(top, channel);
      std::vector<Place> candidates;
      for (const auto& [place, sample] : samples_) {
        if (merit(sample, channel) + quadrature(sample, channel) >= least) candidates.push_back(place);
      }
      evaluate(candidates, effort);
    }
  }

  AlbedoBound bound(std::size_t channel) {
    Place best = highest(channel);
    double beyond = 0;
    if (azimuths_ == 1) {
      beyond = climb_hills(best, channel);
    } else {
      constexpr int kTurns = 2;
      for (int turn = 0; turn < kTurns; ++turn) {
        const double along = climb(best, channel, neighbours_of(best.first, best.second));
        const double step = azimuth(1);
        const Place middle = best;
        const double across =
            climb(best, channel, {{middle.first, middle.second - step}, middle, {middle.first, middle.second + step}});
        beyond = along + across;
      }
    }
    const Sample& top = samples_.at(best);
    const double error = error_of(top, channel);
    // An albedo that is less certain may be larger.
    double upper = -std::numeric_limits<double>::infinity();
    for (const auto& [place, sample] : samples_) {
      const double other = error_of(sample, channel);
      if (!std::isnan(other)) upper = std::max(upper, merit(sample, channel) + other);
    }
    return {{merit(top, channel), std::max(error, upper - merit(top, channel)) + beyond},
            {pi / 2 - best.first, best.second},
            {}};
  }

  /// A place of the scan that is not below its neighbours, and what the albedo beside it may be at most.
  struct Hill {
    Place place;
    double most;
  };

  /// Climbs the hills of the scan whose tops may be the highest, up to some: a lower one may have a narrow top.
  /// \return by how much the albedo may be larger than at the best place
  double climb_hills(Place& best, std::size_t channel) {
    constexpr std::size_t kMost = 6;
    std::vector<Hill> hills;
    for (const double elevation : elevations_) {
      const Line line = neighbours_of(elevation, 0);
      const auto at = static_cast<std::size_t>(std::ranges::find(line, Place(elevation, 0.0)) - line.begin());
      if (highest_of(line, channel) != at) continue;
      const Sample& sample = samples_.at(line[at]);
      hills.push_back({line[at], merit(sample, channel) + quadrature(sample, channel) + beside(line, at, channel)});
    }
    std::ranges::sort(hills, std::ranges::greater{}, &Hill::most);
    double most = 0;
    for (std::size_t k = 0; k < hills.size() && k < kMost; ++k) {
      if (k > 0 && hills[k].most < merit(samples_.at(best), channel)) break;
      Place top = hills[k].place;
      const double beyond = climb(top, channel, neighbours_of(top.first, top.second));
      most = std::max(most, merit(samples_.at(top), channel) + beyond);
      if (merit(samples_.at(top), channel) > merit(samples_.at(best), channel)) best = top;
    }
    return std::max(most - merit(samples_.at(best), channel), 0.0);
  }

  [[nodiscard]] std::size_t highest_of(const Line& line, std::size_t channel) const {
    const auto value = [&](const Place& place) { return merit(samples_.at(place), channel); };
    return static_cast<std::size_t>(std::ranges::max_element(line, {}, value) - line.begin());
  }

  /// By how much the albedo may be larger between the highest place of a line and its neighbours, if it bends down
  /// there: a chord from one side, continued beyond the highest place, is above it.
  [[nodiscard]] double beside(const Line& line, std::size_t top, std::size_t channel) const {
    const auto fall = [&](std::size_t k) {
      return merit(samples_.at(line[top]), channel) - merit(samples_.at(line[k]), channel);
    };
    const auto gap = [&](std::size_t k) {
      return std::abs(line[k].first - line[top].first) + std::abs(line[k].second - line[top].second);
    };
    if (top == 0) return fall(1);
    if (top + 1 == line.size()) return fall(top - 1);
    return std::max(fall(top - 1) * gap(top + 1) / gap(top - 1), fall(top + 1) * gap(top - 1) / gap(top + 1));
  }

  /// An elevation and those beside it in the first scan.
  [[nodiscard]] Line neighbours_of(double elevation, double azimuth) const {
    Line line;
    const auto above = std::ranges::upper_bound(elevations_, elevation);
    auto below = std::ranges::lower_bound(elevations_, elevation);
    if (below != elevations_.begin()) line.emplace_back(*--below, azimuth);
    line.emplace_back(elevation, azimuth);
    if (above != elevations_.end()) line.emplace_back(*above, azimuth);
    return line;
  }

  /// Moves to the highest place of a line, looking between it and its neighbours again and again.
  /// \return by how much the albedo may be larger between the last ones, as beside()
  double climb(Place& best, std::size_t channel, Line line) {
    constexpr int kRounds = 3;
    constexpr int kParts = 4;
    const std::size_t precise = kEfforts.size() - 1;
    for (int round = 0;; ++round) {
      evaluate(line, precise);
      const std::size_t top = highest_of(line, channel);
      best = line[top];
      if (round == kRounds) return beside(line, top, channel);
      Line finer;
      const std::size_t first = top == 0 ? 0 : top - 1;
      const std::size_t last = std::min(top + 1, line.size() - 1);
      for (std::size_t k = first; k < last; ++k) {
        for (int part = 0; part < kParts; ++part) {
          const double share = static_cast<double>(part) / kParts;
          finer.emplace_back(std::lerp(line[k].first, line[k + 1].first, share),
                             std::lerp(line[k].second, line[k + 1].second, share));
        }
      }
      finer.push_back(line[last]);
      line = std::move(finer);
    }
  }

  /// The largest albedo less its error.
  [[nodiscard]] double certain(std::size_t channel) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const auto& [place, sample] : samples_) {
      const double own = sample.sums.own(static_cast<Index>(channel));
      most = std::max(most, merit(sample, channel) - quadrature(sample, channel) - (std::isnan(own) ? 0 : own));
    }
    return most;
  }

  const BrdfFunction& function_;
  const FunctionSearch& how_;
  std::size_t azimuths_;
  std::vector<double> elevations_;  // of the scan, rising
  std::map<Place, Sample> samples_;
};

/// The largest of a finite number of albedos.
FunctionBounds bounds_of_rings(const BrdfFunction& function, const FunctionSearch& how) {
  const RingCells& cells = *function.ring_cells;
  const auto rings = static_cast<double>(cells.rings);
  FunctionBounds bounds;
  for (std::size_t c = 0; c < function.channels.size(); ++c) {
    AlbedoBound& bound = bounds.channels.emplace_back();
    bounds.certain.push_back(-std::numeric_limits<double>::infinity());
    bound.largest.value = bounds.certain.back();
    double upper = bounds.certain.back();
    for (std::size_t ring = 0; ring < cells.rings; ++ring) {
      const auto sine = [&](double share) { return (static_cast<double>(ring) + share) / rings; };
      if (sine(0) > std::cos(how.least_elevation)) break;
      const double theta = std::min(std::asin(sine(0.5)), pi / 2 - how.least_elevation);
      Estimate found = albedo(cells, c, theta);
      if (how.of_absolute) found.value = std::abs(found.value);
      bounds.certain.back() = std::max(bounds.certain.back(), found.value - found.error);
      upper = std::max(upper, found.value + found.error);
      if (found.value > bound.largest.value) bound = {found, {theta, 0}, {}};
    }
    bound.largest.error = std::max(bound.largest.error, upper - bound.largest.value);
  }
  bounds.incident = cells.rings;
  return bounds;
}

}  // namespace

FunctionBounds albedo_bounds(const BrdfFunction& function, const FunctionSearch& how) {
  if (function.ring_cells) return bounds_of_rings(function, how);
  return FunctionBoundSearch(function, how).result();
}

}  // namespace lobe
