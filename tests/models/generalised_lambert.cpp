#include <algorithm>

#include "models/family/patches.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase generalised_lambert(const std::string& d) {
  const Real shape = std::stold(d);
  return {"generalised_lambert:d=" + d,
          [=](const Vector& l, const Vector& v) { return reference::generalised_lambert(l, v, shape, 1.9L); },
          // 1 + d / (1 - m^2/4), where the difference is at least that of the clip
          [=](const Vector& l, const Vector& v) {
            const Real half = std::min(distance(l, v), 1.9L) / 2;
            return 1 + shape / (1 - half * half);
          }};
}

}  // namespace

ModelTest generalised_lambert_test() {
  return {.budget = {16, 3.3, 4, 0.88},
          .cases = {generalised_lambert("0"), generalised_lambert("0.3"), generalised_lambert("1")}};
}

}  // namespace lobe::test
