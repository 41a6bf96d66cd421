#include <cmath>

#include "reference/models.hpp"

namespace lobe::reference {

// Eq. 1.60.
Real lacquer(const Vector& light, const Vector& view, Real s) {
  return std::exp(-s * (1 / light.z + 1 / view.z)) / kPi;
}

// Eq. 1.63.
Real sandwich(const Vector& light, const Vector& view, Real k, Real order) {
  return 1 / kPi / std::pow(2 + k * (1 / light.z + 1 / view.z), order);
}

}  // namespace lobe::reference
