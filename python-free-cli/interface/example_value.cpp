#include "interface/example_value.hpp"

#include <algorithm>

namespace lobe::cli {

double example_value(const Parameter& parameter) {
  if (parameter.default_value) return *parameter.default_value;
  constexpr double kExponent = 20;
  constexpr double kRoughness = 0.2;
  if (parameter.minimum < 0) return std::min(1.0, parameter.maximum);
  const double usual = parameter.maximum > 100 ? kExponent : kRoughness;
  return std::clamp(usual, parameter.minimum, parameter.maximum);
}

}  // namespace lobe::cli
