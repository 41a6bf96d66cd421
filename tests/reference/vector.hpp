#pragma once

/// Vectors of the reference implementation: 80-bit floating point, no cleverness.

#include <cmath>

#include "lobe/core/directions.hpp"

namespace lobe::reference {

using Real = long double;

inline constexpr Real kPi = 3.141592653589793238462643383279502884L;

struct Vector {
  Real x = 0;
  Real y = 0;
  Real z = 0;
};

inline constexpr Vector kNormal{0, 0, 1};

inline Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(Real s, const Vector& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Real dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Real length(const Vector& a) {
  return std::sqrt(dot(a, a));
}
inline Vector normalised(const Vector& a) {
  return (1 / length(a)) * a;
}

/// The direction at an angle theta from the normal and an azimuth phi.
inline Vector direction(Real theta, Real phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The two directions of a pair.
inline Vector light_of(const Directions& pair) {
  return direction(static_cast<Real>(pair.theta_in), static_cast<Real>(pair.phi_in));
}
inline Vector view_of(const Directions& pair) {
  return direction(static_cast<Real>(pair.theta_out), static_cast<Real>(pair.phi_in) + pair.delta_phi);
}

/// A vector as seen from axes that are turned by an angle about N.
inline Vector from_axes(const Vector& a, Real angle) {
  const Real c = std::cos(angle);
  const Real s = std::sin(angle);
  return {c * a.x + s * a.y, c * a.y - s * a.x, a.z};
}

/// R = 2 (N.L) N - L, the mirror image of L (Neumann 2001, eq. 3.8).
inline Vector mirrored(const Vector& light) {
  return 2 * dot(kNormal, light) * kNormal - light;
}

/// H = (L + V) / |L + V|.
inline Vector half_vector(const Vector& light, const Vector& view) {
  return normalised(light + view);
}

/// tan^2 of the angle between N and H = (1 - (N.H)^2) / (N.H)^2, the numerator as the squared length of H's projection.
inline Real tan_squared_delta(const Vector& half) {
  return (half.x * half.x + half.y * half.y) / (half.z * half.z);
}

/// (a.b)^n for unit vectors, 0 where a.b <= 0. a.b = 1 - |a-b|^2/2 keeps its digits for exponents as large as 1e5.
inline Real cosine_power(const Vector& a, const Vector& b, Real n) {
  const Vector difference = a - b;
  const Real one_minus_cosine = dot(difference, difference) / 2;
  return one_minus_cosine < 1 ? std::exp(n * std::log1p(-one_minus_cosine)) : 0;
}

}  // namespace lobe::reference
