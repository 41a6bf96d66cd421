#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase cook_torrance(const std::string& m, const std::string& f0) {
  const Real roughness = std::stold(m);
  const Real at_normal = std::stold(f0);
  return {"cook_torrance:m=" + m + ",f0=" + f0,
          [=](const Vector& l, const Vector& v) { return reference::cook_torrance(l, v, roughness, at_normal); },
          // 1 + tan^2 delta / m^2, and what the difference 1 - L.H adds to the Fresnel factor
          [=](const Vector& l, const Vector& v) {
            const Vector half = half_vector(l, v);
            const Real away = 1 - dot(l, half);
            const Real slope = 5 * (1 - at_normal) * std::pow(away, 4.0L);
            return 1 + tan_squared_delta(half) / (roughness * roughness) + slope / (at_normal + slope * away / 5);
          },
          static_cast<double>(2 * roughness)};
}

}  // namespace

ModelTest cook_torrance_test() {
  return {.budget = {16, 4.2, 8, 2},
          .cases = {cook_torrance("0.005", "1"), cook_torrance("0.05", "0.04"), cook_torrance("0.1", "1"),
                    cook_torrance("0.3", "1"), cook_torrance("0.3", "0.5"), cook_torrance("0.5", "0.001")}};
}

}  // namespace lobe::test
