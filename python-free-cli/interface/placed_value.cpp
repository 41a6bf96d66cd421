#include "interface/placed_value.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

namespace lobe::cli {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

}  // namespace

std::string text_of(const PlacedValue& placed) {
  const std::string value =
      std::isnan(placed.value.error) ? fmt::format("{:.6g}", placed.value.value) : format_estimate(placed.value);
  return fmt::format("{} sr^-1 at theta_in {:.1f}°, theta_out {:.1f}°, delta_phi {:.1f}°", value,
                     placed.at.theta_in * kDegreesPerRadian, placed.at.theta_out * kDegreesPerRadian,
                     placed.at.delta_phi * kDegreesPerRadian);
}

Json json_of(const PlacedValue& placed) {
  return {{"brdf", to_json(placed.value)},
          {"theta_in_deg", placed.at.theta_in * kDegreesPerRadian},
          {"theta_out_deg", placed.at.theta_out * kDegreesPerRadian},
          {"delta_phi_deg", placed.at.delta_phi * kDegreesPerRadian}};
}

}  // namespace lobe::cli
