#include <cmath>

#include "models/model_test.hpp"

namespace lobe::test {
namespace {

/// For n >= 4, see the reference.
ModelCase blinn_metal(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"blinn_metal:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::blinn_metal(l, v, exponent); },
          // 1 + n |ln N.H|
          [=](const Vector& l, const Vector& v) {
            return 1 + exponent * std::log1p(tan_squared_delta(half_vector(l, v))) / 2;
          },
          static_cast<double>(1 / std::sqrt(exponent))};
}

}  // namespace

ModelTest blinn_metal_test() {
  return {.budget = {16, 3.5, 8, 1.6}, .cases = {blinn_metal("4"), blinn_metal("20"), blinn_metal("5000")}};
}

}  // namespace lobe::test
