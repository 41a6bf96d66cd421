#include "model/family/parameters.hpp"

#include <algorithm>
#include <cmath>

namespace lobe {

Parameter exponent() {
  return {"n", "1", 1e-3, 1e10, std::nullopt, "exponent; larger is sharper"};
}

// Smaller values would leave the range of a double, squared.
Parameter roughness() {
  return {"m", "1", 1e-5, 100, std::nullopt, "rms slope of the microfacets; smaller is sharper"};
}

Parameter facet_angle() {
  return {"m", "rad", 1e-5, 100, std::nullopt, "angle of facets over which their density falls to 1/e"};
}

Parameter normal_reflectance() {
  return {"f0", "1", 0, 1, 1.0, "Fresnel reflectance at normal incidence"};
}

Parameter refractive_index() {
  return {"ior", "1", 0.01, 100, std::nullopt, "refractive index; of metals its real part"};
}

Parameter extinction() {
  return {"k", "1", 0, 100, 0.0, "extinction coefficient, the imaginary part; 0 for dielectrics"};
}

Parameter reflected_share() {
  return {"rho", "1", 0, 1, 1.0, "reflected share of the light"};
}

double mirror_lobe_width(double n) {
  return std::min(1.0, 1 / std::sqrt(2 * n));
}

double retro_lobe_width(double n) {
  return std::min(0.5, mirror_lobe_width(n));
}

double half_lobe_width(double n) {
  return std::min(1.0, std::sqrt(2 / n));
}

}  // namespace lobe
