#include <cmath>
#include <numbers>

#include "models/model_test.hpp"
#include "reference/microfacets.hpp"

namespace lobe::test {
namespace {

/// Between Fss90 and 1.
Real side_of(const Vector& x, const Vector& l, const Vector& v, Real rough) {
  const Real cosine = reference::cos_half_difference(l, v);
  return std::lerp(Real{1}, rough * cosine * cosine, std::pow(1 - x.z, 5.0L));
}

ModelCase disney_subsurface(const std::string& text) {
  const Real rough = std::stold(text);
  const Real constant = 1.25L / std::numbers::pi_v<Real>;
  const auto sides = [=](const Vector& l, const Vector& v) {
    return side_of(l, l, v, rough) * side_of(v, l, v, rough);
  };
  const auto f = [=](const Vector& l, const Vector& v) {
    return constant * (sides(l, v) * (1 / (l.z + v.z) - 0.5L) + 0.5L);
  };
  // Each side is 1 less nearly 1 at grazing angles, and the whole a difference.
  const auto condition = [=](const Vector& l, const Vector& v) {
    const Real lost = side_of(l, l, v, rough) + side_of(v, l, v, rough);
    return 1 + constant * (1 + lost / (l.z + v.z)) / f(l, v);
  };
  return {"disney_subsurface:rough=" + text, f, condition};
}

}  // namespace

ModelTest disney_subsurface_test() {
  return {.budget = {4, 1.1, 4, 1.1},
          .cases = {disney_subsurface("0"), disney_subsurface("0.5"), disney_subsurface("1")},
          .excess = AlbedoExcess{"disney_subsurface:rough=1", 89.99, 1.5118}};
}

}  // namespace lobe::test
