#include <cmath>
#include <limits>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase retro_patch(const std::string& text) {
  const Real radius = std::stold(text);
  return {"retro_patch:R=" + text,
          [=](const Vector& l, const Vector& v) { return reference::retro_patch(l, v, radius); },
          // The geometry has the square of the distance by a cosine, to an ulp of 1.
          [=](const Vector& l, const Vector& v) {
            constexpr Real kBand = 1e-6L;
            const Real distance = std::hypot(l.x - v.x, l.y - v.y);
            return std::abs(distance - radius) < kBand / radius ? std::numeric_limits<Real>::infinity() : 1;
          },
          static_cast<double>(radius / 3)};
}

}  // namespace

ModelTest retro_patch_test() {
  return {.budget = {1, 0.34, 1, 0.34},
          .cases = {retro_patch("0.01"), retro_patch("0.5"), retro_patch("1"), retro_patch("1.25"), retro_patch("2")}};
}

}  // namespace lobe::test
