#include "reference/models.hpp"

namespace lobe::reference {

Real minnaert(const Vector& light, const Vector& view, Real k) {
  return (k + 2) / (2 * kPi) * std::pow(dot(kNormal, light) * dot(kNormal, view), k);
}

}  // namespace lobe::reference
