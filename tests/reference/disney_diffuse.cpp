#include <cmath>

#include "reference/models.hpp"

namespace lobe::reference {

Real disney_diffuse(const Vector& light, const Vector& view, Real rough) {
  const Real l_h = dot(light, half_vector(light, view));
  const Real grazing = 0.5L + 2 * rough * l_h * l_h;  // F_D90
  return (1 + (grazing - 1) * std::pow(1 - light.z, 5.0L)) * (1 + (grazing - 1) * std::pow(1 - view.z, 5.0L)) / kPi;
}

}  // namespace lobe::reference
