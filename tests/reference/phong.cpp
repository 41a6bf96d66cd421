#include "reference/models.hpp"

namespace lobe::reference {

// Printed with k in the constant, meant is n (errata to eq. 1.33).
Real phong(const Vector& light, const Vector& view, Real n) {
  return (n + 2) / (2 * kPi) * cosine_power(mirrored(light), view, n);
}

}  // namespace lobe::reference
