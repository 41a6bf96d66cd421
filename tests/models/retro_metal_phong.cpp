#include <algorithm>
#include <cmath>

#include "models/family/phong_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase retro(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"retro_metal_phong:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::retro_metal_phong(l, v, exponent); },
          // 1 + n / L.V
          [=](const Vector& l, const Vector& v) { return 1 + exponent / std::max(dot(l, v), 1e-10L); },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

}  // namespace

ModelTest retro_metal_phong_test() {
  return {.budget = {16, 3.4, 4, 1.4},
          .cases = {retro("1"), retro("20"), retro("20000")},
          .excess = AlbedoExcess{"retro_metal_phong:n=0.5", 30, 1.0106}};
}

}  // namespace lobe::test
