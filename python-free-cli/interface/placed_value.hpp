#pragma once

#include <string>

#include "interface/report.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/table/least_value.hpp"

namespace lobe::cli {

/// "12.3°", and "0.0°" for whatever rounds to it, from below, too.
[[nodiscard]] std::string degree_text(double radians);

/// "theta_in 3.0°, theta_out 4.0°, delta_phi 180.0°"
[[nodiscard]] std::string pair_text(const Directions& at);

/// "-0.01 ± 0.002 sr^-1 at theta_in 3.0°, theta_out 4.0°, delta_phi 180.0°"
[[nodiscard]] std::string text_of(const PlacedValue& value);
[[nodiscard]] Json json_of(const PlacedValue& value);

}  // namespace lobe::cli
