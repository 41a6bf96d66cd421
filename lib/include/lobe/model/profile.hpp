#pragma once

#include <span>
#include <vector>

#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A point of a curve that is linear between its points.
struct CurvePoint {
  double at = 0;     ///< m, or R of a mixture, in the base plane
  double value = 0;  ///< of the profile, sr^-1, or of the density
};

/// A patch-based BRDF f = xi(m) by points, m the base-plane distance of V from the mirror direction (Neumann 2001,
/// eq. 4.39): the sum of frusta that is linear between them and 0 beyond the last, exactly. Two points at one distance
/// are a jump.
/// \param points m in [0, 2], the first 0, then from 1e-5 on, rising; values in sr^-1, finite, none below 0
/// \throws ArgumentError for other points, and for steps below a thousandth of m that are no jumps
[[nodiscard]] std::vector<Term> make_profile(std::span<const CurvePoint> points);

/// Basic patches mixed by a density p(R) that is linear between points and 0 outside (eq. 4.20); it reflects the
/// integral of p at most.
/// \param points R in [1e-5, 2], rising, at least two; values none below 0
/// \throws ArgumentError for other points, and for steps of R below a thousandth or to more than a thousandfold
[[nodiscard]] std::vector<Term> make_mixture(std::span<const CurvePoint> points);

}  // namespace lobe
