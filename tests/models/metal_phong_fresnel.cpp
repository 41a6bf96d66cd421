#include <algorithm>
#include <cmath>

#include "models/family/fresnel_condition.hpp"
#include "models/family/phong_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

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

}  // namespace

ModelTest metal_phong_fresnel_test() {
  return {.budget = {8, 1.6, 1, 0.18},
          .cases = {fresnel("20", "1.5", "0"), fresnel("1000", "0.331", "2.324")},
          .excess = AlbedoExcess{"metal_phong_fresnel:n=0.5,ior=0.1,k=100", 30, 1.0106}};
}

}  // namespace lobe::test
