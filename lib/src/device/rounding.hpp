#pragma once

#include <limits>

#include "lobe/device/device.hpp"

namespace lobe {

/// The difference between 1 and the next larger number.
[[nodiscard]] constexpr double epsilon_of(Precision precision) {
  return precision == Precision::single_precision ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                                  : std::numeric_limits<double>::epsilon();
}

/// Bound on the relative rounding error of a product of two samples summed over nodes: samples carry a few ulp times
/// the size of their exponent, sums a few ulp per block of nodes.
[[nodiscard]] constexpr double product_rounding(Precision precision) {
  return precision == Precision::single_precision ? 8e-6 : 2e-14;
}

}  // namespace lobe
