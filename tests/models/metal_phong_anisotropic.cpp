#include <cmath>
#include <string>

#include "models/family/anisotropic.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase metal_phong(const std::string& n, const std::string& c_x, const std::string& c_y, const std::string& p,
                      const std::string& rotation) {
  const Vector c{std::stold(c_x), std::stold(c_y), 1};
  const Real exponent = std::stold(n);
  const Real power = std::stold(p);
  const Real turn = std::stod(rotation);
  return {"metal_phong_anisotropic:n=" + n + ",c_x=" + c_x + ",c_y=" + c_y + ",p=" + p + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) {
            return reference::metal_phong_anisotropic(l, v, exponent, c, power, turn);
          },
          lafortune_condition({-c.x, -c.y, c.z}, exponent, turn), static_cast<double>(1 / std::sqrt(exponent)),
          lafortune_floor(1e4L * (exponent + 2), exponent)};
}

}  // namespace

ModelTest metal_phong_anisotropic_test() {
  return {.budget = {4, 0.86, 4, 0.77},
          .cases = {metal_phong("20", "1", "1", "1", "0"), metal_phong("100", "1", "0.8", "1", "0.6"),
                    metal_phong("5", "0.5", "0.9", "0.5", "-1.2")},
          .excess = AlbedoExcess{"metal_phong_anisotropic:n=0.5", 30, 1.0106}};
}

}  // namespace lobe::test
