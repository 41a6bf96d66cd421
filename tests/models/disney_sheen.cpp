#include <algorithm>
#include <cmath>

#include "models/model_test.hpp"
#include "reference/microfacets.hpp"

namespace lobe::test {
namespace {

/// 1 - L.H, from half the distance of L and V, the sine.
Real away_of(const Vector& l, const Vector& v) {
  const Real sine = length(l - v) / 2;
  return sine * sine / (1 + reference::cos_half_difference(l, v));
}

}  // namespace

ModelTest disney_sheen_test() {
  return {.budget = {16, 4.5, 8, 1.5},
          .cases = {{"disney_sheen", [](const Vector& l, const Vector& v) { return std::pow(away_of(l, v), 5.0L); },
                     [](const Vector& l, const Vector& v) { return 1 + 1 / std::max(away_of(l, v), 1e-300L); }, 1,
                     [](Real eps) { return std::pow(8 * eps, 5.0L); }}}};
}

}  // namespace lobe::test
