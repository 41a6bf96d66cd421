#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase diffuse(const std::string& f0) {
  const Real at_normal = std::stold(f0);
  return {"ashikhmin_shirley_diffuse:f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::ashikhmin_shirley_diffuse(l, v, at_normal); },
          [](const Vector&, const Vector&) -> Real { return 1; }};
}

}  // namespace

ModelTest ashikhmin_shirley_diffuse_test() {
  return {.budget = {8, 2.6, 8, 2.7}, .cases = {diffuse("0"), diffuse("0.05")}};
}

}  // namespace lobe::test
