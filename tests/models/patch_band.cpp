#include <algorithm>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase patch_band(const std::string& r, const std::string& inner, const std::string& rise) {
  const Real radius = std::stold(r);
  const Real share = std::stold(inner);
  const Real slope = std::stold(rise);
  const Real low = radius * share;
  // The value in the middle, of which the error is a multiple.
  const Real top = reference::patch_band({0, 0, 1}, {0, 0, 1}, radius, share, slope);
  return {"patch_band:R=" + r + ",inner=" + inner + ",rise=" + rise,
          [=](const Vector& l, const Vector& v) { return reference::patch_band(l, v, radius, share, slope); },
          [=](const Vector& l, const Vector& v) {
            const Real value = reference::patch_band(l, v, radius, share, slope);
            return value > 0 ? 1 + (1 + 1 / (1 - share)) * top / value : 1;
          },
          static_cast<double>(std::min(radius, 3 * low) / 3), [=](Real eps) { return 16 * eps / (1 - share) * top; }};
}

}  // namespace

ModelTest patch_band_test() {
  return {.budget = {4, 1.4, 2, 0.68},
          .cases = {patch_band("0.01", "0.5", "0.5"), patch_band("0.5", "0.1", "0"), patch_band("0.5", "0.9", "1"),
                    patch_band("1.5", "0.4", "0.2"), patch_band("2", "0.6", "0.5")}};
}

}  // namespace lobe::test
