#pragma once

/// Reference quadratures: slow, and by another route than the library's (angles of incidence and of exitance, split at
/// the mirror direction, instead of half-vector coordinates).

#include <functional>
#include <vector>

#include "reference/vector.hpp"

namespace lobe::reference {

/// A reflectance and the angle (radians) over which it falls off around the mirror direction.
struct Lobe {
  std::function<Real(const Vector& light, const Vector& view)> f;
  double width = 1;
};

/// Gauss-Legendre nodes and weights on [-1, 1].
struct GaussRule {
  std::vector<double> nodes;
  std::vector<double> weights;
};
[[nodiscard]] GaussRule gauss_legendre(int order);

/// Integral of g over [a, b] with 80 Gauss nodes, for smooth functions.
[[nodiscard]] Real smooth_integral(const std::function<Real(Real)>& g, Real a, Real b);

/// Integral of g over [a, b] by adaptive bisection with 7 and 15 Gauss nodes, to an absolute tolerance.
[[nodiscard]] double integrate(const std::function<double(double)>& g, double a, double b, double tolerance);

/// a(theta) = integral of f(L, V) cos(theta_V) over the hemisphere (Neumann 2001, eq. 1.13), adaptive in theta_V and
/// phi.
[[nodiscard]] double albedo(const Lobe& lobe, double theta_in, double tolerance = 1e-10);

/// The same for light from an azimuth, of anisotropic reflectances: adaptive in theta_V and over a whole turn of phi_V.
[[nodiscard]] double albedo_at(const Lobe& lobe, double theta_in, double phi_in, double tolerance);

/// Integral of f g dmu dmu for anisotropic reflectances: a product rule, Gauss in the elevations of both directions,
/// graded towards the horizon, and equal steps in both azimuths. For wide lobes that are smooth.
[[nodiscard]] double turned_point_product(const Lobe& f, const Lobe& g, int order, int azimuths);

/// A = (1/pi) * integral of a dmu (eq. 1.20). Panels in cos(theta), graded towards grazing incidence.
[[nodiscard]] double mean_albedo(const Lobe& lobe);

/// Integral of a_f a_g dmu.
[[nodiscard]] double daylight_product(const Lobe& f, const Lobe& g);

/// Integral of f g dmu dmu for reciprocal f, g: Gauss product rule on the triangle theta_V < theta_L, twice; 3 x 4 x 5
/// fixed panels of so many nodes per axis. For lobes wider than those panels.
[[nodiscard]] double point_product(const Lobe& f, const Lobe& g, int order);

/// C_{f,g}(L,V) = integral of f(L,X) g(X,V) dmu(X) (eq. 1.21), to an absolute tolerance. dmu is the area element of the
/// base plane: polar coordinates there about the mirror image of L, adaptive in both.
[[nodiscard]] double composition(const Lobe& f, const Lobe& g, const Directions& pair, double tolerance);

}  // namespace lobe::reference
