#include <algorithm>
#include <cmath>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase beard_maxwell(const std::string& sigma, const std::string& tau, const std::string& omega) {
  const reference::BeardMaxwell paint{std::stold(sigma), std::stold(tau), std::stold(omega), 1.65L, 0.1L};
  return {"beard_maxwell:sigma=" + sigma + ",tau=" + tau + ",omega=" + omega + ",ior=1.65,k=0.1",
          [=](const Vector& l, const Vector& v) { return reference::beard_maxwell(l, v, paint); },
          [=](const Vector& l, const Vector& v) {
            const Real beta = std::atan2(length(l - v), length(l + v));
            return 1 + fresnel_condition([=](Real c) { return reference::fresnel(c, paint.n, paint.k); }, l, v) +
                   (beta + 1 / std::max(beta, 1e-12L)) / paint.tau;
          },
          static_cast<double>(paint.sigma)};
}

}  // namespace

ModelTest beard_maxwell_test() {
  return {.budget = {2, 0.64, 2, 0.38},
          .cases = {beard_maxwell("0.1", "0.3", "0.2"), beard_maxwell("0.01", "10", "1"), beard_maxwell("1", "1", "5")},
          .excess = AlbedoExcess{"beard_maxwell:sigma=0.1,tau=1,omega=1,ior=1.65", 89, 18.258}};
}

}  // namespace lobe::test
