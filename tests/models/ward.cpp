#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase ward(const std::string& m) {
  const Real roughness = std::stold(m);
  return {"ward:m=" + m, [=](const Vector& l, const Vector& v) { return reference::ward(l, v, roughness); },
          // 1 + tan^2 delta / m^2
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) / (roughness * roughness);
          },
          static_cast<double>(2 * roughness)};
}

}  // namespace

ModelTest ward_test() {
  return {.budget = {16, 4, 8, 1.5},
          .cases = {ward("0.005"), ward("0.0078125"), ward("0.05"), ward("0.2"), ward("0.5")},
          .excess = AlbedoExcess{"ward:m=0.1", 89.999, 2.62}};
}

}  // namespace lobe::test
