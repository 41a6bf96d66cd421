#include "reference/fresnel.hpp"

#include <cmath>
#include <complex>

namespace lobe::reference {

Real fresnel(Real cos_incidence, Real n, Real k) {
  using Complex = std::complex<Real>;
  const Complex index{n, -k};
  // Snell: sin(incidence) = index sin(refraction).
  const Real sine_squared = 1 - cos_incidence * cos_incidence;
  const Complex cos_refraction = std::sqrt(1.0L - sine_squared / (index * index));
  const Complex across = (cos_incidence - index * cos_refraction) / (cos_incidence + index * cos_refraction);
  const Complex parallel = (cos_refraction - index * cos_incidence) / (cos_refraction + index * cos_incidence);
  return (std::norm(across) + std::norm(parallel)) / 2;
}

Real schlick_fresnel(Real cos_incidence, Real f0) {
  return f0 + (1 - f0) * std::pow(1 - cos_incidence, 5.0L);
}

}  // namespace lobe::reference
