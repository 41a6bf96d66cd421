#include <algorithm>

#include "reference/models.hpp"

namespace lobe::reference {

// L'_P and V_P: the projections of the mirror image of L and of V onto the base plane.
Real basic_patch(const Vector& light, const Vector& view, Real radius) {
  const Vector mirror = mirrored(light);
  const Real distance = std::hypot(view.x - mirror.x, view.y - mirror.y);  // eq. 4.1
  return distance <= radius ? 1 / (kPi * std::min(1.0L, radius * radius)) : 0;
}

Real retro_patch(const Vector& light, const Vector& view, Real radius) {
  const Real distance = std::hypot(view.x - light.x, view.y - light.y);  // eq. 4.29
  return distance <= radius ? 1 / (kPi * std::min(1.0L, radius * radius)) : 0;
}

// Two circular segments on the common chord.
Real lens_area(Real radius, Real other_radius, Real distance) {
  if (distance <= std::abs(radius - other_radius)) return kPi * std::pow(std::min(radius, other_radius), 2.0L);
  if (distance >= radius + other_radius) return 0;
  const Real along = (distance + (radius - other_radius) * (radius + other_radius) / distance) / 2;
  const auto segment = [](Real r, Real to_chord) {
    return r * r * std::acos(to_chord / r) - to_chord * std::sqrt(r * r - to_chord * to_chord);
  };
  return segment(radius, along) + segment(other_radius, distance - along);
}

}  // namespace lobe::reference
