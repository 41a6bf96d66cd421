#pragma once

#include <numbers>

#include "model/catalogue.hpp"

namespace lobe {

inline Parameter axis_ratio() {
  return {"q", "1", 1e-5, 1, std::nullopt, "axis ratio of the facets' ellipsoids; smaller is sharper"};
}

inline Parameter ggx_roughness() {
  return {"alpha", "1", 1e-5, 1, std::nullopt, "roughness; smaller is sharper"};
}

/// Constants of a distribution with roughness v[0] and reflectance v[1] at normal incidence.
inline Coefficients trowbridge_coefficients_with_schlick(Values v) {
  return {v[0] * v[0] / (4 * std::numbers::pi), v[0] * v[0], v[1], 1 - v[1]};
}

/// Constants of a distribution with roughness v[0] and refractive index v[1] - i v[2].
inline Coefficients trowbridge_coefficients_with_fresnel(Values v) {
  return {v[0] * v[0] / (4 * std::numbers::pi), v[0] * v[0], v[1], v[2]};
}

}  // namespace lobe
