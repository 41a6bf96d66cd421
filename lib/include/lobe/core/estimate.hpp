#pragma once

#include <algorithm>
#include <cmath>

namespace [[gnu::visibility("default")]] lobe {

/// A computed number and a bound on its quadrature and rounding error, both in the unit of the value.
struct Estimate {
  double value = 0;  ///< the quantity itself
  double error = 0;  ///< what it may be off by
};

inline Estimate& operator+=(Estimate& sum, const Estimate& term) {
  sum.value += term.value;
  sum.error += term.error;
  return sum;
}

[[nodiscard]] inline Estimate operator+(Estimate a, const Estimate& b) {
  return a += b;
}

[[nodiscard]] inline Estimate operator*(double factor, const Estimate& estimate) {
  return {factor * estimate.value, std::abs(factor) * estimate.error};
}

[[nodiscard]] inline Estimate operator*(const Estimate& a, const Estimate& b) {
  return {a.value * b.value, a.error * std::abs(b.value) + std::abs(a.value) * b.error + a.error * b.error};
}

/// A quotient. Its error is that of first order in the relative errors, which have to be small.
[[nodiscard]] inline Estimate operator/(const Estimate& a, const Estimate& b) {
  const double value = a.value / b.value;
  return {value, (a.error + std::abs(value) * b.error) / std::abs(b.value)};
}

/// The root of a square. A square below 0 is taken for 0, from which its error has made it.
[[nodiscard]] inline Estimate square_root(const Estimate& square) {
  const double value = std::sqrt(std::max(square.value, 0.0));
  return {value, value > 0 ? std::min(square.error / value, std::sqrt(square.error)) : std::sqrt(square.error)};
}

}  // namespace lobe
