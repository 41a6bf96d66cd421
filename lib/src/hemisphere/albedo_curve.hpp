#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lobe {

/// A function of the angle of incidence as kernels/lobes/pumping.clh evaluates it: Chebyshev series on panels that
/// shrink towards the normal, in sin(theta/2), and towards grazing incidence, in cos(theta). Around a kink parts of
/// panels have series of their own. A curve's numbers are the kCurveNumbers of its panels, then kPartNumbers for each
/// such part.

inline constexpr std::size_t kMostCurveParts = 128;

/// Angles (radians) at which the panels of a curve are interpolated, kCurveTerms for each of kCurvePanels.
[[nodiscard]] const std::vector<double>& curve_angles();

/// These and the angles at which its parts are.
[[nodiscard]] std::vector<double> curve_angles(std::span<const double> curve);

/// Values of a function at angles of incidence (radians).
using ValuesAtAngles = std::function<std::vector<double>(std::span<const double> theta)>;

struct FittedCurve {
  std::vector<double> curve;
  double remainder;  ///< what its series leave out, relative to the least value of each: the last two terms
};

/// The curve of a function above 0. Panels on which it is not smooth, and parts of them, are halved until no more than
/// `enough` is left out, or there are kMostCurveParts.
[[nodiscard]] FittedCurve fit_curve(const ValuesAtAngles& values_at, double enough);

/// Describes a fault in the numbers of a curve, as "has 12 numbers; expected ..."; empty if there is none.
[[nodiscard]] std::string fault_of_curve(std::span<const double> curve);

/// A curve as the device takes it: with the numbers of parts before each panel, filled up to `parts`.
[[nodiscard]] std::vector<double> padded_curve(std::span<const double> curve, std::size_t parts);

/// How many parts a curve has.
[[nodiscard]] std::size_t parts_of(std::span<const double> curve);

/// Its value at a cosine in (0, 1].
[[nodiscard]] double curve_value(std::span<const double> curve, double cosine);

}  // namespace lobe
