#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase schlick(const std::string& text) {
  const Real r = std::stold(text);
  return {"schlick:r=" + text, [=](const Vector& l, const Vector& v) { return reference::schlick(l, v, r); },
          [](const Vector&, const Vector&) -> Real { return 1; }, static_cast<double>(2 * std::sqrt(r))};
}

}  // namespace

ModelTest schlick_test() {
  return {.budget = {32, 6.2, 16, 3.8},
          .cases = {schlick("0.0001"), schlick("0.01"), schlick("0.2"), schlick("1")},
          .excess = AlbedoExcess{"schlick:r=0.01", 89.99, 4.73}};
}

}  // namespace lobe::test
