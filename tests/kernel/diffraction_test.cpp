#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/microfacet_cases.hpp"
#include "model/evaluate.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

using reference::kPi;

/// Of the angle from the normal; the kernel has it from the cosine.
Real sine(const Vector& x) {
  return std::max(std::hypot(x.x, x.y), 1e-12L);
}

struct Surface {
  std::string sigma, tau, n, k;
};

std::string specification(const std::string& model, const Surface& surface) {
  return model + ":sigma=" + surface.sigma + ",tau=" + surface.tau + ",ior=" + surface.n + ",k=" + surface.k;
}

Real spread_of(const Vector& l, const Vector& v, Real tau) {
  const Real root = kPi * tau * std::hypot(l.x + v.x, l.y + v.y);
  return root * root;
}

/// What the terms of the sum lose by cancellation: none; but the sum ends where it would for |V_P - L'_P| = 0.
Real sum_condition(Real g, Real spread) {
  return (1 + g) * reference::roughness_sum(g, 0) / std::max(reference::roughness_sum(g, spread), 1e-4000L);
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

INSTANTIATE_TEST_SUITE_P(he_torrance, ModelKernel,
                         ::testing::Values(he_torrance({"0.01", "5", "1.5", "0"}),
                                           he_torrance({"0.18", "3", "0.82", "5.99"}),
                                           he_torrance({"0.5", "20", "1.5", "0"}), he_torrance({"0.3", "1", "2", "0"})),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(stam, ModelKernel,
                         ::testing::Values(stam({"0.01", "5", "1.5", "0"}), stam({"0.18", "3", "0.82", "5.99"}),
                                           stam({"0.5", "20", "1.5", "0"})),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(beard_maxwell, ModelKernel,
                         ::testing::Values(beard_maxwell("0.1", "0.3", "0.2"), beard_maxwell("0.01", "10", "1"),
                                           beard_maxwell("1", "1", "5")),
                         ByName{});

// Beckmann's limit of rough surfaces, sum -> exp(-spread/g)/g: Cook-Torrance with Smith's attenuation. What is left is
// of the order 1/g, here 1/39.
TEST(HeTorrance, OfARoughSurfaceIsNearlyCookTorrance) {
  const auto pi = static_cast<double>(kPi);
  const std::vector<Directions> pairs{{0.2, 0.2, pi}, {0.2, 0.3, pi}, {0.5, 0.4, 3}};

  const auto wave = evaluate(device(), parse_material("he_torrance:sigma=0.5,tau=5,ior=1.5"), pairs);
  const auto ray = evaluate(device(), parse_material("cook_torrance_smith_fresnel:m=0.2,ior=1.5"), pairs);

  for (Eigen::Index i = 0; i < wave.rows(); ++i) EXPECT_NEAR(wave(i, 0), ray(i, 0), 2.0 / 39 * ray(i, 0)) << i;
}

}  // namespace
}  // namespace lobe::test
