#include "models/family/rough_diffuse.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase fon(const std::string& text) {
  const Real r = std::stold(text);
  const auto f = [=](const Vector& l, const Vector& v) {
    return fujii_normal(r) / kCircle * (1 + r * fujii_ratio(l, v));
  };
  return {"fon:r=" + text, f,
          [=](const Vector& l, const Vector& v) {
            return (1 + 1 / std::max(l.z, v.z)) / std::max(1 + r * fujii_ratio(l, v), 1e-10L);
          },
          1};
}

}  // namespace

ModelTest fon_test() {
  return {.budget = {4, 2.6, 4, 1.7}, .cases = {fon("0"), fon("0.3"), fon("1")}};
}

}  // namespace lobe::test
