#include <cmath>
#include <limits>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase basic_patch(const std::string& text) {
  const Real radius = std::stold(text);
  return {"basic_patch:R=" + text,
          [=](const Vector& l, const Vector& v) { return reference::basic_patch(l, v, radius); },
          // Any error of the geometry decides at the edge, none elsewhere; the band holds what single precision moves.
          [=](const Vector& l, const Vector& v) {
            constexpr Real kBand = 4e-7L;
            const Real distance = std::hypot(l.x + v.x, l.y + v.y);
            return std::abs(distance - radius) < kBand * radius ? std::numeric_limits<Real>::infinity() : 1;
          },
          static_cast<double>(radius / 3)};
}

}  // namespace

ModelTest basic_patch_test() {
  return {.budget = {1, 0.3, 1, 0.4},
          .cases = {basic_patch("0.001"), basic_patch("0.1"), basic_patch("0.5"), basic_patch("1"), basic_patch("1.25"),
                    basic_patch("2")}};
}

}  // namespace lobe::test
