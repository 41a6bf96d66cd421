#include <cmath>

#include "models/family/fresnel_condition.hpp"
#include "models/family/patches.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase coated_metal(const std::string& s, const std::string& ior, const std::string& k) {
  const Real decay = std::stold(s);
  const Real index = std::stold(ior);
  const Real extinction = std::stold(k);
  return {"coated_metal:s=" + s + ",ior=" + ior + ",k=" + k,
          [=](const Vector& l, const Vector& v) { return reference::coated_metal(l, v, decay, index, extinction); },
          // 1 + s |V_P - L'_P|
          [=](const Vector& l, const Vector& v) {
            const Real sine = std::hypot(l.x - v.x, l.y - v.y) / 2;
            return 1 + decay * distance(l, v) +
                   condition_at([=](Real c) { return reference::fresnel(c, index, extinction); },
                                std::sqrt(1 - sine * sine));
          },
          static_cast<double>(1 / decay)};
}

}  // namespace

ModelTest coated_metal_test() {
  return {.budget = {8, 2, 8, 1.6},
          .cases = {coated_metal("2", "1.5", "0"), coated_metal("20", "0.331", "2.324"),
                    coated_metal("500", "0.18", "3.64")}};
}

}  // namespace lobe::test
