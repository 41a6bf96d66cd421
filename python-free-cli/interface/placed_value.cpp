#include "interface/placed_value.hpp"
#include "lobe/core/directions.hpp"

#include <fmt/core.h>

#include <cmath>

namespace lobe::cli {

std::string degree_text(double radians) {
  const std::string text = fmt::format("{:.1f}", to_degrees(radians));
  return text == "-0.0" ? "0.0°" : text + "°";
}

std::string text_of(const PlacedValue& placed) {
  const std::string value =
      std::isnan(placed.value.error) ? fmt::format("{:.6g}", placed.value.value) : format_estimate(placed.value);
  return fmt::format("{} sr^-1 at {}", value, pair_text(placed.at));
}

std::string pair_text(const Directions& at) {
  return fmt::format("theta_in {}, theta_out {}, delta_phi {}", degree_text(at.theta_in), degree_text(at.theta_out),
                     degree_text(at.delta_phi));
}

Json json_of(const PlacedValue& placed) {
  return {{"brdf", to_json(placed.value)},
          {"theta_in_deg", to_degrees(placed.at.theta_in)},
          {"theta_out_deg", to_degrees(placed.at.theta_out)},
          {"delta_phi_deg", to_degrees(placed.at.delta_phi)}};
}

}  // namespace lobe::cli
