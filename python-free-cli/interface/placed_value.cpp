#include "interface/placed_value.hpp"
#include "lobe/core/directions.hpp"

#include <fmt/core.h>

#include <cmath>

namespace lobe::cli {
namespace {}  // namespace

std::string text_of(const PlacedValue& placed) {
  const std::string value =
      std::isnan(placed.value.error) ? fmt::format("{:.6g}", placed.value.value) : format_estimate(placed.value);
  return fmt::format("{} sr^-1 at theta_in {:.1f}°, theta_out {:.1f}°, delta_phi {:.1f}°", value,
                     to_degrees(placed.at.theta_in), to_degrees(placed.at.theta_out), to_degrees(placed.at.delta_phi));
}

Json json_of(const PlacedValue& placed) {
  return {{"brdf", to_json(placed.value)},
          {"theta_in_deg", to_degrees(placed.at.theta_in)},
          {"theta_out_deg", to_degrees(placed.at.theta_out)},
          {"delta_phi_deg", to_degrees(placed.at.delta_phi)}};
}

}  // namespace lobe::cli
