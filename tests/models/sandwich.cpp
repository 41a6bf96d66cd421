#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase sandwich(const std::string& k, const std::string& n) {
  const Real ratio = std::stold(k);
  const Real order = std::stold(n);
  return {"sandwich:k=" + k + ",n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::sandwich(l, v, ratio, order); },
          // 1 + n (1 + |ln(...)|)
          [=](const Vector& l, const Vector& v) { return 1 + order * (1 + std::log(2 + ratio * (1 / l.z + 1 / v.z))); },
          1};
}

}  // namespace

ModelTest sandwich_test() {
  return {.budget = {2, 0.7, 4, 0.75}, .cases = {sandwich("0.1", "1"), sandwich("1", "1"), sandwich("30", "3")}};
}

}  // namespace lobe::test
