#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase charlie(const std::string& text) {
  const Real alpha = std::stold(text);
  const auto sine_of = [](const Vector& l, const Vector& v) {
    const Vector h{l.x + v.x, l.y + v.y, l.z + v.z};
    return std::hypot(h.x, h.y) / std::hypot(h.x, h.y, h.z);
  };
  const Real constant = (2 + 1 / alpha) / (2 * 3.14159265358979323846L);
  return {"charlie:alpha=" + text,
          [=](const Vector& l, const Vector& v) {
            return constant * std::pow(sine_of(l, v), 1 / alpha) / (4 * (l.z + v.z - l.z * v.z));
          },
          [=](const Vector& l, const Vector& v) {
            return 1 + (1 + 2 * std::abs(std::log(std::max(sine_of(l, v), 1e-300L)))) / (2 * alpha);
          },
          1, [=](Real eps) { return constant * std::pow(8 * eps, 1 / alpha); }};
}

}  // namespace

ModelTest charlie_test() {
  return {.budget = {16, 9.2, 4, 0.75},
          .cases = {charlie("0.01"), charlie("0.07"), charlie("0.5"), charlie("1")},
          .excess = AlbedoExcess{"charlie:alpha=0.01", 89.99, 3.987}};
}

}  // namespace lobe::test
