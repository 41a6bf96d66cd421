#include "metric/domain.hpp"

#include <cmath>
#include <numbers>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "metric/lighting_traits.hpp"

namespace lobe {

double cos_of_domain(double theta_max, const Lighting& lighting) {
  if (!(theta_max > 0 && theta_max <= std::numbers::pi / 2)) {
    throw ArgumentError("the largest angle of the product's domain is " + shortest(degrees_of_domain(theta_max)) +
                        " degrees; expected a value above 0, at most 90");
  }
  if (theta_max == std::numbers::pi / 2) return 0;
  if (traits_of(lighting).has_operator) {
    throw ArgumentError("lighting '" + lighting.name() +
                        "' has no products up to a largest angle: the quadrature for its W is one of whole "
                        "hemispheres; expected point, daylight or mean-albedo");
  }
  return std::cos(theta_max);
}

std::string domain_advice(const Lighting& lighting) {
  const std::string_view where = traits_of(lighting).has_operator ? "under 'point' or 'daylight' " : "";
  return "measure it " + std::string(where) + "up to a largest angle, such as 80 degrees";
}

double degrees_of_domain(double theta_max) {
  return std::round(to_degrees(theta_max) * 1e9) / 1e9;
}

}  // namespace lobe
