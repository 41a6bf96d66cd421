#include "kernel/microfacet_cases.hpp"

namespace lobe::test {
namespace {

ModelCase ggx(const std::string& alpha, const std::string& f0) {
  const Real roughness = std::stold(alpha);
  const Real at_normal = std::stold(f0);
  return {"ggx:alpha=" + alpha + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::ggx(l, v, roughness, at_normal); },
          [=](const Vector& l, const Vector& v) { return 1 + schlick_condition(at_normal, l, v); },
          static_cast<double>(2 * roughness)};
}

ModelCase ggx_fresnel(const std::string& alpha, const std::string& n, const std::string& k) {
  const Real roughness = std::stold(alpha);
  const Real index = std::stold(n);
  const Real extinction = std::stold(k);
  return {"ggx_fresnel:alpha=" + alpha + ",ior=" + n + ",k=" + k,
          [=](const Vector& l, const Vector& v) { return reference::ggx_fresnel(l, v, roughness, index, extinction); },
          [=](const Vector& l, const Vector& v) {
            return 1 + fresnel_condition([=](Real c) { return reference::fresnel(c, index, extinction); }, l, v);
          },
          static_cast<double>(2 * roughness)};
}

INSTANTIATE_TEST_SUITE_P(ggx, ModelKernel,
                         ::testing::Values(ggx("0.01", "1"), ggx("0.05", "0.04"), ggx("0.3", "1"), ggx("1", "1")),
                         ByName{});
INSTANTIATE_TEST_SUITE_P(ggx_fresnel, ModelKernel,
                         ::testing::Values(ggx_fresnel("0.1", "1.5", "0"), ggx_fresnel("0.3", "0.93", "6.33"),
                                           ggx_fresnel("0.5", "1.39", "4.32")),
                         ByName{});

}  // namespace
}  // namespace lobe::test
