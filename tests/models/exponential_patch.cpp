#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase exponential_patch(const std::string& s) {
  const Real decay = std::stold(s);
  return {"exponential_patch:s=" + s,
          [=](const Vector& l, const Vector& v) { return reference::exponential_patch(l, v, decay); },
          // 1 + s |V_P - L'_P|
          [=](const Vector& l, const Vector& v) { return 1 + decay * std::hypot(l.x + v.x, l.y + v.y); },
          static_cast<double>(1 / decay)};
}

}  // namespace

ModelTest exponential_patch_test() {
  return {.budget = {8, 1.8, 4, 1.4},
          .cases = {exponential_patch("0.009"), exponential_patch("0.01"), exponential_patch("0.25"),
                    exponential_patch("2"), exponential_patch("8"), exponential_patch("64"), exponential_patch("512"),
                    exponential_patch("20000")}};
}

}  // namespace lobe::test
