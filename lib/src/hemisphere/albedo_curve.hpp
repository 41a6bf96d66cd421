#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lobe {

/// A function of the angle of incidence as kernels/pumping.clh evaluates it: Chebyshev series on panels that shrink
/// towards the normal, in sin(theta/2), and towards grazing incidence, in cos(theta).

/// Angles (radians) at which a curve is interpolated, kCurveTerms for each of kCurvePanels panels.
[[nodiscard]] const std::vector<double>& curve_angles();

/// The curve through values at these angles, kCurveNumbers numbers.
[[nodiscard]] std::vector<double> curve_through(std::span<const double> values);

/// What a curve's panels leave out, relative to the least of its values there: the worst of the last two terms.
/// \param values that it was made of
[[nodiscard]] double curve_remainder(std::span<const double> curve, std::span<const double> values);

/// Its value at a cosine in (0, 1].
[[nodiscard]] double curve_value(std::span<const double> curve, double cosine);

}  // namespace lobe
