#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase harvey_shack(const std::string& l, const std::string& s) {
  const Real shoulder = std::stold(l);
  const Real slope = std::stold(s);
  const auto square = [=](const Vector& light, const Vector& view) {
    const Real ratio = std::hypot(light.x + view.x, light.y + view.y) / shoulder;
    return 1 + ratio * ratio;
  };
  return {"harvey_shack:b=0.5,l=" + l + ",s=" + s,
          [=](const Vector& light, const Vector& view) { return 0.5L * std::pow(square(light, view), slope / 2); },
          [=](const Vector& light, const Vector& view) {
            return 1 + std::abs(slope) * (1 + std::log(square(light, view)));
          },
          static_cast<double>(std::min(1.0L, shoulder))};
}

}  // namespace

ModelTest harvey_shack_test() {
  return {.budget = {4, 0.9, 4, 0.4},
          .cases = {harvey_shack("0.5", "-1"), harvey_shack("0.01", "-1.5"), harvey_shack("1e-4", "-2.5"),
                    harvey_shack("1", "0"), harvey_shack("0.001", "-6")},
          .excess = AlbedoExcess{"harvey_shack:b=0.5,l=1,s=-0.1", 0, 1.54}};
}

}  // namespace lobe::test
