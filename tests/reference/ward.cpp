#include "reference/models.hpp"

namespace lobe::reference {

Real ward(const Vector& light, const Vector& view, Real m) {
  const Real tan_squared = tan_squared_delta(half_vector(light, view));
  const Real cosines = dot(kNormal, light) * dot(kNormal, view);
  return std::exp(-tan_squared / (m * m)) / (4 * kPi * m * m * std::sqrt(cosines));
}

}  // namespace lobe::reference
