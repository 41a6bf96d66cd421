#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

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

}  // namespace

ModelTest ggx_fresnel_test() {
  return {.budget = {8, 2.3, 8, 2.1},
          .cases = {ggx_fresnel("0.1", "1.5", "0"), ggx_fresnel("0.3", "0.93", "6.33"),
                    ggx_fresnel("0.5", "1.39", "4.32")}};
}

}  // namespace lobe::test
