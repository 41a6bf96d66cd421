#include <algorithm>
#include <string>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase ward(const std::string& m_x, const std::string& m_y, const std::string& rotation) {
  const Real x = std::stold(m_x);
  const Real y = std::stold(m_y);
  const Real turn = std::stod(rotation);
  return {"ward_anisotropic:m_x=" + m_x + ",m_y=" + m_y + ",rotation=" + rotation,
          [=](const Vector& l, const Vector& v) { return reference::ward_anisotropic(l, v, x, y, turn); },
          // 1 + tan^2 delta (1/m_x^2 + 1/m_y^2)
          [=](const Vector& l, const Vector& v) {
            return 1 + tan_squared_delta(half_vector(l, v)) * (1 / (x * x) + 1 / (y * y));
          },
          static_cast<double>(2 * std::min(x, y))};
}

}  // namespace

ModelTest ward_anisotropic_test() {
  return {.budget = {32, 5.9, 8, 1.8},
          .cases = {ward("0.2", "0.2", "0"), ward("0.05", "0.5", "0"), ward("0.5", "0.05", "0.6"),
                    ward("0.005", "0.02", "-1.2")},
          .excess = AlbedoExcess{"ward_anisotropic:m_x=0.1,m_y=0.3", 89.999, 2.413}};
}

}  // namespace lobe::test
