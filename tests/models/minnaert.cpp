#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase minnaert(const std::string& k) {
  const Real exponent = std::stold(k);
  return {"minnaert:k=" + k, [=](const Vector& l, const Vector& v) { return reference::minnaert(l, v, exponent); },
          // 1 + k (1 + |ln N.L| + |ln N.V|): the cosines have an error of an ulp, their logarithms too
          [=](const Vector& l, const Vector& v) {
            return 1 + exponent * (1 + std::abs(std::log(l.z)) + std::abs(std::log(v.z)));
          },
          1};
}

}  // namespace

ModelTest minnaert_test() {
  return {.budget = {4, 1, 4, 1},
          .cases = {minnaert("0"), minnaert("0.5"), minnaert("1"), minnaert("2"), minnaert("10"), minnaert("100")}};
}

}  // namespace lobe::test
