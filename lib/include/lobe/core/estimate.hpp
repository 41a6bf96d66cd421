#pragma once

namespace [[gnu::visibility("default")]] lobe {

/// A computed number and a bound on its quadrature and rounding error, both in the unit of the value.
struct Estimate {
  double value = 0;  ///< the quantity itself
  double error = 0;  ///< what it may be off by
};

}  // namespace lobe
