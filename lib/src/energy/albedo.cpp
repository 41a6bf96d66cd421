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

/// \throws NumericError where the tolerance is not met
std::vector<Estimate> reached(const std::function<Eigen::ArrayXd(int)>& at_level, const std::string& what,
                              const Material& material, double floor, const AlbedoOptions& options) {
  Refined result = refine(at_level, what, material, floor, options.tolerance, kLevels);
  if (!result.is_reached) {
    throw NumericError(what + " of '" + material.name + "' reaches a relative error of " + shortest(result.worst) +
                       " only; expected " + shortest(options.tolerance) + ", give a larger tolerance");
  }
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
        "albedo at " + degrees(directions[k].theta), material, integral.rounding(), options);
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
  return reached(at_level, "mean albedo", material, integral.rounding(), options);
}

}  // namespace lobe
