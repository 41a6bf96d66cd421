#pragma once

#include <Eigen/Core>
#include <span>

#include "lobe/core/directions.hpp"

namespace lobe {

/// Coordinates of pairs of directions in which f(L, V) and f(V, L) are one point, and lobes about the mirror direction
/// and about the retro direction stay where they are (half-vector and difference vector, Rusinkiewicz 1998).
///
/// With h the half-vector, d half the difference of L and V, |h| = sin(theta_h) and |d| = sin(theta_d), both stretched
/// near 0: s(x) = asinh(x / a) / asinh(1 / a).
/// Isotropic, 3: s(|h|), s(|d|), w cos(2 phi_d) with w = 2 s(|h|) s(|d|) / (s(|h|) + s(|d|)), which is 0 where phi_d
/// means nothing. Both signs of delta_phi are one point.
/// Anisotropic, 4: s(|h|) by the azimuth of h, s(|d|) by twice the azimuth of d once h is turned to the normal.
struct PairCoordinates {
  bool is_isotropic = true;
  double half_knee = 1;        ///< a of theta_h
  double difference_knee = 1;  ///< a of theta_d
  double half_scale = 1;       ///< of the coordinates of h
  double azimuth_scale = 1;    ///< of w cos(2 phi_d); of no meaning for anisotropic ones

  [[nodiscard]] Eigen::Index dimensions() const { return is_isotropic ? 3 : 4; }
  /// dimensions x pairs.
  [[nodiscard]] Eigen::MatrixXd of(std::span<const Directions> pairs) const;
};

}  // namespace lobe
