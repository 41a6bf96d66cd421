#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/text.hpp"
#include "lobe/model/model.hpp"
#include "support/random_materials.hpp"

namespace lobe::test {

/// A value of a parameter over its whole range, evenly by logarithm where it is positive and wide.
inline double random_value(Dice& dice, const Parameter& parameter) {
  constexpr double kMost = 1000;
  constexpr double kLeast = 1e-3;
  const double high = std::min(parameter.maximum, kMost);
  const double low = std::max(parameter.minimum, -kMost);
  if (low < 0) return dice.uniform(std::max(low, -1.0), std::min(high, 1.0));
  const double start = std::max(low, std::min(kLeast, 0.01 * high));
  return high > 10 * start ? dice.spread(start, high) : dice.uniform(low, high);
}

/// "name:p=0.3,q=7".
template <typename Entry>
std::string random_specification(Dice& dice, const Entry& entry) {
  std::string text(entry.name);
  for (std::size_t k = 0; k < entry.parameters.size(); ++k) {
    text += (k == 0 ? ":" : ",") + std::string(entry.parameters[k].name) + "=" +
            shortest(random_value(dice, entry.parameters[k]));
  }
  return text;
}

}  // namespace lobe::test
