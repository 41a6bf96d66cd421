#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase phong(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"phong:n=" + n, [=](const Vector& l, const Vector& v) { return reference::phong(l, v, exponent); },
          // 1 + n (|ln R.V| + 1/R.V): R.V has an absolute error of an ulp
          [=](const Vector& l, const Vector& v) {
            const Real cosine = std::max(dot(reference::mirrored(l), v), 1e-30L);
            return 1 + exponent * (std::abs(std::log(cosine)) + 1 / cosine);
          },
          static_cast<double>(1 / std::sqrt(exponent)),
          [=](Real eps) { return (exponent + 2) * std::pow(8 * eps, exponent); }};
}

}  // namespace

ModelTest phong_test() {
  return {.budget = {8, 1.8, 1, 0.3},
          .cases = {phong("0.5"), phong("1"), phong("5"), phong("20"), phong("100"), phong("5000"), phong("100000")}};
}

}  // namespace lobe::test
