#include <algorithm>
#include <cmath>

#include "reference/models.hpp"

namespace lobe::reference {

// Lucht, Schaaf and Strahler 2000, eq. 38.
Real ross_thick(const Vector& light, const Vector& view) {
  const Real phase = 2 * std::atan2(length(light - view), length(light + view));
  const Real volume = ((kPi / 2 - phase) * std::cos(phase) + std::sin(phase)) / (light.z + view.z) - kPi / 4;
  return volume / kPi;
}

// Eq. 39 to 44, h/b the height and b/r the shape. The tangents of the primed angles are those of the directions,
// stretched: points of a plane, the distance D apart, their outer product tan tan sin(phi).
Real li_sparse(const Vector& light, const Vector& view, Real height, Real shape) {
  const Real x_i = shape * light.x / light.z;
  const Real y_i = shape * light.y / light.z;
  const Real x_o = shape * view.x / view.z;
  const Real y_o = shape * view.y / view.z;
  const Real secant_i = std::sqrt(1 + x_i * x_i + y_i * y_i);
  const Real secant_o = std::sqrt(1 + x_o * x_o + y_o * y_o);
  const Real sum = secant_i + secant_o;
  const Real apart = std::hypot(x_i - x_o, y_i - y_o, x_i * y_o - y_i * x_o);
  const Real cosine = std::min(1.0L, height * apart / sum);
  const Real t = std::acos(cosine);
  const Real overlap = (t - std::sin(t) * cosine) * sum / kPi;
  // (1 + cos xi') sec sec
  const Real phase = secant_i * secant_o + 1 + x_i * x_o + y_i * y_o;
  return (overlap - sum + phase / 2) / kPi;
}

}  // namespace lobe::reference
