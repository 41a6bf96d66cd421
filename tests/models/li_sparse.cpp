#include <algorithm>
#include <cmath>

#include "models/family/ross_li.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase li_sparse(const std::string& height, const std::string& shape) {
  const Real h_b = std::stold(height);
  const Real b_r = std::stold(shape);
  return {"li_sparse:h_b=" + height + ",b_r=" + shape,
          [=](const Vector& l, const Vector& v) { return reference::li_sparse(l, v, h_b, b_r); },
          // The magnitudes of the terms, and what an ulp of the cosines does to the angle t.
          [=](const Vector& l, const Vector& v) {
            const Real product = l.z * v.z;
            const auto stretched = [&](const Vector& x) { return std::hypot(x.z, b_r * x.x, b_r * x.y); };
            const Real secants = (stretched(l) / l.z + stretched(v) / v.z);
            const Real apart =
                std::hypot(l.x / l.z - v.x / v.z, l.y / l.z - v.y / v.z, b_r * (l.x * v.y - l.y * v.x) / product) *
                product;
            const Real spread = std::abs(l.z - v.z) * (l.z + v.z) + product + b_r * b_r;
            const Real terms = 1 + secants + (b_r * b_r + h_b * b_r * spread / std::max(apart, 1e-9L)) / product;
            return terms / std::abs(kPi * reference::li_sparse(l, v, h_b, b_r));
          },
          0.3};
}

}  // namespace

ModelTest li_sparse_test() {
  return {.budget = {8, 1.4, 8, 2.2},
          .cases = {li_sparse("2", "1"), li_sparse("1", "0.4"), li_sparse("2", "1.8")},
          .excess = AlbedoExcess{"li_sparse:h_b=2,b_r=2", 89.9, 809.8}};
}

}  // namespace lobe::test
