// Albedos of reflectances, however these are known.
#include <functional>

#include "energy/albedo.hpp"
#include "energy/known_as.hpp"
#include "table/evaluate.hpp"

namespace lobe {

std::vector<std::vector<Estimate>> albedo(const Device& device, const Reflectance& reflectance,
                                          std::span<const double> theta_in, const AlbedoOptions& options) {
  std::vector<Direction> incident;
  for (const double theta : theta_in) incident.push_back({theta, 0});
  return albedo(device, reflectance, incident, options);
}

std::vector<std::vector<Estimate>> albedo(const Device& device, const Reflectance& reflectance,
                                          std::span<const Direction> incident, const AlbedoOptions& options) {
  return known_as(device, reflectance,
                  Cases{[&](const Material& formula) { return albedo(device, formula, incident, options); },
                        [&](const BrdfFunction& function) { return albedo(function, incident, options.lobe_width); },
                        [&](const BrdfTable& table) { return albedo(table, incident); }});
}

std::vector<Estimate> mean_albedo(const Device& device, const Reflectance& reflectance, const AlbedoOptions& options) {
  return known_as(device, reflectance,
                  Cases{[&](const Material& formula) { return mean_albedo(device, formula, options); },
                        [&](const BrdfFunction& function) { return mean_albedo(function, options.lobe_width); },
                        [&](const BrdfTable& table) { return row_albedos(table).mean; }});
}

}  // namespace lobe
