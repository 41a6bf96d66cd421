#pragma once

#include <algorithm>
#include <cmath>

namespace [[gnu::visibility("default")]] lobe {

/// A computed number and a bound on its quadrature and rounding error, both in the unit of the value.
struct Estimate {
  double value = 0;  ///< the computed quantity
  double error = 0;  ///< bound on its deviation from the true value
};

/// Adds a term; errors add up.
inline Estimate& operator+=(Estimate& sum, const Estimate& term) {
  sum.value += term.value;
  sum.error += term.error;
  return sum;
}

/// Sum of two estimates; errors add up.
[[nodiscard]] inline Estimate operator+(Estimate a, const Estimate& b) {
  return a += b;
}

/// Multiple of an estimate, by an exact factor.
[[nodiscard]] inline Estimate operator*(double factor, const Estimate& estimate) {
  return {factor * estimate.value, std::abs(factor) * estimate.error};
}

/// Product of two estimates, with the largest error that theirs allow.
[[nodiscard]] inline Estimate operator*(const Estimate& a, const Estimate& b) {
  return {a.value * b.value, a.error * std::abs(b.value) + std::abs(a.value) * b.error + a.error * b.error};
}

/// Quotient of two estimates. Its error is of first order in the relative errors, which have to be small.
[[nodiscard]] inline Estimate operator/(const Estimate& a, const Estimate& b) {
  const double value = a.value / b.value;
  return {value, (a.error + std::abs(value) * b.error) / std::abs(b.value)};
}

/// Root of a square. A square below 0, as errors make it from 0, counts as 0.
[[nodiscard]] inline Estimate square_root(const Estimate& square) {
  const double value = std::sqrt(std::max(square.value, 0.0));
  return {value, value > 0 ? std::min(square.error / value, std::sqrt(square.error)) : std::sqrt(square.error)};
}

}  // namespace lobe
