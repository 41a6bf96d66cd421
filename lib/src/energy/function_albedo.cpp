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
#include "energy/elevation_integral.hpp"
#include "energy/function_albedo.hpp"
#include "energy/joint_albedo.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "table/ring_cells.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::RowVectorXd;
using std::numbers::pi;

constexpr double kMeanGoal = 2e-4;                // of means
constexpr std::size_t kMostPointsOfMean = 4'000;  // for each of its albedos
constexpr std::size_t kMostFunctionPanels = 12;   // of the elevation of L
constexpr std::size_t kAzimuths = 8;              // of L, in means of anisotropic functions

/// At once where the function allows it.
void for_each(const BrdfFunction& function, std::size_t count, const std::function<void(std::size_t)>& work) {
  if (function.is_concurrent) {
    parallel_for(count, work);
  } else {
    for (std::size_t k = 0; k < count; ++k) work(k);
  }
}

JointAlbedo albedo_of(const BrdfFunction& function, double lobe_width) {
  return {{&function, 1}, function.channels.size(), {.lobe_width = lobe_width}};
}

/// Mean over all L. Azimuths of anisotropic functions begin elsewhere at each elevation.
ElevationSums mean_of(const BrdfFunction& function, double lobe_width) {
  const JointAlbedo joint = albedo_of(function, lobe_width);
  const std::size_t turns = function.is_isotropic ? 1 : kAzimuths;
  const auto terms_at = [&](std::span<const ElevationPlace> places) {
    std::vector<JointSums> parts(places.size() * turns);
    for_each(function, parts.size(), [&](std::size_t k) {
      const auto [elevation, turn] = places[k / turns];
      const double azimuth = 2 * pi * (static_cast<double>(k % turns) + turn) / static_cast<double>(turns);
      parts[k] = joint.at({pi / 2 - elevation, azimuth}, kMeanGoal, kMostPointsOfMean);
    });
    const RowVectorXd zero = RowVectorXd::Zero(static_cast<Index>(function.channels.size()));
    const double share = 1 / static_cast<double>(turns);
    std::vector<ElevationTerms> terms;
    for (std::size_t k = 0; k < places.size(); ++k) {
      ElevationTerms& term = terms.emplace_back(ElevationTerms{zero, zero, {}, zero});
      if (turns > 1) term.odd = zero;
      for (std::size_t a = 0; a < turns; ++a) {
        const JointSums& part = parts[k * turns + a];
        term.value += share * part.value;
        term.square += (share * part.quadrature).cwiseAbs2();
        term.own += share * part.own;
        if (turns > 1) term.odd += (a % 2 == 1 ? share : -share) * part.value;
      }
    }
    return terms;
  };
  const auto channels = static_cast<Index>(function.channels.size());
  return integrate_elevations(
      terms_at, {.relative = kMeanGoal, .most_panels = kMostFunctionPanels, .steering = channels, .has_errors = true});
}

std::vector<std::vector<Estimate>> ring_albedos(const BrdfFunction& function, std::span<const Direction> incident) {
  std::vector<std::vector<Estimate>> albedos(function.channels.size());
  for (std::size_t c = 0; c < albedos.size(); ++c) {
    for (const Direction& in : incident) albedos[c].push_back(albedo(*function.ring_cells, c, in.theta));
  }
  return albedos;
}

}  // namespace

std::vector<std::vector<Estimate>> albedo(const BrdfFunction& function, std::span<const double> theta_in,
                                          double lobe_width) {
  std::vector<Direction> incident;
  for (const double theta : theta_in) incident.push_back({theta, 0});
  return albedo(function, incident, lobe_width);
}

std::vector<JointSums> albedo_sums(const BrdfFunction& function, std::span<const Direction> incident, double lobe_width,
                                   const AlbedoEffort& effort) {
  const JointAlbedo integral = albedo_of(function, lobe_width);
  std::vector<JointSums> sums(incident.size());
  for_each(function, incident.size(),
           [&](std::size_t k) { sums[k] = integral.at(incident[k], effort.relative, effort.most_points); });
  return sums;
}

std::vector<std::vector<Estimate>> albedo(const BrdfFunction& function, std::span<const Direction> incident,
                                          double lobe_width) {
  require_no_delta(function, "expected values alone");
  for (const auto& [theta, phi] : incident) {
    if (theta >= 0 && theta < pi / 2) continue;
    throw ArgumentError("angle of incidence of " + shortest(to_degrees(theta)) +
                        " degrees; expected a value in [0, 90) degrees");
  }
  if (function.ring_cells) return ring_albedos(function, incident);
  const std::vector<JointSums> sums = albedo_sums(function, incident, lobe_width);
  std::vector<std::vector<Estimate>> result(function.channels.size(), std::vector<Estimate>(incident.size()));
  for (std::size_t k = 0; k < incident.size(); ++k) {
    for (std::size_t c = 0; c < result.size(); ++c) {
      const auto at = static_cast<Index>(c);
      result[c][k] = {sums[k].value(at), sums[k].quadrature(at) + sums[k].own(at)};
    }
  }
  return result;
}

std::vector<Estimate> mean_albedo(const BrdfFunction& function, double lobe_width) {
  require_no_delta(function, "expected values alone");
  std::vector<Estimate> means;
  if (function.ring_cells) {
    for (std::size_t c = 0; c < function.channels.size(); ++c) means.push_back(mean_albedo(*function.ring_cells, c));
    return means;
  }
  const ElevationSums sums = mean_of(function, lobe_width);
  for (Index c = 0; c < sums.value.size(); ++c) means.push_back({sums.value(c), sums.error(c) + sums.own(c)});
  return means;
}

}  // namespace lobe
