#include <cmath>

#include "models/family/blinn.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase blinn(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"blinn:n=" + n, [=](const Vector& l, const Vector& v) { return reference::blinn(l, v, exponent); },
          blinn_condition(exponent), static_cast<double>(2 / std::sqrt(exponent))};
}

}  // namespace

ModelTest blinn_test() {
  return {.budget = {16, 3.5, 4, 1.1},
          .cases = {blinn("1"), blinn("8"), blinn("20"), blinn("128"), blinn("512"), blinn("100000")}};
}

}  // namespace lobe::test
