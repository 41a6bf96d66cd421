#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase abg(const std::string& b, const std::string& g) {
  const Real flat = std::stold(b);
  const Real power = std::stold(g);
  const auto distance = [](const Vector& l, const Vector& v) { return std::hypot(l.x + v.x, l.y + v.y); };
  return {"abg:a=0.5,b=" + b + ",g=" + g,
          [=](const Vector& l, const Vector& v) { return 0.5L / (flat + std::pow(distance(l, v), power)); },
          [=](const Vector& l, const Vector& v) {
            return 2 + power * (1 + std::abs(std::log(std::max(distance(l, v), 1e-15L))));
          },
          static_cast<double>(std::min(1.0L, std::pow(flat, 1 / std::max(power, 0.1L))))};
}

}  // namespace

ModelTest abg_test() {
  return {.budget = {4, 0.98, 4, 0.72},
          .cases = {abg("0.1", "2"), abg("1e-5", "1.5"), abg("0.01", "1"), abg("1", "0"), abg("1e-9", "3")},
          .excess = AlbedoExcess{"abg:a=0.5,b=0.1,g=2", 0, 3.766}};
}

}  // namespace lobe::test
