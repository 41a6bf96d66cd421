#include <algorithm>
#include <cmath>

#include "reference/microfacets.hpp"
#include "reference/models.hpp"
#include "reference/quadrature.hpp"

namespace lobe::reference {
namespace {

Real theta(const Vector& direction) {
  return std::atan2(std::hypot(direction.x, direction.y), direction.z);
}

Real attenuation(const BagherFit& fit, Real angle) {
  if (angle <= fit.theta0) return 1;
  return 1 - fit.lambda * std::expm1(fit.rate() * std::pow(angle - fit.theta0, fit.k));
}

}  // namespace

// 1/K = the integral of e^-x / x^p over tan^2 = alpha (x - alpha), by panels that double.
Real BagherFit::normalisation() const {
  Real sum = 0;
  for (Real from = alpha; from < alpha + 60; from *= 2) {
    sum += smooth_integral([this](Real x) { return std::exp(-x) / std::pow(x, p); }, from, 2 * from);
  }
  return 1 / (alpha * sum);
}

Real BagherFit::reflectance(Real cosine) const {
  return std::max(0.0L, f0 + (1 - f0) * std::pow(1 - cosine, 5.0L) - f1 * cosine);
}

Real BagherFit::rate() const {
  return std::log1p(1 / lambda) / std::pow(kPi / 2 - theta0, k);
}

Real bagher_sgd(const Vector& light, const Vector& view, const BagherFit& fit, Real normalisation) {
  const Vector half = half_vector(light, view);
  const Real x = fit.alpha + tan_squared_delta(half) / fit.alpha;
  const Real distribution = normalisation * std::exp(-x) / std::pow(x, fit.p) / (kPi * std::pow(half.z, 4.0L));
  return distribution * fit.reflectance(cos_half_difference(light, view)) * attenuation(fit, theta(light)) *
         attenuation(fit, theta(view)) / (kPi * light.z * view.z);
}

}  // namespace lobe::reference
