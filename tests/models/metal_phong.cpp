#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase metal_phong(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"metal_phong:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::metal_phong(l, v, exponent); },
          // 1 + n (|ln R.V| + 1/R.V): R.V has an absolute error of an ulp
          [=](const Vector& l, const Vector& v) {
            const Real cosine = std::max(dot(reference::mirrored(l), v), 1e-30L);
            return 1 + exponent * (std::abs(std::log(cosine)) + 1 / cosine);
          },
          static_cast<double>(1 / std::sqrt(exponent)),
          [=](Real eps) { return 1e4L * (exponent + 2) * std::pow(8 * eps, exponent); }};
}

}  // namespace

ModelTest metal_phong_test() {
  return {.budget = {8, 1.8, 1, 0.3},
          .cases = {metal_phong("1"), metal_phong("5"), metal_phong("20"), metal_phong("100"), metal_phong("5000"),
                    metal_phong("100000")},
          .excess = AlbedoExcess{"metal_phong:n=0.5", 30, 1.0106}};
}

}  // namespace lobe::test
