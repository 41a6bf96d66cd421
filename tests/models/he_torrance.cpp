#include <algorithm>
#include <cmath>

#include "models/family/diffraction.hpp"
#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

/// Of the angle from the normal; the kernel has it from the cosine.
Real sine(const Vector& x) {
  return std::max(std::hypot(x.x, x.y), 1e-12L);
}

ModelCase he_torrance(const Surface& surface) {
  const Real sigma = std::stold(surface.sigma);
  const Real tau = std::stold(surface.tau);
  const Real n = std::stold(surface.n);
  const Real k = std::stold(surface.k);
  return {specification("he_torrance", surface),
          [=](const Vector& l, const Vector& v) { return reference::he_torrance(l, v, sigma, tau, n, k); },
          [=](const Vector& l, const Vector& v) {
            const Real slope = 2 * sigma / tau;
            const Real g = reference::he_torrance_phase(l, v, sigma, tau);
            return (fresnel_condition([=](Real c) { return reference::fresnel(c, n, k); }, l, v) + slope / sine(l) +
                    slope / sine(v)) +
                   sum_condition(g, spread_of(l, v, tau));
          },
          static_cast<double>(1 / (kPi * tau))};
}

}  // namespace

ModelTest he_torrance_test() {
  return {.budget = {8, 1.8, 4, 1.2},
          .cases = {he_torrance({"0.01", "5", "1.5", "0"}), he_torrance({"0.18", "3", "0.82", "5.99"}),
                    he_torrance({"0.5", "20", "1.5", "0"}), he_torrance({"0.3", "1", "2", "0"})}};
}

}  // namespace lobe::test
