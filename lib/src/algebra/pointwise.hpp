#pragma once

#include <span>
#include <vector>

#include "lobe/algebra/pointwise.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// composition_at() of prepared materials.
///
/// Composition C_{f,g}(L,V) = integral of f(L,X) g(X,V) dmu(X) in sr^-1 (Neumann 2001, eq. 1.21) at given pairs of
/// directions, by adaptive quadrature over X that knows the peaks, kinks and edges of both reflectances: right for
/// lobes of any width and without the grid of a table. theta_in and theta_out in [0, pi/2). Two forward-reflecting
/// lobes compose to a lobe about the retro direction, delta_phi = 0. A single channel serves all channels of the other.
/// A value that the quadrature cannot bring to the tolerance is returned with the error that it has, and told to
/// `options.missed`.
/// \return estimate[channel][pair]
/// \throws ArgumentError for an angle out of range or channels that do not fit; NumericError for delta parts, and what
///   `options.missed` throws; DeviceError.
[[nodiscard]] std::vector<std::vector<Estimate>> composition_at(const Device& device, const Material& f,
                                                                const Material& g,
                                                                std::span<const Directions> directions,
                                                                const PointwiseOptions& options = {});

/// Bound on the relative rounding error of a value: of sums of samples, of exponents as large as the logarithm of the
/// value, and of angles of the size of the narrowest lobe.
/// \param narrowest its width, radians
[[nodiscard]] double pointwise_rounding(Precision precision, double value, double narrowest);

/// composition_at() of functions without delta parts, by adaptive cubature over X.
/// \throws ArgumentError for delta parts, an angle out of range or channels that do not fit; NumericError for values
///   that are no finite numbers, and what `options.missed` throws
[[nodiscard]] std::vector<std::vector<Estimate>> composition_at(const BrdfFunction& f, const BrdfFunction& g,
                                                                std::span<const Directions> directions,
                                                                const PointwiseOptions& options = {});

}  // namespace lobe
