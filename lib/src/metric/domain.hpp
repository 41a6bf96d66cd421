#pragma once

#include <string>

#include "lobe/metric/lighting.hpp"

namespace lobe {

/// Cosine of the largest angle of a domain (MetricOptions::theta_max), 0 for the whole hemisphere.
/// \throws ArgumentError for angles out of (0, pi/2], and for domains under patch lights and tabulated ones.
[[nodiscard]] double cos_of_domain(double theta_max, const Lighting& lighting);

/// Converts the angle to degrees, without the rounding of its conversion to radians.
[[nodiscard]] double degrees_of_domain(double theta_max);

/// What messages advise where a norm over the whole hemisphere does not exist: a smaller domain, under a lighting that
/// has domains.
[[nodiscard]] std::string domain_advice(const Lighting& lighting);

}  // namespace lobe
