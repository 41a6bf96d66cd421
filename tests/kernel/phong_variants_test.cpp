#include <algorithm>
#include <cmath>

#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

/// 1 + n (|ln R.V| + 1/R.V): an ulp of R.V, raised to n.
Real mirror_condition(Real n, const Vector& l, const Vector& v) {
  const Vector mirror = reference::mirrored(l);
  const Real deficit = dot(mirror - v, mirror - v) / 2;
  return deficit < 1 ? 1 + n * (1 / (1 - deficit) - std::log1p(-deficit)) : 1;
}

/// Where R.V or L.V is an ulp above 0 and not below it.
auto floor_of(Real n) {
  return [=](Real eps) { return (n + 2) * std::pow(8 * eps, n) / 1e-4L; };
}

ModelCase p_model(const std::string& n, const std::string& p) {
  const Real exponent = std::stold(n);
  const Real share = std::stold(p);
  return {"p_model:n=" + n + ",p=" + p,
          [=](const Vector& l, const Vector& v) { return reference::p_model(l, v, exponent, share); },
          [=](const Vector& l, const Vector& v) {
            return mirror_condition(exponent, l, v) + std::abs(std::log(std::max(l.z, v.z)));
          },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

ModelCase phong_mean(const std::string& n, const std::string& p) {
  const Real exponent = std::stold(n);
  const Real power = std::stold(p);
  return {"phong_mean:n=" + n + ",p=" + p,
          [=](const Vector& l, const Vector& v) { return reference::phong_mean(l, v, exponent, power); },
          [=](const Vector& l, const Vector& v) {
            return mirror_condition(exponent, l, v) + std::abs(std::log(l.z)) + std::abs(std::log(v.z));
          },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

ModelCase phong_bisector(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"phong_bisector:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::phong_bisector(l, v, exponent); },
          [=](const Vector& l, const Vector& v) { return mirror_condition(exponent, l, v); },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

ModelCase fresnel(const std::string& n, const std::string& ior, const std::string& k) {
  const Real exponent = std::stold(n);
  const Real index = std::stold(ior);
  const Real extinction = std::stold(k);
  return {"metal_phong_fresnel:n=" + n + ",ior=" + ior + ",k=" + k,
          [=](const Vector& l, const Vector& v) {
            return reference::metal_phong_fresnel(l, v, exponent, index, extinction);
          },
          [=](const Vector& l, const Vector& v) {
            return mirror_condition(exponent, l, v) +
                   condition_at([=](Real c) { return reference::fresnel(c, index, extinction); }, std::max(l.z, v.z));
          },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

ModelCase retro(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"retro_metal_phong:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::retro_metal_phong(l, v, exponent); },
          // 1 + n / L.V
          [=](const Vector& l, const Vector& v) { return 1 + exponent / std::max(dot(l, v), 1e-10L); },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

/// For n >= 4, see the reference.
ModelCase blinn_metal(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"blinn_metal:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::blinn_metal(l, v, exponent); },
          // 1 + n |ln N.H|
          [=](const Vector& l, const Vector& v) {
            return 1 + exponent * std::log1p(tan_squared_delta(half_vector(l, v))) / 2;
          },
          static_cast<double>(1 / std::sqrt(exponent))};
}

INSTANTIATE_TEST_SUITE_P(p_model, ModelKernel,
                         ::testing::Values(p_model("1", "0.5"), p_model("20", "0"), p_model("20", "0.5"),
                                           p_model("5000", "1")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(phong_mean, ModelKernel,
                         ::testing::Values(phong_mean("1", "1"), phong_mean("20", "-1"), phong_mean("20", "0"),
                                           phong_mean("100", "8"), phong_mean("20", "0.001")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(phong_bisector, ModelKernel,
                         ::testing::Values(phong_bisector("1"), phong_bisector("20"), phong_bisector("5000")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(metal_phong_fresnel, ModelKernel,
                         ::testing::Values(fresnel("20", "1.5", "0"), fresnel("1000", "0.331", "2.324")), ByName{});
INSTANTIATE_TEST_SUITE_P(retro_metal_phong, ModelKernel, ::testing::Values(retro("1"), retro("20"), retro("20000")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(blinn_metal, ModelKernel,
                         ::testing::Values(blinn_metal("4"), blinn_metal("20"), blinn_metal("5000")), ByName{});

}  // namespace
}  // namespace lobe::test
