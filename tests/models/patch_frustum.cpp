#include <algorithm>

#include "models/family/patches.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase patch_frustum(const std::string& r, const std::string& inner) {
  const Real radius = std::stold(r);
  const Real share = std::stold(inner);
  return {"patch_frustum:R=" + r + ",inner=" + inner,
          [=](const Vector& l, const Vector& v) { return reference::patch_frustum(l, v, radius, share); },
          // 1 + R / (R - m) + 1 / (1 - r), where it falls
          [=](const Vector& l, const Vector& v) {
            const Real rest = radius - distance(l, v);
            return rest <= 0 ? 1 : 1 + 1 / (1 - share) + radius / rest;
          },
          static_cast<double>(radius / 3),
          // c eps / (1 - r), with c <= 3 / (pi min(1, R^2))
          [=](Real eps) { return 8 * eps / (1 - share) / std::min(1.0L, radius * radius); }};
}

}  // namespace

ModelTest patch_frustum_test() {
  return {.budget = {4, 0.87, 2, 0.66},
          .cases = {patch_frustum("0.01", "0"), patch_frustum("0.5", "0.3"), patch_frustum("1.5", "0.9"),
                    patch_frustum("2", "0"), patch_frustum("1.2", "0.5")}};
}

}  // namespace lobe::test
