#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase disney_diffuse(const std::string& text) {
  const Real rough = std::stold(text);
  return {"disney_diffuse:rough=" + text,
          [=](const Vector& l, const Vector& v) { return reference::disney_diffuse(l, v, rough); },
          [](const Vector&, const Vector&) -> Real { return 1; }};
}

}  // namespace

ModelTest disney_diffuse_test() {
  return {.budget = {16, 2.9, 16, 3.4},
          .cases = {disney_diffuse("0"), disney_diffuse("0.5"), disney_diffuse("1")},
          .excess = AlbedoExcess{"disney_diffuse:rough=1", 89.99, 1.557}};
}

}  // namespace lobe::test
