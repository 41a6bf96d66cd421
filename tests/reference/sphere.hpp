#pragma once

/// Spheres as a distant viewer sees them, by midpoints and vectors alone (Neumann 2001, 3.6). x to the right, y up, z
/// towards the viewer.

#include <functional>
#include <span>

#include "reference/vector.hpp"

namespace lobe::reference {

using SphereReflectance = std::function<Real(const Vector& light, const Vector& view)>;

/// A direction as the surface at a normal sees it: components along the parallel, the meridian, the normal.
[[nodiscard]] Vector on_sphere(const Vector& normal, const Vector& direction);

struct SphereLight {
  Vector direction;  ///< unit vector
  Real irradiance = 0;
};

/// The normal at a place of the picture, whose edges are at -1 and 1, and what is seen there.
using SphereRadiance = std::function<Real(const Vector& normal)>;
[[nodiscard]] SphereRadiance under_lights(SphereReflectance f, std::span<const SphereLight> lights);
/// Sky of radiance 1 by midpoints, `steps` over theta and twice as many over azimuths.
[[nodiscard]] SphereRadiance under_sky(SphereReflectance f, int steps);

/// The mean over a pixel of a picture of size x size pixels, counted from the upper left, by steps x steps midpoints; 0
/// beside the sphere.
[[nodiscard]] Real pixel_mean(const SphereRadiance& radiance, int size, int row, int column, int steps);

}  // namespace lobe::reference
