#include <algorithm>
#include <string>

#include "models/family/fresnel_condition.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase ggx(const std::string& alpha_x, const std::string& alpha_y, const std::string& f0,
              const std::string& rotation) {
  const Real x = std::stold(alpha_x);
  const Real y = std::stold(alpha_y);
  const Real at_normal = std::stold(f0);
  const Real turn = std::stod(rotation);
  return {"ggx_anisotropic:alpha_x=" + alpha_x + ",alpha_y=" + alpha_y + ",f0=" + f0 + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) { return reference::ggx_anisotropic(l, v, x, y, at_normal, turn); },
          [=](const Vector& l, const Vector& v) {
            return std::max(x, y) / std::min(x, y) + schlick_condition(at_normal, l, v);
          },
          static_cast<double>(2 * std::min(x, y))};
}

}  // namespace

ModelTest ggx_anisotropic_test() {
  return {.budget = {32, 8.4, 16, 3},
          .cases = {ggx("0.3", "0.3", "1", "0"), ggx("0.05", "0.5", "0.04", "0"), ggx("1", "0.1", "1", "0.6"),
                    ggx("0.01", "0.04", "1", "-1.2")}};
}

}  // namespace lobe::test
