#pragma once

#include <numbers>

#include "model/catalogue.hpp"

namespace lobe {

/// Constants of a distribution of slopes with two constants of a Fresnel term.
inline Coefficients beckmann_coefficients(double m, double first, double second) {
  return {1 / (4 * std::numbers::pi * m * m), -1 / (m * m), first, second, m};
}

/// Constants of a distribution with slope v[0] and reflectance v[1] at normal incidence.
inline Coefficients beckmann_coefficients_with_schlick(Values v) {
  return beckmann_coefficients(v[0], v[1], 1 - v[1]);
}

}  // namespace lobe
