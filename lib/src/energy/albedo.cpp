#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/text.hpp"
#include "energy/material_albedo.hpp"
#include "hemisphere/refinement.hpp"
#include "lobe/energy.hpp"
#include "lobe/error.hpp"

namespace lobe {
namespace {

std::string degrees(double radians) {
  return shortest(radians * 180 / std::numbers::pi) + " degrees";
}

/// Whether refinement changes values by as much as ever, as that of infinite integrals does; what is below a hundredth
/// is the accident of a level. \param levels the values of all levels of refinement
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

/// Values of all channels, to the tolerance or as near as the last level comes. \param missed what is told of these
/// \throws NumericError where they do not converge.
std::vector<Estimate> reached(const std::function<Eigen::ArrayXd(int)>& at_level, MissedTolerance missed,
                              const Material& material, double floor, const AlbedoOptions& options) {
  std::vector<Eigen::ArrayXd> levels;
  const auto noting = [&](int level) { return levels.emplace_back(at_level(level)); };
  const std::string what = missed.quantity;
  Refined result = refine(noting, what, material, floor, options.tolerance, kLevels);
  if (result.is_reached) return std::move(result.values);
  missed.quantity += " of '" + material.name + "'";
  missed.relative_error = result.worst;
  missed.tolerance = options.tolerance;
  if (is_divergent(levels)) throw NumericError(to_string(missed) + " and does not converge: it may be infinite");
  if (options.missed) options.missed(missed);
  return std::move(result.values);
}

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

  MaterialAlbedo integral(device, material, options.precision);
  // One direction at a time: easy ones stop early.
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const IncidentNode incident{std::numbers::pi / 2 - directions[k].theta, 1, directions[k].phi};
    const auto estimates = reached(
        [&](int level) -> Eigen::ArrayXd {
          return integral.at({&incident, 1}, level).col(0).array();
        },
        {.quantity = "albedo at " + degrees(directions[k].theta), .index = k}, material, integral.rounding(), options);
    for (std::size_t c = 0; c < result.size(); ++c) result[c][k] = estimates[c];
  }
  return result;
}

std::vector<Estimate> mean_albedo(const Device& device, const Material& material, const AlbedoOptions& options) {
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
  return reached(at_level, {.quantity = "mean albedo"}, material, integral.rounding(), options);
}

}  // namespace lobe
