#pragma once

#include <cmath>

namespace lobe {

/// A computed number and a bound on its quadrature and rounding error, both in the unit of the value.
struct Estimate {
  double value = 0;  ///< the quantity itself
  double error = 0;  ///< what it may be off by
};

/// The quotient of two numbers, with the error that theirs may do to it, to first order.
[[nodiscard]] inline Estimate quotient(const Estimate& a, const Estimate& b) {
  const double value = a.value / b.value;
  return {value, (a.error + std::abs(value) * b.error) / std::abs(b.value)};
}

}  // namespace lobe
