#include "reference/sphere.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace lobe::reference {
namespace {

Vector cross_product(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

constexpr Vector kUp{0, 1, 0};
constexpr Vector kViewer{0, 0, 1};

}  // namespace

Vector on_sphere(const Vector& normal, const Vector& direction) {
  const Vector east = normalised(cross_product(kUp, normal));
  const Vector north = cross_product(normal, east);
  return {dot(direction, east), dot(direction, north), dot(direction, normal)};
}

SphereRadiance under_lights(SphereReflectance f, std::span<const SphereLight> lights) {
  return [f = std::move(f), lights = std::vector(lights.begin(), lights.end())](const Vector& normal) {
    Real radiance = 0;
    for (const SphereLight& light : lights) {
      const Vector local = on_sphere(normal, light.direction);
      if (local.z > 0) radiance += f(local, on_sphere(normal, kViewer)) * local.z * light.irradiance;
    }
    return radiance;
  };
}

SphereRadiance under_sky(SphereReflectance f, int steps) {
  return [f = std::move(f), steps](const Vector& normal) {
    const Vector view = on_sphere(normal, kViewer);
    Real radiance = 0;
    for (int i = 0; i < steps; ++i) {
      const Real theta = kPi / 2 * (i + 0.5L) / steps;
      for (int k = 0; k < 2 * steps; ++k) {
        const Vector light = direction(theta, kPi * (k + 0.5L) / steps);
        radiance += f(light, view) * light.z * std::sin(theta);
      }
    }
    return radiance * kPi / 2 / steps * kPi / steps;
  };
}

Real pixel_mean(const SphereRadiance& radiance, int size, int row, int column, int steps) {
  Real sum = 0;
  for (int j = 0; j < steps; ++j) {
    for (int i = 0; i < steps; ++i) {
      const Real x = 2 * (column + (i + 0.5L) / steps) / size - 1;
      const Real y = 1 - 2 * (row + (j + 0.5L) / steps) / size;
      const Real rest = 1 - x * x - y * y;
      if (rest > 0) sum += radiance({x, y, std::sqrt(rest)});
    }
  }
  return sum / steps / steps;
}

}  // namespace lobe::reference
