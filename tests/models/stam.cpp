#include "models/family/diffraction.hpp"
#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase stam(const Surface& surface) {
  const Real sigma = std::stold(surface.sigma);
  const Real tau = std::stold(surface.tau);
  const Real n = std::stold(surface.n);
  const Real k = std::stold(surface.k);
  return {specification("stam", surface),
          [=](const Vector& l, const Vector& v) { return reference::stam(l, v, sigma, tau, n, k); },
          [=](const Vector& l, const Vector& v) {
            const Real root = 2 * kPi * sigma * (l.z + v.z);
            return fresnel_condition([=](Real c) { return reference::fresnel(c, n, k); }, l, v) +
                   sum_condition(root * root, spread_of(l, v, tau));
          },
          static_cast<double>(1 / (kPi * tau))};
}

}  // namespace

ModelTest stam_test() {
  return {
      .budget = {8, 2.2, 4, 1.1},
      .cases = {stam({"0.01", "5", "1.5", "0"}), stam({"0.18", "3", "0.82", "5.99"}), stam({"0.5", "20", "1.5", "0"})},
      .excess = AlbedoExcess{"stam:sigma=0.3,tau=5,ior=0.18,k=3.64", 89.9, 6.2648}};
}

}  // namespace lobe::test
