#include <algorithm>

#include "reference/models.hpp"

namespace lobe::reference {

namespace {

Real weighted_dot(const Vector& light, const Vector& view, Real c_xy, Real c_z) {
  return std::max(0.0L, c_xy * light.x * view.x + c_xy * light.y * view.y + c_z * light.z * view.z);
}

}  // namespace

Real lafortune(const Vector& light, const Vector& view, Real c_xy, Real c_z, Real n) {
  return std::pow(weighted_dot(light, view, c_xy, c_z), n);
}

Real lafortune_ngan(const Vector& light, const Vector& view, Real c_xy, Real c_z, Real n) {
  const Real largest = std::max(std::abs(c_xy), std::abs(c_z));
  return (n + 2) / (2 * kPi) * std::pow(weighted_dot(light, view, c_xy, c_z) / largest, n);
}

}  // namespace lobe::reference
