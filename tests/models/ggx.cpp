#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

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

}  // namespace

ModelTest ggx_test() {
  return {.budget = {16, 3.2, 8, 1.7},
          .cases = {ggx("0.01", "1"), ggx("0.05", "0.04"), ggx("0.3", "1"), ggx("1", "1")}};
}

}  // namespace lobe::test
