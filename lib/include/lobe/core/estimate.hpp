#pragma once

namespace lobe {

/// A computed number and a bound on its quadrature and rounding error, both in the unit of the value.
struct Estimate {
  double value = 0;  ///< the computed quantity
  double error = 0;  ///< bound on its deviation from the true value
};

}  // namespace lobe
