#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase lacquer(const std::string& text) {
  const Real s = std::stold(text);
  return {"lacquer:s=" + text, [=](const Vector& l, const Vector& v) { return reference::lacquer(l, v, s); },
          // 1 + s (1/N.L + 1/N.V)
          [=](const Vector& l, const Vector& v) { return 1 + s * (1 / l.z + 1 / v.z); }, 1};
}

}  // namespace

ModelTest lacquer_test() {
  return {.budget = {4, 1.1, 4, 1}, .cases = {lacquer("0"), lacquer("0.1"), lacquer("2")}};
}

}  // namespace lobe::test
