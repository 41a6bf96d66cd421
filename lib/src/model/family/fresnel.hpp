#pragma once

#include <cmath>
#include <complex>

namespace lobe {

/// Reflectance of a plane boundary for unpolarised light, by Fresnel's equations for the refractive index n - ik
/// (Neumann 2001, eq. 1.41 to 1.43).
inline double fresnel_reflectance(double cosine, double n, double k) {
  const std::complex<double> square = std::pow(std::complex<double>(n, -k), 2);
  const std::complex<double> inside = std::sqrt(square - (1 - cosine) * (1 + cosine));
  const double across = std::norm((cosine - inside) / (cosine + inside));
  const double along = std::norm((square * cosine - inside) / (square * cosine + inside));
  return (across + along) / 2;
}

}  // namespace lobe
