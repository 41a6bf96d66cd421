#include <cmath>
#include <string>

#include "models/family/anisotropic.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase lafortune(const std::string& c_x, const std::string& c_y, const std::string& n, const std::string& rotation) {
  const Vector c{std::stold(c_x), std::stold(c_y), 1};
  const Real exponent = std::stold(n);
  const Real turn = std::stod(rotation);
  return {"lafortune_anisotropic:c_x=" + c_x + ",c_y=" + c_y + ",c_z=1,n=" + n + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) { return reference::lafortune_anisotropic(l, v, c, exponent, turn); },
          lafortune_condition(c, exponent, turn), static_cast<double>(1 / std::sqrt(exponent)),
          lafortune_floor(1, exponent)};
}

}  // namespace

ModelTest lafortune_anisotropic_test() {
  return {.budget = {4, 0.92, 4, 0.78},
          .cases = {lafortune("-1", "-1", "20", "0"), lafortune("-1", "-0.7", "20", "0.6"),
                    lafortune("-1", "1", "50", "0"), lafortune("0.9", "0.3", "5", "-1.2")},
          .excess = AlbedoExcess{"lafortune_anisotropic:c_x=-1,c_y=-1,c_z=1,n=1", 0, 2.094}};
}

}  // namespace lobe::test
