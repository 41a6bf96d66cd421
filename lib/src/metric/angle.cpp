#include <algorithm>
#include <cmath>
#include <limits>

#include "lobe/metric/metric.hpp"

namespace lobe {
namespace {

// Rounding of every input number, beside its stated error.
constexpr double kAngleRounding = 4 * std::numeric_limits<double>::epsilon();

struct Range {
  double low = 0;
  double high = 0;
};

Range range_of(double value, double error) {
  const double reach = error + kAngleRounding * std::abs(value);
  return {value - reach, value + reach};
}

/// \param divisor above 0
Range divided(const Range& range, const Range& divisor) {
  return {range.low / (range.low < 0 ? divisor.low : divisor.high),
          range.high / (range.high < 0 ? divisor.high : divisor.low)};
}

/// Squares of a range of numbers.
Range squared(const Range& range) {
  const double low = std::max({0.0, range.low, -range.high});
  const double high = std::max(std::abs(range.low), std::abs(range.high));
  return {low * low, high * high};
}

Estimate within(double value, const Range& range) {
  return {value, std::max(range.high - value, value - range.low)};
}

/// Angle from |f - g|^2 - (|f| - |g|)^2 = |f| |g| chord^2, with the chord between the normalised vectors.
Estimate angle_by_chord(const Estimate& distance, const Estimate& a, const Estimate& b, const Range& norms) {
  const auto angle = [](double square) { return 2 * std::asin(std::min(1.0, std::sqrt(std::max(0.0, square)) / 2)); };
  const double difference = a.value - b.value;
  const Range far = squared(range_of(distance.value, distance.error));
  const Range unlike = squared({difference - a.error - b.error - kAngleRounding * (a.value + b.value),
                                difference + a.error + b.error + kAngleRounding * (a.value + b.value)});
  const Range square = divided({far.low - unlike.high, far.high - unlike.low}, norms);
  const double value = (distance.value - difference) * (distance.value + difference) / (a.value * b.value);
  return within(angle(value), {angle(square.low), angle(square.high)});
}

Estimate angle_by_product(const Estimate& product, const Estimate& a, const Estimate& b, const Range& norms) {
  const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
  const Range cosine = divided(range_of(product.value, product.error), norms);
  return within(angle(product.value / (a.value * b.value)), {angle(cosine.high), angle(cosine.low)});
}

}  // namespace

Estimate angle(const Metric& metric, std::size_t i, std::size_t j) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto row = static_cast<Eigen::Index>(i);
  const auto column = static_cast<Eigen::Index>(j);
  const Estimate a{metric.norm(row), metric.norm_error(row)};
  const Estimate b{metric.norm(column), metric.norm_error(column)};
  const Estimate distance{metric.distance(row, column), metric.distance_error(row, column)};
  const Estimate product{metric.gram(row, column), metric.gram_error(row, column)};
  const bool is_known = !std::isnan(a.error + b.error + distance.error + product.error);
  const Range norm_a = range_of(a.value, is_known ? a.error : 0);
  const Range norm_b = range_of(b.value, is_known ? b.error : 0);
  if (!(norm_a.low > 0 && norm_b.low > 0)) return {kNone, kNone};

  const Range norms{norm_a.low * norm_b.low, norm_a.high * norm_b.high};
  const Estimate by_chord = angle_by_chord(distance, a, b, norms);
  const Estimate by_product = angle_by_product(product, a, b, norms);
  // Errors unknown: the chord does not cancel for near-parallel vectors.
  if (!is_known) return {by_chord.value, kNone};
  return by_product.error < by_chord.error ? by_product : by_chord;
}

}  // namespace lobe
