#pragma once

#include <cmath>
#include <cstddef>

namespace lobe {

/// The samples of an axis on both sides of a place, and how much of the upper one there is in between.
struct Neighbours {
  std::size_t below;
  std::size_t above;
  double share;

  [[nodiscard]] double mix(double at_below, double at_above) const { return at_below + share * (at_above - at_below); }
};

/// Places within rounding of a sample are that sample, so that it is met to the last bit.
inline double snapped(double place) {
  constexpr double kRounding = 1e-7;  // in steps, of angles that went through sines and arc tangents
  const double nearest = std::round(place);
  return std::abs(place - nearest) < kRounding ? nearest : place;
}

/// On an axis with ends, beyond which the outermost samples hold.
/// \param place in steps from the first of `count`
inline Neighbours clamped_neighbours(double place, std::size_t count) {
  const double at = snapped(place);
  if (!(at > 0)) return {0, 0, 0};
  if (at >= static_cast<double>(count - 1)) return {count - 1, count - 1, 0};
  const auto below = static_cast<std::size_t>(at);
  return {below, below + 1, at - static_cast<double>(below)};
}

/// On an axis that closes after `count` samples.
/// \param place in steps from the first, of any sign
inline Neighbours periodic_neighbours(double place, std::size_t count) {
  const double floor = std::floor(snapped(place));
  const auto period = static_cast<double>(count);
  const auto below = static_cast<std::size_t>(floor - period * std::floor(floor / period)) % count;
  return {below, below + 1 == count ? 0 : below + 1, snapped(place) - floor};
}

}  // namespace lobe
