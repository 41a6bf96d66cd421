#include "reference/cox_munk.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace lobe::reference {
namespace {

/// The terms of the series of Gram and Charlier, of slopes over their standard deviations, by Hermite's polynomials.
std::array<Real, 6> series(const SeaSlopes& sea, Real xi, Real eta) {
  const auto h2 = [](Real x) { return x * x - 1; };
  const auto h3 = [](Real x) { return x * x * x - 3 * x; };
  const auto h4 = [](Real x) { return std::pow(x, 4.0L) - 6 * x * x + 3; };
  constexpr Real kC40 = 0.4L;
  constexpr Real kC22 = 0.12L;
  constexpr Real kC04 = 0.23L;
  return {1,
          -sea.c21 / 2 * h2(xi) * eta,
          -sea.c03 / 6 * h3(eta),
          kC40 / 24 * h4(xi),
          kC22 / 4 * h2(xi) * h2(eta),
          kC04 / 24 * h4(eta)};
}

/// Upwind and crosswind slope over their standard deviations.
struct Standardised {
  Standardised(const SeaSlopes& sea, Real slope_x, Real slope_y)
      : eta((-slope_x * sea.to_x - slope_y * sea.to_y) / std::sqrt(sea.upwind)),
        xi((slope_x * sea.to_y - slope_y * sea.to_x) / std::sqrt(sea.crosswind)) {}
  Real eta, xi;
};

}  // namespace

SeaSlopes::SeaSlopes(Real wind, Real rotation)
    : upwind(3.16e-3L * wind),
      crosswind(0.003L + 1.92e-3L * wind),
      to_x(std::cos(rotation)),
      to_y(std::sin(rotation)),
      c21(0.01L - 0.0086L * wind),
      c03(0.04L - 0.033L * wind) {}

Real SeaSlopes::density(Real slope_x, Real slope_y) const {
  const auto [eta, xi] = Standardised(*this, slope_x, slope_y);
  const auto terms = series(*this, xi, eta);
  return std::exp(-(xi * xi + eta * eta) / 2) * std::accumulate(terms.begin(), terms.end(), 0.0L) /
         (2 * kPi * std::sqrt(upwind * crosswind));
}

Real SeaSlopes::cancellation(Real slope_x, Real slope_y) const {
  const auto [eta, xi] = Standardised(*this, slope_x, slope_y);
  Real sum = 0;
  Real size = 0;
  for (const Real term : series(*this, xi, eta)) {
    sum += term;
    size += std::abs(term);
  }
  constexpr Real kNearly = 1e-9L;
  return sum > kNearly * size ? size / sum : std::numeric_limits<Real>::infinity();
}

}  // namespace lobe::reference
