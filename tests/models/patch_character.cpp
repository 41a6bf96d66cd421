#include <cmath>

#include "models/family/patches.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase patch_character(const std::string& s, const std::string& alpha) {
  const Real decay = std::stold(s);
  const Real power = std::stold(alpha);
  return {"patch_character:s=" + s + ",alpha=" + alpha,
          [=](const Vector& l, const Vector& v) { return reference::patch_character(l, v, decay, power); },
          // 1 + s |V_P - L'_P| + |alpha ln N.B|
          [=](const Vector& l, const Vector& v) {
            return 1 + decay * distance(l, v) + std::abs(power * std::log(std::hypot(length(l + v), l.z - v.z) / 2));
          },
          static_cast<double>(1 / decay)};
}

}  // namespace

ModelTest patch_character_test() {
  return {.budget = {8, 2.4, 8, 1.5},
          .cases = {patch_character("2", "-1"), patch_character("50", "0"), patch_character("500", "-2"),
                    patch_character("1", "2")},
          .excess = AlbedoExcess{"patch_character:s=20,alpha=-1", 70, 2.1909}};
}

}  // namespace lobe::test
