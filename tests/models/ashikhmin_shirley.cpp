#include <cmath>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase specular(const std::string& n, const std::string& f0) {
  const Real exponent = std::stold(n);
  const Real at_normal = std::stold(f0);
  return {"ashikhmin_shirley:n=" + n + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::ashikhmin_shirley(l, v, exponent, at_normal); },
          // 1 + n |ln N.H|
          [=](const Vector& l, const Vector& v) {
            return 1 + exponent * std::log1p(tan_squared_delta(half_vector(l, v))) / 2 +
                   schlick_condition(at_normal, l, v);
          },
          static_cast<double>(1 / std::sqrt(exponent))};
}

}  // namespace

ModelTest ashikhmin_shirley_test() {
  return {.budget = {16, 3.3, 4, 1}, .cases = {specular("1", "1"), specular("20", "0.04"), specular("5000", "1")}};
}

}  // namespace lobe::test
