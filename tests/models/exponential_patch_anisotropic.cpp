#include <cmath>
#include <string>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase exponential_patch(const std::string& s, const std::string& ratio, const std::string& p,
                            const std::string& rotation) {
  const Real decay = std::stold(s);
  const reference::PatchNorm norm{std::stold(ratio), std::stold(p), static_cast<Real>(std::stod(rotation))};
  const Real constant = reference::exponential_patch_constant(decay, norm);
  return {"exponential_patch_anisotropic:s=" + s + ",ratio=" + ratio + ",p=" + p + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) {
            return constant * std::exp(-decay * reference::patch_metric(l, v, norm));
          },
          // 1 + s |V_P - L'_P|
          [=](const Vector& l, const Vector& v) { return 1 + decay * std::hypot(l.x + v.x, l.y + v.y); },
          static_cast<double>(1 / decay)};
}

}  // namespace

ModelTest exponential_patch_anisotropic_test() {
  return {.budget = {16, 3.3, 8, 2},
          .cases = {exponential_patch("8", "1", "2", "0"), exponential_patch("20", "0.2", "2", "0.6"),
                    exponential_patch("500", "0.02", "2", "-1.2"), exponential_patch("20", "0.3", "4", "0"),
                    exponential_patch("2", "0.5", "10", "0.6"), exponential_patch("20", "0.3", "1", "0.6"),
                    exponential_patch("2", "0.5", "1.5", "0"), exponential_patch("100", "0.1", "3", "-1.2"),
                    exponential_patch("5", "0.5", "100", "0.6")}};
}

}  // namespace lobe::test
