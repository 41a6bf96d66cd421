#pragma once

namespace lobe {

/// Area that the disc of radius R about a point of the base plane has in common with the unit disc (Neumann 2001, eq.
/// 4.7).
/// \param distance of the point from the origin, >= 0
[[nodiscard]] double lens_area(double distance, double radius);

/// Value of the normalised patch function eta_R, sr^-1: 1 / (pi min(1, R^2)) (4.2).
[[nodiscard]] double patch_constant(double radius);

/// Integral of C_{eta_R}(X, Y) dmu(Y) for the normalised patch function eta_R (4.2): the albedo of its self-composition
/// at X, to about 1e-12.
/// \param distance of X_P from the origin, in [0, 1]
[[nodiscard]] double patch_response(double distance, double radius);

}  // namespace lobe
