#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "hemisphere/albedo_rule.hpp"
#include "lobe/energy.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kBlock = 4096;  // nodes
constexpr int kCoarse = 0;            // levels of quadrature, far enough apart not to agree by accident
constexpr int kFine = 2;
constexpr std::size_t kAzimuths = 16;  // of L, in means of anisotropic functions
constexpr double kSafety = 3;          // of the difference of both: measured functions have kinks and jumps

/// Sums over the hemisphere of V, by channel.
struct Sums {
  Eigen::RowVectorXd value;
  Eigen::RowVectorXd error;
};

/// Both signs of delta_phi, of bilateral functions one for both.
void add_views(const BrdfFunction& function, const Direction& in, std::span<const ViewNode> views, Sums& sums) {
  constexpr double kHighest = pi / 2 - 1e-12;  // functions are defined above the horizon
  const std::size_t signs = function.is_bilateral ? 1 : 2;
  std::vector<Directions> pairs;
  Eigen::RowVectorXd weights(static_cast<Eigen::Index>(signs * views.size()));
  for (const ViewNode& view : views) {
    for (std::size_t sign = 0; sign < signs; ++sign) {
      weights(static_cast<Eigen::Index>(pairs.size())) = view.factor / static_cast<double>(signs);
      const double theta_out = std::clamp(pi / 2 - view.elevation, 0.0, kHighest);
      pairs.push_back({in.theta, theta_out, sign == 0 ? pi - view.psi : view.psi - pi, in.phi});
    }
  }
  const BrdfValues values = function.at(pairs);
  if (!values.value.allFinite()) throw NumericError("'" + function.name + "' has values that are no finite numbers");
  sums.value += weights * values.value;
  if (values.error.size() > 0) sums.error += weights * values.error;
}

/// At once where the function allows it.
void for_each(const BrdfFunction& function, std::size_t count, const std::function<void(std::size_t)>& work) {
  if (function.is_concurrent) {
    parallel_for(count, work);
  } else {
    for (std::size_t k = 0; k < count; ++k) work(k);
  }
}

Sums integrate(const BrdfFunction& function, const AlbedoRule& rule, const Direction& in, int level) {
  const auto channels = static_cast<Eigen::Index>(function.channels.size());
  Sums sums{Eigen::RowVectorXd::Zero(channels), Eigen::RowVectorXd::Zero(channels)};
  const auto views = rule.view_nodes(pi / 2 - in.theta, level);
  for (std::size_t first = 0; first < views.size(); first += kBlock) {
    add_views(function, in, std::span(views).subspan(first, std::min(kBlock, views.size() - first)), sums);
  }
  return sums;
}

/// Mean over all L. Azimuths of anisotropic functions begin elsewhere at each elevation.
Sums integrate(const BrdfFunction& function, const AlbedoRule& rule, int level) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<IncidentNode> incident;
  for (std::size_t slab = 0; slab < rule.slabs(); ++slab) {
    const auto nodes = rule.incident_nodes(slab, level);
    incident.insert(incident.end(), nodes.begin(), nodes.end());
  }
  const std::size_t azimuths = function.is_isotropic ? 1 : kAzimuths;
  const Eigen::RowVectorXd zero = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(function.channels.size()));
  std::vector<Sums> parts(incident.size(), {zero, zero});
  const auto integrate_at = [&](std::size_t k) {
    const double turn = kGolden * static_cast<double>(k) + 0.37 * level;
    for (std::size_t a = 0; a < azimuths; ++a) {
      const double step = 2 * pi / static_cast<double>(azimuths);
      const double azimuth = step * (static_cast<double>(a) + turn - std::floor(turn));
      const Sums part = integrate(function, rule, {pi / 2 - incident[k].elevation, azimuth}, level);
      const double weight = incident[k].weight / (pi * static_cast<double>(azimuths));
      parts[k].value += weight * part.value;
      parts[k].error += weight * part.error;
    }
  };
  for_each(function, incident.size(), integrate_at);
  Sums sums{zero, zero};
  for (const Sums& part : parts) {
    sums.value += part.value;
    sums.error += part.error;
  }
  return sums;
}

Estimate estimate(const Sums& coarse, const Sums& fine, std::size_t channel) {
  const auto at = static_cast<Eigen::Index>(channel);
  return {fine.value(at), kSafety * std::abs(fine.value(at) - coarse.value(at)) + fine.error(at)};
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
  const AlbedoRule rule(LobeExtent{.width = lobe_width, .patch_radii = {}, .retro_patch_radii = {}});
  std::vector<std::vector<Estimate>> result(function.channels.size(), std::vector<Estimate>(incident.size()));
  const auto integrate_at = [&](std::size_t k) {
    const Sums coarse = integrate(function, rule, incident[k], kCoarse);
    const Sums fine = integrate(function, rule, incident[k], kFine);
    for (std::size_t c = 0; c < result.size(); ++c) result[c][k] = estimate(coarse, fine, c);
  };
  for_each(function, incident.size(), integrate_at);
  return result;
}

std::vector<Estimate> mean_albedo(const BrdfFunction& function, double lobe_width) {
  require_no_delta(function, "expected values alone");
  const AlbedoRule rule(LobeExtent{.width = lobe_width, .patch_radii = {}, .retro_patch_radii = {}});
  const Sums coarse = integrate(function, rule, 0);
  const Sums fine = integrate(function, rule, 1);
  std::vector<Estimate> means;
  for (std::size_t c = 0; c < function.channels.size(); ++c) means.push_back(estimate(coarse, fine, c));
  return means;
}

}  // namespace lobe
