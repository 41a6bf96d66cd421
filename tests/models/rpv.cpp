#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

struct RpvValues {
  Real rho, k, asymmetry, rho_c;
};

/// G, from both tangents as vectors.
Real hot_spot_distance(const Vector& l, const Vector& v) {
  return std::hypot(l.x / l.z - v.x / v.z, l.y / l.z - v.y / v.z);
}

ModelCase rpv(const std::string& rho, const std::string& k, const std::string& asymmetry, const std::string& rho_c) {
  const RpvValues c{std::stold(rho), std::stold(k), std::stold(asymmetry), std::stold(rho_c)};
  const auto spread = [=](const Vector& l, const Vector& v) {
    return 1 + 2 * c.asymmetry * (l.x * v.x + l.y * v.y + l.z * v.z) + c.asymmetry * c.asymmetry;
  };
  const auto f = [=](const Vector& l, const Vector& v) {
    const Real phase = (1 - c.asymmetry * c.asymmetry) / std::pow(spread(l, v), 1.5L);
    const Real hot_spot = 1 + (1 - c.rho_c) / (1 + hot_spot_distance(l, v));
    return c.rho / 3.14159265358979323846L * std::pow(l.z * v.z * (l.z + v.z), c.k - 1) * phase * hot_spot;
  };
  const auto condition = [=](const Vector& l, const Vector& v) {
    const Real logarithms = 1 + std::abs(std::log(l.z)) + std::abs(std::log(v.z));
    const Real product = l.z * v.z;
    const Real change = std::abs(l.z - v.z) * (l.z + v.z) + product;
    const Real root = std::max(product * hot_spot_distance(l, v), 1e-8L * std::sqrt(change));
    return 1 + std::abs(c.k - 1) * logarithms + 6 * std::abs(c.asymmetry) / spread(l, v) +
           (1 - c.rho_c) * product * change / ((product + root) * (product + root) * root);
  };
  return {"rpv:rho=" + rho + ",k=" + k + ",asymmetry=" + asymmetry + ",rho_c=" + rho_c, f, condition, 1};
}

}  // namespace

ModelTest rpv_test() {
  return {.budget = {8, 1.8, 8, 1.2},
          .cases = {rpv("0.1", "0.8", "-0.1", "0.5"), rpv("0.5", "1", "0", "1"), rpv("0.2", "0.6", "-0.5", "0"),
                    rpv("0.1", "1.3", "0.4", "0.2")},
          .excess = AlbedoExcess{"rpv:rho=0.5,k=0.6,asymmetry=0,rho_c=1", 89.99, 26.54}};
}

}  // namespace lobe::test
