#pragma once

#include <span>
#include <vector>

#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A point of a curve that is linear between its points.
struct CurvePoint {
  double at = 0;     ///< m of a profile, or R of a mixture, in the base plane
  double value = 0;  ///< value of the profile, sr^-1, or of the density
};

/// Makes a patch-based BRDF f = xi(m) from points, where m is the base-plane distance of V from the mirror direction
/// (Neumann 2001, eq. 4.39): the exact sum of frusta, linear between the points and 0 beyond the last. Two points at
/// the same distance make a jump.
/// \param points m in [0, 2], the first 0, then from 1e-5 on, rising; values in sr^-1, finite, none below 0
/// \throws ArgumentError for other points, and for steps below a thousandth of m that are not jumps
[[nodiscard]] std::vector<Term> make_profile(std::span<const CurvePoint> points);

/// Makes a mixture of basic patches with a density p(R) that is linear between points and 0 outside (eq. 4.20). It
/// reflects at most the integral of p.
/// \param points R in [1e-5, 2], rising, at least two; no value below 0
/// \throws ArgumentError for other points, for steps of R below a thousandth, and for steps to more than a thousandfold
[[nodiscard]] std::vector<Term> make_mixture(std::span<const CurvePoint> points);

}  // namespace lobe
