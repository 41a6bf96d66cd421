#pragma once

#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {

using reference::kPi;

struct Surface {
  std::string sigma, tau, n, k;
};

inline std::string specification(const std::string& model, const Surface& surface) {
  return model + ":sigma=" + surface.sigma + ",tau=" + surface.tau + ",ior=" + surface.n + ",k=" + surface.k;
}

inline Real spread_of(const Vector& l, const Vector& v, Real tau) {
  const Real root = kPi * tau * std::hypot(l.x + v.x, l.y + v.y);
  return root * root;
}

/// What the terms of the sum lose by cancellation: none; but the sum ends where it would for |V_P - L'_P| = 0.
inline Real sum_condition(Real g, Real spread) {
  return (1 + g) * reference::roughness_sum(g, 0) / std::max(reference::roughness_sum(g, spread), 1e-4000L);
}

}  // namespace lobe::test
