#include <cmath>

#include "models/family/phong_variants.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase phong_bisector(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"phong_bisector:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::phong_bisector(l, v, exponent); },
          [=](const Vector& l, const Vector& v) { return mirror_condition(exponent, l, v); },
          static_cast<double>(1 / std::sqrt(exponent)), floor_of(exponent)};
}

}  // namespace

ModelTest phong_bisector_test() {
  return {.budget = {8, 1.7, 1, 0.21}, .cases = {phong_bisector("1"), phong_bisector("20"), phong_bisector("5000")}};
}

}  // namespace lobe::test
